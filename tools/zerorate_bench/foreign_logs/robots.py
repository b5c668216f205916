"""Logs of ROS, whole and cut off, and what is printed of them."""

import json
from pathlib import Path

import numpy as np

from . import binary
from .world import BIAS_DPS, World, Writer, log, table, text

_IMU = "angular_velocity.x,angular_velocity.y,angular_velocity.z"
_FORCE = "linear_acceleration.x,linear_acceleration.y,linear_acceleration.z"
_AT_NS = 1_700_000_000 * 10**9


def _bag(kind: str, share: float = 1.0, **how) -> Writer:
    """A bag of ROS, or what a crash left of it."""

    def write(folder: Path, world: World) -> Path:
        path = binary.bag(folder, kind, world=world, **how)
        if share < 1.0:
            path.write_bytes(path.read_bytes()[: int(path.stat().st_size * share)])
        return path

    return write


ros1 = log("ROS 1, bag")(_bag("ros1"))
log("ROS 1, bag that was cut off", least=0.3)(_bag("ros1", 0.7))
log("ROS 2, folder of a bag")(_bag("ros2"))
db3 = log("ROS 2, .db3 alone")(_bag("db3"))
log("ROS 2, .db3 that was cut off", least=0.2)(_bag("db3", 0.7))
mcap = log("MCAP of ROS 2")(_bag("mcap"))
log("MCAP that was cut off", least=0.3)(_bag("mcap-json", 0.7))
mcap_json = log("MCAP of JSON")(_bag("mcap-json"))
log("MCAP of JSON, one message of which is none", least=0.97)(_bag("mcap-json", torn=(70, 700)))


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


@log("zerorate run, the lines of a service that was killed")
def service_lines(folder: Path, world: World) -> Path:
    lines = [
        json.dumps(
            {
                "t_us": round(t * 1e6) + 10_000,
                "rate_dps": (raw - np.array(BIAS_DPS)).round(5).tolist(),
                "raw_dps": raw.round(5).tolist(),
                "bias_dps": list(BIAS_DPS),
                "accel_g": force.round(5).tolist(),
                "temp_degc": round(degc, 2),
            }
        )
        for t, raw, force, degc in zip(world.t_s, world.dps, world.g, world.degc)
    ]
    (folder / "service.jsonl").write_text("\n".join(lines)[:-40])
    return folder / "service.jsonl"
