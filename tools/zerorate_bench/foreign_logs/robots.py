"""Logs of autopilots and of ROS, whole and cut off, and what the tools around them print."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from . import binary
from .world import BIAS_DPS, EPOCH_NS, Logs, World, Writer, table

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


def _mavlogdump(world: World) -> pd.DataFrame:
    rows = [(row[0] * 1e-6 + 1.7e9, *row) for row in _imu_rows(world)]
    names = "timestamp,TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,T"
    return pd.DataFrame(rows, columns=names.split(","))


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
    "in.bin", lambda path, w: binary.dataflash_of_2015(path, [(int(t), *r, *f, c)
        for t, r, f, c in zip(_us(w) // 1000, w.rad, w.mps2, w.degc)]))
mavlogdump = log.csv("ArduPilot, mavlogdump --format csv: two sensors take turns in one column I",
    _mavlogdump, float_format="%.8f")
log.csv("MAVLink telemetry, RAW_IMU by mavlogdump: milli-g and milliradians",
    lambda w: table("timestamp,RAW_IMU.time_usec,RAW_IMU.{xyz}acc,RAW_IMU.{xyz}gyro,RAW_IMU.id",
        w.t_s + 1.7e9, _us(w), np.rint(w.g * 1000).astype(int), np.rint(w.rad * 1000).astype(int),
        w.each(0)))
blackbox = log.file("Betaflight, blackbox",
    "in.bbl", lambda path, w: binary.blackbox(path, [(t, *c, *f)
        for t, c, f in zip(_us(w).tolist(), *(of.tolist() for of in w.counts(*_BETAFLIGHT)))]))
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


def _bag(kind: str, share: float = 1.0, **how: Any) -> Writer:
    """A bag of ROS, or what a crash left of it."""

    def write(folder: Path, world: World) -> Path:
        path = binary.bag(folder, kind, world=world, **how)
        if share < 1.0:
            path.write_bytes(path.read_bytes()[: int(path.stat().st_size * share)])
        return path

    return write


ros1 = log.add("ROS 1, bag", _bag("ros1"))
log.add("ROS 1, bag that was cut off", _bag("ros1", 0.7), least=0.3)
log.add("ROS 2, folder of a bag", _bag("ros2"))
db3 = log.add("ROS 2, .db3 alone", _bag("db3"))
log.add("ROS 2, .db3 that was cut off", _bag("db3", 0.7), least=0.2)
mcap = log.add("MCAP of ROS 2", _bag("mcap"))
log.add("MCAP that was cut off", _bag("mcap-json", 0.7), least=0.3)
mcap_json = log.add("MCAP of JSON", _bag("mcap-json"))
log.add("MCAP of JSON, one message of which is none", _bag("mcap-json", torn=(70, 700)), least=0.97)

_UPRIGHT, _COVARIANCE = [0.0, 0.0, 0.0, 1.0], [1e-4] * 9


def _of_ros(world: World) -> tuple[np.ndarray, ...]:
    """Attitude, rates and forces, each before its covariances."""
    nine = world.each(_COVARIANCE)
    return world.each(_UPRIGHT), nine, world.rad, nine, world.mps2, nine


log.csv("rostopic echo -p: covariances before and between",
    lambda w: table("%time,field.header.seq,field.header.stamp,field.header.frame_id,"
        "field.orientation.{xyzw},field.orientation_covariance{012345678},"
        "field.angular_velocity.{xyz},field.angular_velocity_covariance{012345678},"
        "field.linear_acceleration.{xyz},field.linear_acceleration_covariance{012345678}",
        w.ns, w.count, w.ns, w.each("imu_link"), *_of_ros(w)))
log.csv("PlotJuggler's CSV: covariances in brackets, before the rates",
    lambda w: table("__time,/imu/angular_velocity_covariance[{012345678}],"
        "/imu/angular_velocity/{xyz},/imu/linear_acceleration/{xyz}",
        w.t_s + 1.7e9, w.each(_COVARIANCE), w.rad, w.mps2), float_format="%.12g")
log.csv("covariances of rates, and no rates",
    lambda w: table("time_s,angular_velocity_covariance{012345678}", w.t_s, w.each(_COVARIANCE)))
log.csv("ros2 topic echo --csv: numbers without names",
    lambda w: table([str(i) for i in range(40)], *np.divmod(w.ns, 10**9), w.each("imu_link"),
        *_of_ros(w)), header=False)
euroc = log.csv("EuRoC: nanoseconds, names with units",
    lambda w: table("#timestamp [ns],w_RS_S_{xyz} [rad s^-1],a_RS_S_{xyz} [m s^-2]",
        w.whole(1e9, 1_403_636_579 * 10**9), w.rad, w.mps2), name="data.csv")
uzh_fpv = log.csv("UZH-FPV: blanks, names in a comment",
    lambda w: table("t,w{xyz},a{xyz}", w.t_s + 1.54e9, w.rad, w.mps2),
    "# timestamp ang_vel_x ang_vel_y ang_vel_z lin_acc_x lin_acc_y lin_acc_z\n", name="imu.txt",
    sep=" ", header=False)


def _message(t: float, rate: np.ndarray, force: np.ndarray) -> str:
    sec, nanosec = divmod(EPOCH_NS + round(t * 1e9), 10**9)
    parts = {
        "header": {"stamp": {"sec": sec, "nanosec": nanosec}, "frame_id": "imu"},
        "angular_velocity": dict(zip("xyz", rate.tolist())),
        "linear_acceleration": dict(zip("xyz", force.tolist())),
    }
    return json.dumps(parts)


json_lines = log.text("JSON lines, a message of ROS on each",
    lambda w: "\n".join(map(_message, w.t_s, w.rad, w.mps2)) + "\n", "in.jsonl")


def _service_line(t: float, raw: np.ndarray, force: np.ndarray, degc: float) -> str:
    return json.dumps(
        {
            "t_us": round(t * 1e6) + 10_000,
            "rate_dps": (raw - np.array(BIAS_DPS)).round(5).tolist(),
            "raw_dps": raw.round(5).tolist(),
            "bias_dps": list(BIAS_DPS),
            "accel_g": force.round(5).tolist(),
            "temp_degc": round(degc, 2),
        }
    )


log.text("zerorate run, the lines of a service that was killed",
    lambda w: "\n".join(map(_service_line, w.t_s, w.dps, w.g, w.degc))[:-40], "service.jsonl")
