"""Logs of inertial sensors by their makers' programs and by sketches."""

import numpy as np
import pandas as pd

from . import binary
from .world import Logs, World, spelled, table

log = Logs(samples=1000)
# fmt: off
_SCALES = "--gyro-lsb-per-dps 131 --accel-lsb-per-g 16384"
_RAW = f"--gyro-unit lsb --accel-unit lsb {_SCALES}"
_SIX = "g{xyz},a{xyz}"
_MORNING = "2026-05-01T10:00"


log.csv("WitMotion, its table",
    lambda w: table("time,DeviceName,Acc{XYZ}(g),As{XYZ}(°/s),Angle{XYZ}(°),T(°C)",
        w.dates("%Y-%m-%d %H:%M:%S.%f", start=_MORNING), w.each("WT901(c1)"), w.g, w.dps,
        w.each([0.0] * 3), w.degc), name="in.txt", sep="\t")


def _two_wit_motions(world: World) -> pd.DataFrame:
    names = "Time(s),DeviceName,Acc{XYZ}(g),As{XYZ}(°/s)"
    both = [table(names, world.t_s, world.each(name), world.g, world.dps + more)
        for name, more in (("left", 0.0), ("right", 3.0))]
    return pd.concat(both).sort_values(["Time(s)", "DeviceName"])


log.csv("WitMotion, two sensors in one table", _two_wit_motions)
log.csv("Xsens, its ASCII export: SampleTimeFine counts tenths of milliseconds",
    lambda w: table("PacketCounter,SampleTimeFine,Acc_{XYZ},Gyr_{XYZ}", w.count,
        w.whole(1e4, 77_000), w.mps2, w.rad),
    "// Start Time: 2026-05-01\n// Sample rate: 100.0Hz\n// Filter Profile: human\n", name="in.txt",
    sep="\t", float_format="%.6f")
log.csv("Movella DOT: acceleration without gravity",
    lambda w: table("PacketCounter,SampleTimeFine,FreeAcc_{XYZ},Gyr_{XYZ}", w.count,
        w.whole(1e6, 10**9), w.mps2 - [0, 0, 9.81], w.dps),
    "sep=,\nDeviceTag:,Xsens DOT\nOutputRate:,100Hz\n\n", words="--gyro-unit dps --time-unit us")
log.text("VectorNav, its lines",
    lambda w: "".join(f"{line}\r\n" for line in map(binary.vectornav_line, w.rad, w.mps2, w.degc)),
    words="--hz 100")
log.csv("OpenLog Artemis",
    lambda w: table("rtcDate,rtcTime,a{XYZ},g{XYZ},imu_degC,output_Hz",
        w.dates("%m/%d/%Y", start=_MORNING), w.dates("%H:%M:%S.%f", 2, _MORNING), w.g * 1000, w.dps,
        w.degc, w.each(100.0)), name="in.txt")


def _shimmer_head() -> str:
    names = "S_67_Timestamp_Unix_CAL,S_67_Gyro_{XYZ}_CAL,S_67_Accel_LN_{XYZ}_CAL"
    units = "ms\tdeg/s\tdeg/s\tdeg/s\tm/(s^2)\tm/(s^2)\tm/(s^2)\n"
    return '"sep=\t"\n' + "\t".join(spelled(names.split(","))) + "\n" + units


log.csv("Shimmer, a line of units beneath the names",
    lambda w: table(f"t,{_SIX}", w.t_s * 1e3 + 1.7e12, w.dps, w.mps2), _shimmer_head(), sep="\t",
    header=False, float_format="%.6f")


def _counts(world: World, more: int = 0, most: int = 0, **lsb: float) -> pd.DataFrame:
    """Counts of so many LSB, with an offset or as a word of so many without a sign."""
    found = [one % most if most else one + more for one in world.counts(**lsb)]
    return table(f"t_ms,{_SIX}", world.whole(1e3), *found)


log.csv("counts of a sketch, as they are", _counts, words=_RAW)
log.csv("counts printed as words of 16 bits without a sign",
    lambda w: _counts(w, most=65536), words=_RAW)
log.csv("counts around 32,768", lambda w: _counts(w, more=32768), words=_RAW)
log.csv("counts of 32 bits",
    lambda w: _counts(w, gyro=655360.0).iloc[:, :4],
    words="--gyro-unit lsb --gyro-lsb-per-dps 655360")
log.csv("counts of +-8 g, said to be of +-2 g: gravity of 0.25 g",
    lambda w: _counts(w, accel=4096.0), words=_RAW)

_IN_DPS = "t_s,g{xyz}_dps,a{xyz}_g"
log.csv("acceleration in g, printed at a quarter of its size",
    lambda w: table(_IN_DPS, w.t_s, w.dps, w.g * 0.25))
log.csv("acceleration in m/s2, called g", lambda w: table(_IN_DPS, w.t_s, w.dps, w.mps2))
log.csv("rates in rad/s, called dps", lambda w: table(_IN_DPS, w.t_s, w.rad, w.g))
log.csv("rates in dps, called rad/s",
    lambda w: table("t_s,g{xyz}_rad/s,a{xyz}_g", w.t_s, w.dps, w.g))
log.csv("time in seconds, called milliseconds",
    lambda w: table("t_ms,g{xyz}_dps,temp_c", w.t_s, w.dps, w.degc))
log.csv("plain names without a unit, rad/s and m/s2",
    lambda w: table(f"t_s,{_SIX}", w.t_s, w.rad, w.mps2))


