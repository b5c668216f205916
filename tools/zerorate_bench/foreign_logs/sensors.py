"""Logs of inertial sensors by their makers' programs and by sketches."""

from pathlib import Path

import numpy as np
import pandas as pd

from . import binary
from .world import World, Writer, log, table, text

_SCALES = "--gyro-lsb-per-dps 131 --accel-lsb-per-g 16384"
_RAW = f"--gyro-unit lsb --accel-unit lsb {_SCALES}"
_SIX = "gx,gy,gz,ax,ay,az"


@log("WitMotion, its table")
def wit_motion(folder: Path, world: World) -> Path:
    names = ["time", "DeviceName", *(f"Acc{a}(g)" for a in "XYZ"), *(f"As{a}(°/s)" for a in "XYZ")]
    names += [*(f"Angle{a}(°)" for a in "XYZ"), "T(°C)"]
    said = (pd.Timestamp("2026-05-01T10:00") + pd.to_timedelta(world.t_s, unit="s")).strftime(
        "%Y-%m-%d %H:%M:%S.%f"
    )
    device = np.full(world.samples, "WT901(c1)")
    turned = np.zeros((world.samples, 3))
    frame = table(names, said, device, world.g, world.dps, turned, world.degc)
    return text(folder / "in.txt", frame, sep="\t")


@log("WitMotion, two sensors in one table")
def two_wit_motions(folder: Path, world: World) -> Path:
    names = [
        "Time(s)",
        "DeviceName",
        *(f"Acc{a}(g)" for a in "XYZ"),
        *(f"As{a}(°/s)" for a in "XYZ"),
    ]
    both = [
        table(names, world.t_s, np.full(world.samples, name), world.g, world.dps + more)
        for name, more in (("left", 0.0), ("right", 3.0))
    ]
    frame = pd.concat(both).sort_values(["Time(s)", "DeviceName"])
    return text(folder / "in.csv", frame)


@log("Xsens, its ASCII export: SampleTimeFine counts tenths of milliseconds")
def xsens(folder: Path, world: World) -> Path:
    before = "// Start Time: 2026-05-01\n// Sample rate: 100.0Hz\n// Filter Profile: human\n"
    names = ["PacketCounter", "SampleTimeFine", *(f"Acc_{a}" for a in "XYZ")]
    names += [f"Gyr_{a}" for a in "XYZ"]
    fine = np.rint(world.t_s * 1e4).astype(np.int64) + 77_000
    frame = table(names, np.arange(world.samples), fine, world.mps2, world.rad)
    return text(folder / "in.txt", frame, before, sep="\t", float_format="%.6f")


@log("Movella DOT: acceleration without gravity", "--gyro-unit dps --time-unit us")
def movella_dot(folder: Path, world: World) -> Path:
    before = "sep=,\nDeviceTag:,Xsens DOT\nOutputRate:,100Hz\n\n"
    names = ["PacketCounter", "SampleTimeFine", *(f"FreeAcc_{a}" for a in "XYZ")]
    names += [f"Gyr_{a}" for a in "XYZ"]
    at = np.rint(world.t_s * 1e6).astype(np.int64) + 10**9
    frame = table(names, np.arange(world.samples), at, world.mps2 - [0, 0, 9.81], world.dps)
    return text(folder / "in.csv", frame, before)


@log("VectorNav, its lines", "--hz 100")
def vectornav(folder: Path, world: World) -> Path:
    rows = zip(world.rad, world.mps2, world.degc)
    lines = [binary.vectornav_line(r, f, w) for r, f, w in rows]
    (folder / "in.txt").write_text("\r\n".join(lines) + "\r\n")
    return folder / "in.txt"


@log("OpenLog Artemis")
def openlog(folder: Path, world: World) -> Path:
    names = "rtcDate,rtcTime,aX,aY,aZ,gX,gY,gZ,imu_degC,output_Hz"
    at = pd.Timestamp("2026-05-01T10:00") + pd.to_timedelta(world.t_s, unit="s")
    day, clock = at.strftime("%m/%d/%Y"), at.strftime("%H:%M:%S.%f").str[:-4]
    said = np.full(world.samples, 100.0)
    frame = table(names, day, clock, world.g * 1000, world.dps, world.degc, said)
    return text(folder / "in.txt", frame)


