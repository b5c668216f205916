"""Logs of phones: Sensor Logger, phyphox, SensorLog, Physics Toolbox, AndroSensor and their kin."""

import json
from typing import Any

import numpy as np
import pandas as pd

from .world import BIAS_DPS, EPOCH_NS, STANDARD_GRAVITY, Logs, World, csv, table

log = Logs(samples=1000)
# fmt: off
_GRAVITY = [0, 0, STANDARD_GRAVITY]


def _without_bias(world: World) -> np.ndarray:
    """(n, 3) rad/s, of which the system took the bias away."""
    return world.rad - np.radians(BIAS_DPS)


def _ns(world: World) -> np.ndarray:
    return EPOCH_NS + (world.t_s * 1e9).astype(np.int64)


def _sensor_logger(world: World) -> dict[str, str]:
    """A file a sensor; of the two gyroscopes one is without the bias that the system took away, and
    of the accelerometers one is without gravity."""
    late = world.t_s + 0.003
    seen = {
        "Accelerometer": (world.t_s, world.mps2 - _GRAVITY),
        "Gravity": (world.t_s, world.each(_GRAVITY)),
        "TotalAcceleration": (late, world.mps2),
        "Gyroscope": (world.t_s, _without_bias(world)),
        "GyroscopeUncalibrated": (world.t_s, world.rad),
    }
    head = "time,seconds_elapsed,z,y,x"
    files = {f"{name}.csv": csv(table(head, _ns(world), at, values[:, ::-1]))
        for name, (at, values) in seen.items()}
    return files | {"Metadata.csv": csv(pd.DataFrame({"version": [3], "device": ["A"]}))}


log.files("Sensor Logger, the zip of its files", "2026-05-01.zip", _sensor_logger)
log.files("Sensor Logger, the folder of its files", "in", _sensor_logger)
log.files("Sensor Logger, one file of one sensor", "GyroscopeUncalibrated.csv", _sensor_logger)


def _two_chips(world: World) -> dict[str, str]:
    files = {}
    for number, (chip, late_ms) in enumerate({"": 0, "second_": 4}.items()):
        t_ms = 801_439_402 + np.round(world.t_s * 1e3).astype(np.int64) + late_ms
        times = t_ms, world.each(3), EPOCH_NS + t_ms * 1_000_000
        more = "2" * number
        for sensor, column, values in (
            ("accelerometer", f"acc{more}_{{xyz}}[m/s^2]", world.mps2),
            ("gyroscope", f"ang_vel{more}_{{xyz}}[rad/s]", _without_bias(world)),
            ("gyroscope_uncalibrated", f"ang_vel{more}_uncal_{{xyz}}[rad/s]", world.rad),
        ):
            names = f"imuTimestamp,accuracy(more=better),utcTimestamp(nanos),{column}"
            head = f"{chip}{sensor} Non-wakeup,STMicro,2025-03-06\n"
            lines = table(names, *times, values).to_csv(index=False)
            files[f"{chip}{sensor}_{number + 1}.csv"] = head + lines
    return files


log.files(
    "two chips of one phone: uncalibrated beside calibrated, times in ms by another time's unit",
    "", _two_chips)


def _long(world: World, gyro: str, accel: str, names: str = "time,sensor,{xyz}") -> pd.DataFrame:
    """Rows of two sensors in turn, told by their names."""
    rates = table(names, world.t_s, world.each(gyro), world.rad)
    force = table(names, world.t_s, world.each(accel), world.mps2)
    return pd.concat([rates, force]).sort_values(names.split(",")[0], kind="stable")


log.text("Sensor Logger, its JSON of all sensors",
    lambda w: json.dumps(_long(w, "GyroscopeUncalibrated", "TotalAcceleration",
        "seconds_elapsed,sensor,{xyz}").astype(str).to_dict("records")), "in.json")
log.csv("rows of several sensors: time,sensor,x,y,z", lambda w: _long(w, "gyro", "accel"))
log.csv("rows of several sensors, told by Android's numbers",
    lambda w: _long(w, "4", "1", "time,sensor_type,{xyz}"))
log.csv("rows of several sensors without a line of names",
    lambda w: _long(w, "GYRO", "ACC").assign(accuracy=3), header=False)


