"""Logs of ROS, whole and cut off, and what is printed of them."""

import json
from pathlib import Path
from typing import Any

import numpy as np

from . import binary
from .world import BIAS_DPS, EPOCH_NS, Logs, World, Writer, table

log = Logs(samples=1000)
# fmt: off


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