@log("Shimmer, a line of units beneath the names")
def shimmer(folder: Path, world: World) -> Path:
    names = [f"S_67_Gyro_{a}_CAL" for a in "XYZ"] + [f"S_67_Accel_LN_{a}_CAL" for a in "XYZ"]
    units = "ms\tdeg/s\tdeg/s\tdeg/s\tm/(s^2)\tm/(s^2)\tm/(s^2)\n"
    head = '"sep=\t"\n' + "\t".join(["S_67_Timestamp_Unix_CAL", *names]) + "\n" + units
    frame = table(["t", *names], world.t_s * 1e3 + 1.7e12, world.dps, world.mps2)
    return text(folder / "in.csv", frame, head, sep="\t", header=False, float_format="%.6f")


def _counts(names: str = f"t_ms,{_SIX}", more: int = 0, most: int = 0, **lsb: float) -> Writer:
    """Counts of so many LSB, with an offset or as a word of so many without a sign."""

    def write(folder: Path, world: World) -> Path:
        found = [one % most if most else one + more for one in world.counts(**lsb)]
        columns = np.column_stack([np.rint(world.t_s * 1e3).astype(int), *found])
        return text(folder / "in.csv", table(names, columns[:, : names.count(",") + 1]))

    return write


log("counts of a sketch, as they are", _RAW)(_counts())
log("counts printed as words of 16 bits without a sign", _RAW)(_counts(most=65536))
log("counts around 32,768", _RAW)(_counts(more=32768))
log("counts of 32 bits", "--gyro-unit lsb --gyro-lsb-per-dps 655360")(
    _counts("t_ms,gx,gy,gz", gyro=655360.0)
)
log("counts of +-8 g, said to be of +-2 g: gravity of 0.25 g", _RAW)(_counts(accel=4096.0))


def _called(names: str, *columns: str, times: float = 1.0) -> Writer:
    """Columns of the world by names of another unit; times: of the last of them."""

    def write(folder: Path, world: World) -> Path:
        *others, last = (getattr(world, name) for name in columns)
        return text(folder / "in.csv", table(names, world.t_s, *others, last * times))

    return write


_IN_DPS = "t_s,gx_dps,gy_dps,gz_dps,ax_g,ay_g,az_g"
log("acceleration in g, printed at a quarter of its size")(_called(_IN_DPS, "dps", "g", times=0.25))
log("acceleration in m/s2, called g")(_called(_IN_DPS, "dps", "mps2"))
log("rates in rad/s, called dps")(_called(_IN_DPS, "rad", "g"))
log("rates in dps, called rad/s")(_called(_IN_DPS.replace("dps", "rad/s"), "dps", "g"))
log("time in seconds, called milliseconds")(
    _called("t_ms,gx_dps,gy_dps,gz_dps,temp_c", "dps", "degc")
)
log("plain names without a unit, rad/s and m/s2")(_called(f"t_s,{_SIX}", "rad", "mps2"))


@log("a sketch's lines, a/g: and six counts", f"{_RAW} --hz 100")
def sketch_lines(folder: Path, world: World) -> Path:
    gyro, accel = world.counts()
    lines = [f"a/g:\t{a}\t{b}\t{c}\t{d}\t{e}\t{f}\n" for (a, b, c), (d, e, f) in zip(accel, gyro)]
    (folder / "in.txt").write_text("Initializing I2C devices...\n" + "".join(lines))
    return folder / "in.txt"


@log("a plotter's lines: gx:0.8,gy:-0.5,gz:0.3", "--hz 100 --gyro-unit dps")
def plotter_lines(folder: Path, world: World) -> Path:
    lines = [f"gx:{x:.4f},gy:{y:.4f},gz:{z:.4f}\n" for x, y, z in world.dps]
    (folder / "in.txt").write_text("".join(lines))
    return folder / "in.txt"


