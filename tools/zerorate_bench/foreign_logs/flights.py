"""Logs of autopilots, and what the tools around them write as text."""

from pathlib import Path

import numpy as np
import pandas as pd

from . import binary
from .world import World, log, table, text

_AXES = "GyrX,GyrY,GyrZ,AccX,AccY,AccZ"
_AT_US = 5_000_000


def _us(world: World) -> np.ndarray:
    return np.rint(world.t_s * 1e6).astype(np.int64) + _AT_US


@log("PX4, ULog")
def ulog(folder: Path, world: World) -> Path:
    stamps = {"timestamp": ("uint64_t", _us(world))}
    rates = {a: ("float", world.rad[:, i]) for i, a in enumerate("xyz")}
    force = {a: ("float", world.mps2[:, i]) for i, a in enumerate("xyz")}
    warm = {"temperature": ("float", world.degc)}
    topics = {"sensor_gyro": stamps | rates | warm, "sensor_accel": stamps | force}
    binary.ulog(folder / "in.ulg", topics)
    return folder / "in.ulg"


@log("PX4, sensor_gyro by ulog2csv")
def ulog_to_csv(folder: Path, world: World) -> Path:
    names = "timestamp,timestamp_sample,device_id,x,y,z,temperature,error_count,clip_counter[0]"
    one = np.ones(world.samples, int)
    frame = table(names, _us(world), _us(world) - 200, one * 3_670_026, world.rad, world.degc,
                  one * 0, one * 0)  # fmt: skip
    return text(folder / "log_sensor_gyro_0.csv", frame)


@log("PX4, sensor_combined by ulog2csv")
def combined_to_csv(folder: Path, world: World) -> Path:
    names = ["timestamp", *(f"gyro_rad[{i}]" for i in range(3)), "gyro_integral_dt"]
    names += [*(f"accelerometer_m_s2[{i}]" for i in range(3)), "accelerometer_integral_dt"]
    dt = np.full(world.samples, 10_000)
    frame = table(names, _us(world), world.rad, dt, world.mps2, dt)
    return text(folder / "log_sensor_combined_0.csv", frame)


def _imu_rows(world: World) -> list[tuple]:
    """Two instances that take turns, the second with another bias."""
    columns = (_us(world), world.rad, world.mps2, world.degc)
    return [
        row
        for at, rate, force, warm in zip(*columns)
        for row in ((int(at), 0, *rate, *force, warm), (int(at), 1, *(rate + 0.05), *force, warm))
    ]


@log("ArduPilot, DataFlash")
def dataflash(folder: Path, world: World) -> Path:
    binary.dataflash(folder / "in.bin", _imu_rows(world))
    return folder / "in.bin"


@log("ArduPilot, DataFlash of 2015")
def dataflash_of_2015(folder: Path, world: World) -> Path:
    at_ms = _us(world) // 1000
    rows = [(int(t), *r, *f, w) for t, r, f, w in zip(at_ms, world.rad, world.mps2, world.degc)]
    binary.dataflash_of_2015(folder / "in.bin", {"IMU": rows})
    return folder / "in.bin"


@log("ArduPilot, mavlogdump --format csv: two sensors take turns in one column I")
def mavlogdump(folder: Path, world: World) -> Path:
    rows = [(row[0] * 1e-6 + 1.7e9, *row) for row in _imu_rows(world)]
    names = f"timestamp,TimeUS,I,{_AXES},T".split(",")
    return text(folder / "in.csv", pd.DataFrame(rows, columns=names), float_format="%.8f")


@log("MAVLink telemetry, RAW_IMU by mavlogdump: milli-g and milliradians")
def raw_imu(folder: Path, world: World) -> Path:
    names = "timestamp,RAW_IMU.time_usec,RAW_IMU.xacc,RAW_IMU.yacc,RAW_IMU.zacc"
    names += ",RAW_IMU.xgyro,RAW_IMU.ygyro,RAW_IMU.zgyro,RAW_IMU.id"
    counts = np.rint(world.g * 1000).astype(int), np.rint(world.rad * 1000).astype(int)
    frame = table(names, world.t_s + 1.7e9, _us(world), *counts, np.zeros(world.samples, int))
    return text(folder / "in.csv", frame)


@log("Betaflight, blackbox")
def blackbox(folder: Path, world: World) -> Path:
    counts, force = np.rint(world.dps).astype(int), np.rint(world.g * 2048).astype(int)
    rows = [(int(t), *c, *f) for t, c, f in zip(_us(world), counts.tolist(), force.tolist())]
    binary.blackbox(folder / "in.bbl", rows)
    return folder / "in.bbl"


@log("Betaflight, blackbox_decode")
def blackbox_decode(folder: Path, world: World) -> Path:
    names = ["loopIteration", " time (us)", *(f" gyroADC[{i}]" for i in range(3))]
    names += [f" accSmooth[{i}]" for i in range(3)]
    counts, force = np.rint(world.dps).astype(int), np.rint(world.g * 2048).astype(int)
    frame = table(names, np.arange(world.samples), _us(world), counts, force)
    return text(folder / "in.csv", frame)


@log("Blackbox Explorer, settings above the table")
def blackbox_explorer(folder: Path, world: World) -> Path:
    names = ["loopIteration", "time", *(f"gyroADC[{i}]" for i in range(3))]
    before = '"Product","Blackbox"\n"gyro_scale","0x3f800000"\n' + '"d_min","30"\n' * 150
    frame = table(names, np.arange(world.samples), _us(world), np.rint(world.dps).astype(int))
    return text(folder / "in.csv", frame, before)


@log("Crazyflie, gyro.x in deg/s and acc.x in g", "--gyro-unit dps --time-unit ms")
def crazyflie(folder: Path, world: World) -> Path:
    names = "timestamp,gyro.x,gyro.y,gyro.z,acc.x,acc.y,acc.z"
    at_ms = np.rint(world.t_s * 1e3).astype(int)
    return text(folder / "in.csv", table(names, at_ms, world.dps, world.g))