def _sketch(line: str, *columns: np.ndarray) -> str:
    """A line for each sample, of its numbers."""
    return "".join(line.format(*row) for row in np.column_stack(columns).tolist())


log.text("a sketch's lines, a/g: and six counts",
    lambda w: ("Initializing I2C devices...\n"
        + _sketch("a/g:\t{}\t{}\t{}\t{}\t{}\t{}\n", *w.counts()[::-1])), words=f"{_RAW} --hz 100")
log.text("a plotter's lines: gx:0.8,gy:-0.5,gz:0.3",
    lambda w: _sketch("gx:{:.4f},gy:{:.4f},gz:{:.4f}\n", w.dps), words="--hz 100 --gyro-unit dps")
_LABELLED = "gx:{:.4f} gy:{:.4f} gz:{:.4f} ax:{:.4f} ay:{:.4f} az:{:.4f} t:{:.0f}\n"
log.text("a sketch's lines: gx:0.8 gy:-0.5 ... t:10",
    lambda w: "MPU6050 ready!\n" + _sketch(_LABELLED, w.dps, w.g, 1e3 * w.t_s),
    words="--gyro-unit dps --accel-unit g")
_IN_WORDS = """\
Acceleration X: {:.2f}, Y: {:.2f}, Z: {:.2f} m/s^2
Rotation X: {:.2f}, Y: {:.2f}, Z: {:.2f} rad/s
Temperature: {:.2f} degC

"""
in_words = log.text("Adafruit's sketch, three lines of words a sample",
    lambda w: ("Adafruit MPU6050 test!\nMPU6050 Found!\n"
        + _sketch(_IN_WORDS, w.mps2, w.rad, w.degc)), words="--hz 100")
parted = log.text("a sketch's lines behind the monitor's clock, bars between",
    lambda w: "".join(f"{at} -> {line}\n" for at, line in zip(w.dates("%H:%M:%S.%f", 3),
        _sketch("gX = {:.4f} | gY = {:.4f} | gZ = {:.4f} | tmp = {:.2f}\n", w.dps, w.degc)
        .splitlines())), words="--gyro-unit dps --temp-unit degc")
log.text("mosquitto_sub -v: a topic before each value",
    lambda w: _sketch("".join(f"imu/gyro/{a} {{:.4f}}\n" for a in "xyz"), w.dps),
    words="--hz 100 --gyro-unit dps")
log.text("InfluxDB's line protocol",
    lambda w: "".join(f"imu,host=pi gx={x:.5f},gy={y:.5f},gz={z:.5f} {ns}\n"
        for (x, y, z), ns in zip(w.rad.tolist(), w.ns)), words="--gyro-unit rad/s")
log.csv("a long table: time,name,value",
    lambda w: table("time,g{xyz},temp_degC", w.t_s, w.dps, w.degc).melt("time", var_name="name")
        .sort_values("time", kind="stable"), words="--gyro-unit dps")
_ECHOED = """\
header:
  stamp:
    sec: {:.0f}
    nanosec: {:.0f}
  frame_id: imu_link
angular_velocity:
  x: {!r}
  y: {!r}
  z: {!r}
angular_velocity_covariance:
- 0.0
- 0.0
linear_acceleration:
  x: {!r}
  y: {!r}
  z: {!r}
---
"""
echoed = log.text("ros2 topic echo",
    lambda w: _sketch(_ECHOED, 5 + w.t_s // 1, np.rint(w.t_s % 1 * 1e9), w.rad, w.mps2))
log.csv("Ouster, its IMU packets as CSV",
    lambda w: table("sys_ts,accel_ts,gyro_ts,accel{XYZ},angVel{XYZ}",
        *((w.t_s * 1e9).astype(np.int64) + late for late in (9 * 10**11, *[9 * 10**11 + 12] * 2)),
        w.g, w.dps), words="--gyro-unit dps --time-unit ns")
log.text("sentences: Gyro X:0.01, Y: 0.02, Z: 0.03 radians/s",
    lambda w: _sketch("Gyro X:{:.2f}, Y: {:.2f}, Z: {:.2f} radians/s\n\n", w.rad), words="--hz 100")
log.csv("numbers alone, no line of names",
    lambda w: table("t,{abcdef}", w.t_s, w.mps2, w.rad), header=False)
log.csv("names over two lines: the sensor above, its axis beneath",
    lambda w: table("s,{xyz},{xyz}", w.t_s, w.rad, w.mps2),
    "time,gyro (rad/s),gyro (rad/s),gyro (rad/s),accel (m/s2),accel (m/s2),accel (m/s2)\n")


def _levels(world: World) -> pd.DataFrame:
    names = pd.MultiIndex.from_product([["gyro_dps", "accel_g"], [*"xyz"]])
    at = pd.Index(world.t_s, name="t_s")
    return pd.DataFrame(np.column_stack([world.dps, world.g]), at, names)


log.csv("names over two lines, as pandas writes columns of two levels", _levels, index=True)
log.csv("names over two lines that end with a delimiter, as rows do not",
    lambda w: table("t,a{xyz},g{xyz}", w.t_s, w.mps2, w.rad),
    "Time (s);IMU Acceleration;;;IMU Gyroscope (rad/s);;;\n;X;Y;Z;X;Y;Z;\n", sep=";", header=False)
log.csv("a corrected rate before the raw one",
    lambda w: table("t_s,gyro_corrected_{xyz}_dps,gyro_raw_{xyz}_dps", w.t_s,
        w.dps - w.dps.mean(axis=0), w.dps))