@log("a sketch's lines: gx:0.8 gy:-0.5 ... t:10", "--gyro-unit dps --accel-unit g")
def labelled_lines(folder: Path, world: World) -> Path:
    rows = zip(world.dps, world.g, world.t_s)
    line = "gx:{:.4f} gy:{:.4f} gz:{:.4f} ax:{:.4f} ay:{:.4f} az:{:.4f} t:{:.0f}\n"
    lines = [line.format(*dps, *g, 1e3 * t_s) for dps, g, t_s in rows]
    (folder / "in.txt").write_text("MPU6050 ready!\n" + "".join(lines))
    return folder / "in.txt"


@log("Adafruit's sketch, three lines of words a sample", "--hz 100")
def lines_of_words(folder: Path, world: World) -> Path:
    line = "{} X: {:.2f}, Y: {:.2f}, Z: {:.2f} {}\n"
    lines = [
        line.format("Acceleration", *force, "m/s^2")
        + line.format("Rotation", *rates, "rad/s")
        + f"Temperature: {degc:.2f} degC\n\n"
        for force, rates, degc in zip(world.mps2, world.rad, world.degc)
    ]
    (folder / "in.txt").write_text("Adafruit MPU6050 test!\nMPU6050 Found!\n" + "".join(lines))
    return folder / "in.txt"


@log("Ouster, its IMU packets as CSV", "--gyro-unit dps --time-unit ns")
def ouster(folder: Path, world: World) -> Path:
    at_ns = 900_000_000_000 + (world.t_s * 1e9).astype(np.int64)
    names = "sys_ts,accel_ts,gyro_ts,accelX,accelY,accelZ,angVelX,angVelY,angVelZ"
    frame = table(names, at_ns, at_ns + 12, at_ns + 12, world.g, world.dps)
    return text(folder / "in.csv", frame)


@log("sentences: Gyro X:0.01, Y: 0.02, Z: 0.03 radians/s")
def sentences(folder: Path, world: World) -> Path:
    lines = [f"Gyro X:{x:.2f}, Y: {y:.2f}, Z: {z:.2f} radians/s\n\n" for x, y, z in world.rad]
    (folder / "in.txt").write_text("".join(lines))
    return folder / "in.txt"


@log("numbers alone, no line of names")
def numbers_alone(folder: Path, world: World) -> Path:
    frame = table("t,a,b,c,d,e,f", world.t_s, world.mps2, world.rad)
    return text(folder / "in.csv", frame, header=False)


@log("names over two lines: the sensor above, its axis beneath")
def two_lines_of_names(folder: Path, world: World) -> Path:
    head = "time,gyro (rad/s),gyro (rad/s),gyro (rad/s),accel (m/s2),accel (m/s2),accel (m/s2)\n"
    frame = table("s,x,y,z,x,y,z", world.t_s, world.rad, world.mps2)
    return text(folder / "in.csv", frame, head)


@log("names over two lines, as pandas writes columns of two levels")
def pandas_levels(folder: Path, world: World) -> Path:
    levels = [("gyro_dps", a) for a in "xyz"] + [("accel_g", a) for a in "xyz"]
    frame = pd.DataFrame(np.column_stack([world.dps, world.g]))
    frame.columns = pd.MultiIndex.from_tuples(levels)
    frame.index = pd.Index(world.t_s, name="t_s")
    return text(folder / "in.csv", frame, index=True)


@log("names over two lines that end with a delimiter, as rows do not")
def two_lines_and_a_delimiter(folder: Path, world: World) -> Path:
    head = "Time (s);IMU Acceleration;;;IMU Gyroscope (rad/s);;;\n;X;Y;Z;X;Y;Z;\n"
    frame = table("t,ax,ay,az,gx,gy,gz", world.t_s, world.mps2, world.rad)
    return text(folder / "in.csv", frame, head, sep=";", header=False)


@log("a corrected rate before the raw one")
def corrected_first(folder: Path, world: World) -> Path:
    names = [
        "t_s",
        *(f"gyro_corrected_{a}_dps" for a in "xyz"),
        *(f"gyro_raw_{a}_dps" for a in "xyz"),
    ]
    frame = table(names, world.t_s, world.dps - world.dps.mean(axis=0), world.dps)
    return text(folder / "in.csv", frame)
