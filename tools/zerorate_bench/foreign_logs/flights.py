"""Logs of autopilots, and what the tools around them write as text."""

import numpy as np
import pandas as pd

from . import binary
from .world import Logs, World, table

log = Logs(samples=1000)
# fmt: off
_AT_US = 5_000_000
#: Counts a deg/s and a g.
_BETAFLIGHT = 1, 2048


def _us(world: World) -> np.ndarray:
    return world.whole(1e6, _AT_US)


def _topics(world: World) -> binary.Topics:
    """Of a ULog: a topic a sensor."""
    stamps = {"timestamp": ("uint64_t", _us(world))}
    rates = {a: ("float", world.rad[:, i]) for i, a in enumerate("xyz")}
    force = {a: ("float", world.mps2[:, i]) for i, a in enumerate("xyz")}
    warm = {"temperature": ("float", world.degc)}
    return {"sensor_gyro": stamps | rates | warm, "sensor_accel": stamps | force}


def _imu_rows(world: World) -> list[tuple[float, ...]]:
    """Two instances that take turns, the second with another bias."""
    columns = (_us(world).tolist(), world.rad, world.mps2, world.degc)
    return [(at, n, *(rate + n * 0.05), *force, warm)
        for at, rate, force, warm in zip(*columns) for n in (0, 1)]


def _imu_rows_of_2015(world: World) -> list[tuple[float, ...]]:
    columns = (_us(world) // 1000, world.rad, world.mps2, world.degc)
    return [(int(t), *r, *f, w) for t, r, f, w in zip(*columns)]


def _mavlogdump(world: World) -> pd.DataFrame:
    rows = [(row[0] * 1e-6 + 1.7e9, *row) for row in _imu_rows(world)]
    names = "timestamp,TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,T"
    return pd.DataFrame(rows, columns=names.split(","))


def _blackbox_rows(world: World) -> list[tuple[int, ...]]:
    columns = _us(world), *world.counts(*_BETAFLIGHT)
    return [(t, *c, *f) for t, c, f in zip(*(of.tolist() for of in columns))]


ulog = log.file("PX4, ULog", "in.ulg", lambda path, w: binary.ulog(path, _topics(w)))
log.csv("PX4, sensor_gyro by ulog2csv",
    lambda w: table("timestamp,timestamp_sample,device_id,{xyz},temperature,error_count,"
        "clip_counter[0]", _us(w), _us(w) - 200, w.each(3_670_026), w.rad, w.degc, w.each(0),
        w.each(0)), name="log_sensor_gyro_0.csv")
log.csv("PX4, sensor_combined by ulog2csv",
    lambda w: table("timestamp,gyro_rad[{012}],gyro_integral_dt,"
        "accelerometer_m_s2[{012}],accelerometer_integral_dt", _us(w), w.rad, w.each(10_000),
        w.mps2, w.each(10_000)), name="log_sensor_combined_0.csv")
dataflash = log.file("ArduPilot, DataFlash",
    "in.bin", lambda path, w: binary.dataflash(path, _imu_rows(w)))
dataflash_of_2015 = log.file("ArduPilot, DataFlash of 2015",
    "in.bin", lambda path, w: binary.dataflash_of_2015(path, _imu_rows_of_2015(w)))
mavlogdump = log.csv("ArduPilot, mavlogdump --format csv: two sensors take turns in one column I",
    _mavlogdump, float_format="%.8f")
log.csv("MAVLink telemetry, RAW_IMU by mavlogdump: milli-g and milliradians",
    lambda w: table("timestamp,RAW_IMU.time_usec,RAW_IMU.{xyz}acc,RAW_IMU.{xyz}gyro,RAW_IMU.id",
        w.t_s + 1.7e9, _us(w), np.rint(w.g * 1000).astype(int), np.rint(w.rad * 1000).astype(int),
        w.each(0)))
blackbox = log.file("Betaflight, blackbox",
    "in.bbl", lambda path, w: binary.blackbox(path, _blackbox_rows(w)))
log.csv("Betaflight, blackbox_decode",
    lambda w: table("loopIteration, time (us), gyroADC[{012}], accSmooth[{012}]", w.count, _us(w),
        *w.counts(*_BETAFLIGHT)))
blackbox_explorer = log.csv("Blackbox Explorer, settings above the table",
    lambda w: table("loopIteration,time,gyroADC[{012}]", w.count, _us(w),
        w.counts(*_BETAFLIGHT)[0]),
    '"Product","Blackbox"\n"gyro_scale","0x3f800000"\n' + '"d_min","30"\n' * 150)
log.csv("Crazyflie, gyro.x in deg/s and acc.x in g",
    lambda w: table("timestamp,gyro.{xyz},acc.{xyz}", w.whole(1e3), w.dps, w.g),
    words="--gyro-unit dps --time-unit ms")