def _phyphox(world: World, **how: Any) -> dict[str, str]:
    rates = table("Time (s),Gyroscope {xyz} (rad/s)", world.t_s, world.rad)
    force = table("Time (s),Acceleration {xyz} (m/s^2)", world.t_s, world.mps2)
    meta = pd.DataFrame({"property": ["version"], "value": ["1.1.16"]})
    times = pd.DataFrame({"event": ["START", "PAUSE"], "experiment time": [0.0, world.t_s[-1]]})
    of = {"Accelerometer.csv": csv(force, **how), "Gyroscope.csv": csv(rates, **how)}
    return {**of, "meta/device.csv": csv(meta), "meta/time.csv": csv(times)}


def _phyphox_free(world: World) -> dict[str, str]:
    names = "Time (s),Linear Acceleration {xyz} (m/s^2)"
    free = csv(table(names, world.t_s, world.mps2 - _GRAVITY))
    return {"Linear Accelerometer.csv": free, "Gyroscope.csv": _phyphox(world)["Gyroscope.csv"]}


log.files("phyphox, the zip of its files", "in.zip", lambda w: _phyphox(w, quoting=1))
log.files("phyphox, the zip of rates and acceleration without gravity", "in.zip", _phyphox_free)
log.csv("phyphox, one file with an absolute value",
    lambda w: table("Time (s),Gyroscope {xyz} (rad/s),Absolute (rad/s)", w.t_s, w.rad,
        np.linalg.norm(w.rad, axis=1)), name="Raw Data.csv")
log.files("phyphox, semicolons and decimal commas", "Gyroscope.csv",
    lambda w: _phyphox(w, sep=";", decimal=",", float_format="%.9E"))


def _sensor_log(world: World) -> pd.DataFrame:
    said = pd.to_datetime(_ns(world)).strftime("%Y-%m-%dT%H:%M:%S.%f+02:00")
    at = world.t_s + 4e5
    return table(
        "loggingTime(txt),motionTimestamp_sinceReboot(s),motionRotationRate{XYZ}(rad/s),"
        "motionUserAcceleration{XYZ}(G),accelerometerTimestamp_sinceReboot(s),"
        "accelerometerAcceleration{XYZ}(G),gyroTimestamp_sinceReboot(s),gyroRotation{XYZ}(rad/s)",
        *(said, at, _without_bias(world), world.g - [0, 0, 1], at, world.g, at, world.rad),
    )


log.csv("SensorLog of iOS: CoreMotion's corrected rates before the gyroscope's own", _sensor_log)
log.csv("Physics Toolbox: gFx in g beside ax without gravity",
    lambda w: table("time,gF{xyz},a{xyz},w{xyz}", w.t_s, w.g, (w.g - [0, 0, 1]) * STANDARD_GRAVITY,
        w.rad))
log.csv("AndroSensor: linear acceleration and gravity beside the accelerometer",
    lambda w: table("LINEAR ACCELERATION {XYZ} (m/s²),GRAVITY {XYZ} (m/s²),"
        "ACCELEROMETER {XYZ} (m/s²),GYROSCOPE {XYZ} (rad/s),Time since start in ms ",
        w.mps2 - _GRAVITY, w.each(_GRAVITY), w.mps2, w.rad, w.t_s * 1e3), sep=";")


def _gnss_logger(world: World) -> str:
    axes = ",".join(f"UncalGyro{a}RadPerSec" for a in "XYZ")
    head = f"# Header\n# UncalGyro,utcTimeMillis,elapsedRealtimeNanos,{axes}\n"
    head += "# UncalAccel,utcTimeMillis,elapsedRealtimeNanos,UncalAccelXMps2,Y,Z\n"
    lines = [
        f"{kind},{EPOCH_NS // 10**6 + int(t * 1e3)},{int(t * 1e9)},{x:.9g},{y:.9g},{z:.9g}\n"
        for t, rate, force in zip(world.t_s, world.rad, world.mps2)
        for kind, (x, y, z) in (("UncalGyro", rate), ("UncalAccel", force))
    ]
    return head + "".join(lines)


log.text("Android's GnssLogger: lines of many kinds, each with names of its own", _gnss_logger)
log.csv("columns of German names", lambda w: table("Zeit (s),Drehrate {XYZ} (°/s)", w.t_s, w.dps))
