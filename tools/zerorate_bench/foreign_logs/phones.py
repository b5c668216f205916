"""Logs of phones: Sensor Logger, phyphox, SensorLog, Physics Toolbox, AndroSensor and their kin."""

import json
import zipfile
from pathlib import Path

import numpy as np
import pandas as pd

from .world import BIAS_DPS, STANDARD_GRAVITY, World, log, table, text

_EPOCH_NS = 1_700_000_000_000_000_000


def zipped(path: Path, files: list[Path], root: Path) -> Path:
    """Files as one archive."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for file in files:
            archive.write(file, file.relative_to(root))
    return path


def _sensor_logger(folder: Path, world: World) -> list[Path]:
    """A file a sensor; of the two gyroscopes one is without the bias that the system took away, and
    of the accelerometers one is without gravity."""
    t_ns = _EPOCH_NS + (world.t_s * 1e9).astype(np.int64)
    head = "time,seconds_elapsed,z,y,x"
    late = world.t_s + 0.003
    seen = {
        "Accelerometer": (world.t_s, world.mps2 - [0, 0, STANDARD_GRAVITY]),
        "Gravity": (world.t_s, np.tile([0, 0, STANDARD_GRAVITY], (world.samples, 1))),
        "TotalAcceleration": (late, world.mps2),
        "Gyroscope": (world.t_s, world.rad - np.radians(BIAS_DPS)),
        "GyroscopeUncalibrated": (world.t_s, world.rad),
    }
    files = [
        text(folder / f"{name}.csv", table(head, t_ns, at, values[:, ::-1]))
        for name, (at, values) in seen.items()
    ]
    return [*files, text(folder / "Metadata.csv", pd.DataFrame({"version": [3], "device": ["A"]}))]


@log("Sensor Logger, the zip of its files")
def sensor_logger_zip(folder: Path, world: World) -> Path:
    return zipped(folder / "2026-05-01.zip", _sensor_logger(folder / "in", world), folder / "in")


@log("Sensor Logger, the folder of its files")
def sensor_logger_folder(folder: Path, world: World) -> Path:
    return _sensor_logger(folder / "in", world)[0].parent


@log("Sensor Logger, one file of one sensor")
def sensor_logger_file(folder: Path, world: World) -> Path:
    return _sensor_logger(folder, world)[4]


@log("two chips of one phone: uncalibrated beside calibrated, times in ms by another time's unit")
def two_chips(folder: Path, world: World) -> Path:
    for number, (chip, late_ms) in enumerate({"": 0, "second_": 4}.items()):
        t_ms = 801_439_402 + np.round(world.t_s * 1e3).astype(np.int64) + late_ms
        utc_ns = _EPOCH_NS + t_ms * 1_000_000
        times = "imuTimestamp,accuracy(more=better),utcTimestamp(nanos)"
        rates, force = ",ang_vel{}_{}[rad/s]", ",acc{}_{}[m/s^2]"
        for sensor, column, values in (
            ("accelerometer", force, world.mps2),
            ("gyroscope", rates, world.rad - np.radians(BIAS_DPS)),
            ("gyroscope_uncalibrated", rates, world.rad),
        ):
            of = f"{'2' * number}{'_uncal' * ('uncal' in sensor)}"
            head = times + "".join(column.format(of, axis) for axis in "xyz")
            frame = table(head, t_ms, np.full(len(t_ms), 3), utc_ns, values)
            lines = f"{chip}{sensor} Non-wakeup,STMicro,2025-03-06\n{frame.to_csv(index=False)}"
            (folder / f"{chip}{sensor}_{number + 1}.csv").write_text(lines)
    return folder


def _long(world: World, names: tuple[str, str], time: str = "time") -> pd.DataFrame:
    rates = table(f"{time},sensor,x,y,z", world.t_s, np.full(world.samples, names[0]), world.rad)
    force = table(f"{time},sensor,x,y,z", world.t_s, np.full(world.samples, names[1]), world.mps2)
    both = pd.concat([rates, force], keys=[0, 1]).reset_index(names=["of", "row"])
    return both.sort_values(["row", "of"]).drop(columns=["of", "row"])


@log("Sensor Logger, its JSON of all sensors")
def sensor_logger_json(folder: Path, world: World) -> Path:
    frame = _long(world, ("GyroscopeUncalibrated", "TotalAcceleration"), "seconds_elapsed")
    rows = frame.astype(str).to_dict("records")
    (folder / "in.json").write_text(json.dumps(rows))
    return folder / "in.json"


@log("rows of several sensors: time,sensor,x,y,z")
def rows_of_sensors(folder: Path, world: World) -> Path:
    return text(folder / "in.csv", _long(world, ("gyro", "accel")))


@log("rows of several sensors, told by Android's numbers")
def rows_of_numbered_sensors(folder: Path, world: World) -> Path:
    frame = _long(world, ("4", "1")).rename(columns={"sensor": "sensor_type"})
    return text(folder / "in.csv", frame)


@log("rows of several sensors without a line of names")
def rows_of_sensors_unnamed(folder: Path, world: World) -> Path:
    return text(folder / "in.csv", _long(world, ("GYRO", "ACC")), header=False)


def _phyphox(folder: Path, world: World, **how) -> list[Path]:
    rates = "Time (s),Gyroscope x (rad/s),Gyroscope y (rad/s),Gyroscope z (rad/s)"
    force = "Time (s),Acceleration x (m/s^2),Acceleration y (m/s^2),Acceleration z (m/s^2)"
    meta = pd.DataFrame({"property": ["version"], "value": ["1.1.16"]})
    times = pd.DataFrame({"event": ["START", "PAUSE"], "experiment time": [0.0, world.t_s[-1]]})
    return [
        text(folder / "Accelerometer.csv", table(force, world.t_s, world.mps2), **how),
        text(folder / "Gyroscope.csv", table(rates, world.t_s, world.rad), **how),
        text(folder / "meta" / "device.csv", meta),
        text(folder / "meta" / "time.csv", times),
    ]


@log("phyphox, the zip of its files")
def phyphox_zip(folder: Path, world: World) -> Path:
    return zipped(folder / "in.zip", _phyphox(folder / "in", world, quoting=1), folder / "in")


@log("phyphox, the zip of rates and acceleration without gravity")
def phyphox_free(folder: Path, world: World) -> Path:
    names = "Time (s)," + ",".join(f"Linear Acceleration {a} (m/s^2)" for a in "xyz")
    gyro = _phyphox(folder / "in", world)[1]
    free = table(names, world.t_s, world.mps2 - [0, 0, STANDARD_GRAVITY])
    files = [text(folder / "in" / "Linear Accelerometer.csv", free), gyro]
    return zipped(folder / "in.zip", files, folder / "in")


@log("phyphox, one file with an absolute value")
def phyphox_file(folder: Path, world: World) -> Path:
    names = [f"Gyroscope {a} (rad/s)" for a in "xyz"]
    names = ["Time (s)", *names, "Absolute (rad/s)"]
    length = np.linalg.norm(world.rad, axis=1)
    return text(folder / "Raw Data.csv", table(names, world.t_s, world.rad, length))


@log("phyphox, semicolons and decimal commas")
def phyphox_commas(folder: Path, world: World) -> Path:
    return _phyphox(folder, world, sep=";", decimal=",", float_format="%.9E")[1]


@log("SensorLog of iOS: CoreMotion's corrected rates before the gyroscope's own")
def sensor_log(folder: Path, world: World) -> Path:
    own = [f"gyroRotation{a}(rad/s)" for a in "XYZ"]
    made = [f"motionRotationRate{a}(rad/s)" for a in "XYZ"]
    user = [f"motionUserAcceleration{a}(G)" for a in "XYZ"]
    force = [f"accelerometerAcceleration{a}(G)" for a in "XYZ"]
    names = ["loggingTime(txt)", "motionTimestamp_sinceReboot(s)", *made, *user]
    names += ["accelerometerTimestamp_sinceReboot(s)", *force]
    names += ["gyroTimestamp_sinceReboot(s)", *own]
    said = pd.to_datetime(_EPOCH_NS + (world.t_s * 1e9).astype(np.int64))
    said = said.strftime("%Y-%m-%dT%H:%M:%S.%f+02:00")
    free = world.g - [0, 0, 1]
    less = world.rad - np.radians(BIAS_DPS)
    at = world.t_s + 4e5
    frame = table(names, said, at, less, free, at, world.g, at, world.rad)
    return text(folder / "in.csv", frame)


@log("Physics Toolbox: gFx in g beside ax without gravity")
def physics_toolbox(folder: Path, world: World) -> Path:
    free = (world.g - [0, 0, 1]) * STANDARD_GRAVITY
    names = "time,gFx,gFy,gFz,ax,ay,az,wx,wy,wz"
    return text(folder / "in.csv", table(names, world.t_s, world.g, free, world.rad))


@log("AndroSensor: linear acceleration and gravity beside the accelerometer")
def andro_sensor(folder: Path, world: World) -> Path:
    kinds = ["LINEAR ACCELERATION", "GRAVITY", "ACCELEROMETER"]
    names = [f"{kind} {a} (m/s²)" for kind in kinds for a in "XYZ"]
    names += [f"GYROSCOPE {a} (rad/s)" for a in "XYZ"] + ["Time since start in ms "]
    down = np.tile([0, 0, STANDARD_GRAVITY], (world.samples, 1))
    frame = table(names, world.mps2 - down, down, world.mps2, world.rad, world.t_s * 1e3)
    return text(folder / "in.csv", frame, sep=";")


@log("Android's GnssLogger: lines of many kinds, each with names of its own")
def gnss_logger(folder: Path, world: World) -> Path:
    axes = ",".join(f"UncalGyro{a}RadPerSec" for a in "XYZ")
    head = f"# Header\n# UncalGyro,utcTimeMillis,elapsedRealtimeNanos,{axes}\n"
    head += "# UncalAccel,utcTimeMillis,elapsedRealtimeNanos,UncalAccelXMps2,Y,Z\n"
    lines = [
        f"{kind},{_EPOCH_NS // 10**6 + int(t * 1e3)},{int(t * 1e9)},{x:.9g},{y:.9g},{z:.9g}\n"
        for t, rate, force in zip(world.t_s, world.rad, world.mps2)
        for kind, (x, y, z) in (("UncalGyro", rate), ("UncalAccel", force))
    ]
    (folder / "in.txt").write_text(head + "".join(lines))
    return folder / "in.txt"


@log("columns of German names")
def german(folder: Path, world: World) -> Path:
    names = ["Zeit (s)", *(f"Drehrate {a} (°/s)" for a in "XYZ")]
    return text(folder / "in.csv", table(names, world.t_s, world.dps))
