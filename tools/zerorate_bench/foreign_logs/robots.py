"""Logs of ROS, whole and cut off, and what is printed of them."""

import json
from pathlib import Path

import numpy as np
import pandas as pd

from . import binary
from .world import World, log, table, text

_IMU = "angular_velocity.x,angular_velocity.y,angular_velocity.z"
_FORCE = "linear_acceleration.x,linear_acceleration.y,linear_acceleration.z"
_AT_NS = 1_700_000_000 * 10**9


def _cut(path: Path, share: float = 0.7) -> Path:
    path.write_bytes(path.read_bytes()[: int(path.stat().st_size * share)])
    return path


@log("ROS 1, bag")
def ros1(folder: Path, world: World) -> Path:
    return binary.bag(folder, "ros1", world=world)


@log("ROS 1, bag that was cut off", least=0.3)
def ros1_cut(folder: Path, world: World) -> Path:
    return _cut(binary.bag(folder, "ros1", world=world))


@log("ROS 2, folder of a bag")
def ros2(folder: Path, world: World) -> Path:
    return binary.bag(folder, "ros2", world=world)


@log("ROS 2, .db3 alone")
def db3(folder: Path, world: World) -> Path:
    return binary.bag(folder, "db3", world=world)


@log("ROS 2, .db3 that was cut off", least=0.2)
def db3_cut(folder: Path, world: World) -> Path:
    return _cut(binary.bag(folder, "db3", world=world))


@log("MCAP of ROS 2")
def mcap(folder: Path, world: World) -> Path:
    return binary.bag(folder, "mcap", world=world)


@log("MCAP that was cut off", least=0.3)
def mcap_cut(folder: Path, world: World) -> Path:
    return _cut(binary.bag(folder, "mcap-json", world=world))


@log("MCAP of JSON")
def mcap_json(folder: Path, world: World) -> Path:
    return binary.bag(folder, "mcap-json", world=world)


@log("MCAP of JSON, one message of which is none", least=0.97)
def mcap_bad_json(folder: Path, world: World) -> Path:
    return binary.bag(folder, "mcap-json", world=world, torn=(70, 700))


def _covariances(name: str, world: World) -> tuple[list[str], np.ndarray]:
    return [f"{name}_covariance{i}" for i in range(9)], np.full((world.samples, 9), 1e-4)


@log("rostopic echo -p: covariances before and between")
def rostopic(folder: Path, world: World) -> Path:
    names, columns = (
        ["%time", "field.header.seq", "field.header.stamp", "field.header.frame_id"],
        [],
    )
    at_ns = np.rint(world.t_s * 1e9).astype(np.int64) + _AT_NS
    columns += [at_ns, np.arange(world.samples), at_ns, np.full(world.samples, "imu_link")]
    for name, values in (("orientation", None), ("angular_velocity", world.rad),
                         ("linear_acceleration", world.mps2)):  # fmt: skip
        axes = "xyzw" if values is None else "xyz"
        if values is None:
            values = np.tile([0.0, 0.0, 0.0, 1.0], (world.samples, 1))
        more, covariance = _covariances(f"field.{name}", world)
        names += [*(f"field.{name}.{a}" for a in axes), *more]
        columns += [values, covariance]
    return text(folder / "in.csv", table(names, *columns))


@log("PlotJuggler's CSV: covariances in brackets, before the rates")
def plot_juggler(folder: Path, world: World) -> Path:
    names = ["__time", *(f"/imu/angular_velocity_covariance[{i}]" for i in range(9))]
    names += [f"/imu/angular_velocity/{a}" for a in "xyz"]
    names += [f"/imu/linear_acceleration/{a}" for a in "xyz"]
    covariance = np.full((world.samples, 9), 1e-4)
    frame = table(names, world.t_s + 1.7e9, covariance, world.rad, world.mps2)
    return text(folder / "in.csv", frame, float_format="%.12g")


@log("covariances of rates, and no rates")
def only_covariances(folder: Path, world: World) -> Path:
    names, covariance = _covariances("angular_velocity", world)
    return text(folder / "in.csv", table(["time_s", *names], world.t_s, covariance))


@log("ros2 topic echo --csv: numbers without names")
def ros2_echo(folder: Path, world: World) -> Path:
    at_ns = np.rint(world.t_s * 1e9).astype(np.int64) + _AT_NS
    nine = np.full((world.samples, 9), 1e-4)
    turned = np.tile([0.0, 0.0, 0.0, 1.0], (world.samples, 1))
    columns = (at_ns // 10**9, at_ns % 10**9, np.full(world.samples, "imu_link"), turned, nine)
    frame = table([str(i) for i in range(40)], *columns, world.rad, nine, world.mps2, nine)
    return text(folder / "in.csv", frame, header=False)


@log("EuRoC: nanoseconds, names with units")
def euroc(folder: Path, world: World) -> Path:
    names = ["#timestamp [ns]", *(f"w_RS_S_{a} [rad s^-1]" for a in "xyz")]
    names += [f"a_RS_S_{a} [m s^-2]" for a in "xyz"]
    at_ns = np.rint(world.t_s * 1e9).astype(np.int64) + 1_403_636_579 * 10**9
    return text(folder / "data.csv", table(names, at_ns, world.rad, world.mps2))


@log("UZH-FPV: blanks, names in a comment")
def uzh_fpv(folder: Path, world: World) -> Path:
    names = ["#", "timestamp", *(f"ang_vel_{a}" for a in "xyz"), *(f"lin_acc_{a}" for a in "xyz")]
    frame = table(names[1:], world.t_s + 1.54e9, world.rad, world.mps2)
    head = " ".join(names) + "\n"
    return text(folder / "imu.txt", frame, head, sep=" ", header=False, float_format="%.15g")


@log("JSON lines, a message of ROS on each")
def json_lines(folder: Path, world: World) -> Path:
    def message(t: float, rate: np.ndarray, force: np.ndarray) -> str:
        at_ns = _AT_NS + round(t * 1e9)
        stamp = {"sec": at_ns // 10**9, "nanosec": at_ns % 10**9}
        parts = {
            "header": {"stamp": stamp, "frame_id": "imu"},
            "angular_velocity": dict(zip("xyz", rate.tolist())),
            "linear_acceleration": dict(zip("xyz", force.tolist())),
        }
        return json.dumps(parts)

    lines = map(message, world.t_s, world.rad, world.mps2)
    (folder / "in.jsonl").write_text("\n".join(lines) + "\n")
    return folder / "in.jsonl"


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
