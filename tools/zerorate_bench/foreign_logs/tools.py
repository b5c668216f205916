"""Logs of further tools: wearables, terminals, makers' programs, public data sets."""

import json
from pathlib import Path

import numpy as np
import pandas as pd

from .phones import _EPOCH_NS, zipped
from .world import STANDARD_GRAVITY, World, log, table, text

_DATE = pd.Timestamp("2026-05-01T14:17:54.120")


def _at(world: World):
    return _DATE + pd.to_timedelta(world.t_s, unit="s")


def _ns(world: World) -> np.ndarray:
    return _EPOCH_NS + np.rint(world.t_s * 1e9).astype(np.int64)


def _axes(pattern: str, letters: str = "xyz") -> list[str]:
    return [pattern.format(axis) for axis in letters]


@log("Physics Toolbox: a clock with a colon before its milliseconds")
def physics_toolbox_clock(folder: Path, world: World) -> Path:
    said = _at(world).strftime("%H:%M:%S:%f").str[:-3]
    names = ["time", *_axes("gF{}"), *_axes("w{}")]
    return text(folder / "in.csv", table(names, said, world.g, world.rad))


@log("Physics Toolbox of iOS: dates")
def physics_toolbox_dates(folder: Path, world: World) -> Path:
    said = _at(world).strftime("%Y-%m-%d %H:%M:%S.%f").str[:-2]
    names = ["time", *_axes("gF{}"), *_axes("w{}")]
    return text(folder / "in.csv", table(names, said, world.g, world.rad))


def _metawear(folder: Path, name: str, unit: str, world: World, values: np.ndarray) -> Path:
    names = ["epoch (ms)", "time (-13:00)", "elapsed (s)", *_axes(f"{{}}-axis ({unit})")]
    said = _at(world).strftime("%Y-%m-%dT%H.%M.%S.%f").str[:-3]
    frame = table(names, _ns(world) // 10**6, said, world.t_s, values)
    return text(folder / f"MetaWear_2026-05-01T14.17.54.120_D1C36F1F_{name}_100.000Hz.csv", frame)


@log("MbientLab's MetaWear, its file of rates")
def metawear(folder: Path, world: World) -> Path:
    return _metawear(folder, "Gyroscope", "deg/s", world, world.dps)


@log("MbientLab's MetaWear, the folder of its files")
def metawear_folder(folder: Path, world: World) -> Path:
    _metawear(folder / "in", "Accelerometer", "g", world, world.g)
    return _metawear(folder / "in", "Gyroscope", "deg/s", world, world.dps).parent


def _sensor_server(world: World, typed: bool) -> str:
    def line(kind: str, at: int, values: np.ndarray) -> str:
        whose = {"type": f"android.sensor.{kind}"} if typed else {}
        return json.dumps({"accuracy": 3, "timestamp": at, "values": values.tolist(), **whose})

    kinds = {
        "gyroscope_uncalibrated": world.rad,
        **({"accelerometer": world.mps2} if typed else {}),
    }
    rows = zip(_ns(world).tolist(), *kinds.values())
    return "".join(f"{line(k, at, v)}\n" for at, *of in rows for k, v in zip(kinds, of))


@log("Android's SensorServer, messages of one sensor", "--gyro-unit rad/s")
def sensor_server(folder: Path, world: World) -> Path:
    (folder / "gyroscope.jsonl").write_text(_sensor_server(world, typed=False))
    return folder / "gyroscope.jsonl"


@log("Android's SensorServer, messages of two sensors", "--gyro-unit rad/s")
def sensor_server_two(folder: Path, world: World) -> Path:
    (folder / "in.jsonl").write_text(_sensor_server(world, typed=True))
    return folder / "in.jsonl"


@log("SensorLog of iOS: bars between the columns")
def sensor_log_bars(folder: Path, world: World) -> Path:
    names = [
        "loggingTime(txt)",
        "loggingSample(N)",
        *_axes("accelerometerAcceleration{}(G)", "XYZ"),
    ]
    names += ["gyroTimestamp_sinceReboot(s)", *_axes("gyroRotation{}(rad/s)", "XYZ"), "label(N)"]
    said = _at(world).strftime("%Y-%m-%d %H:%M:%S.%f").str[:-3] + " +0200"
    none = np.zeros(world.samples, int)
    frame = table(names, said, none.cumsum(), world.g, world.t_s + 4e5, world.rad, none)
    return text(folder / "in.csv", frame, sep="|")


@log("SensorLog of iOS, its JSON")
def sensor_log_json(folder: Path, world: World) -> Path:
    names = [*_axes("accelerometerAcceleration{}", "XYZ"), *_axes("gyroRotation{}", "XYZ")]
    frame = table(["gyroTimestamp_sinceReboot", *names], world.t_s + 4e5, world.g, world.rad)
    (folder / "in.json").write_text(json.dumps(frame.astype(str).to_dict("records")))
    return folder / "in.json"


@log("Xsens MT Manager: time in eight columns of UTC", "--hz 100")
def mt_manager(folder: Path, world: World) -> Path:
    before = "// General information:\n//  MT Manager version: 2022.0.0\n// Update Rate: 100.0Hz\n"
    parts = ["Nano", "Year", "Month", "Day", "Hour", "Minute", "Second", "Valid"]
    names = ["PacketCounter", *(f"UTC_{part}" for part in parts)]
    names += [*_axes("Acc_{}", "XYZ"), *_axes("Gyr_{}", "XYZ"), *_axes("Mag_{}", "XYZ")]
    at, one = _at(world), np.ones(world.samples, int)
    utc = (_ns(world) % 10**9, one * 2026, one * 5, one, at.hour, at.minute, at.second, one * 55)
    mag = np.tile([0.4, 0.1, -0.9], (world.samples, 1))
    frame = table(names, one.cumsum(), *utc, world.mps2, world.rad, mag)
    return text(folder / "MT_0380.txt", frame, before, sep="\t", float_format="%.6f")


@log("Movella DOT: a sign of copyright above its table", "--gyro-unit dps --time-unit us")
def movella_rates(folder: Path, world: World) -> Path:
    before = "sep=,\nDeviceTag:,Xsens DOT\nFirmwareVersion:,3.0.0\nOutputRate:,100Hz\n"
    before += "Measurement Mode:,Sensor fusion Mode - Rate quantities\n"
    before += "StartTime: ,2026-05-01_14:17:54_120 CEST\n© Movella Technologies B. V. 2005-2026\n\n"
    names = ["PacketCounter", "SampleTimeFine", *_axes("Acc_{}", "XYZ"), *_axes("Gyr_{}", "XYZ")]
    at = np.rint(world.t_s * 1e6).astype(np.int64) + 2_268_972_329
    count = np.arange(world.samples)
    return text(folder / "in.csv", table(names, count, at, world.mps2, world.dps), before)


@log("EuRoC, the folder mav0")
def euroc_folder(folder: Path, world: World) -> Path:
    names = ["#timestamp [ns]", *_axes("w_RS_S_{} [rad s^-1]"), *_axes("a_RS_S_{} [m s^-2]")]
    text(folder / "mav0" / "imu0" / "data.csv", table(names, _ns(world), world.rad, world.mps2))
    images = table(
        "#timestamp [ns],filename", _ns(world)[::5], [f"{t}.png" for t in _ns(world)[::5]]
    )
    text(folder / "mav0" / "cam0" / "data.csv", images)
    return folder / "mav0"


@log("TUM VI, its text for DSO: names with dots and a unit of the time alone", "--gyro-unit rad/s")
def tum_vi(folder: Path, world: World) -> Path:
    head = "# timestamp[ns] w.x w.y w.z a.x a.y a.z\n"
    frame = table("t,a,b,c,d,e,f", _ns(world), world.rad, world.mps2)
    return text(folder / "imu.txt", frame, head, sep=" ", header=False)


@log("KITTI's oxts: a file of thirty numbers for each sample")
def kitti(folder: Path, world: World) -> Path:
    data = folder / "oxts" / "data"
    data.mkdir(parents=True)
    for at in range(0, 300):
        row = [49.0, 8.4, 112.8, *world.mps2[at], *world.mps2[at], *world.rad[at], *world.rad[at]]
        (data / f"{at:010d}.txt").write_text(" ".join(f"{value:.12g}" for value in row) + " 4 11\n")
    said = _at(world)[:300].strftime("%Y-%m-%d %H:%M:%S.%f000")
    (folder / "oxts" / "timestamps.txt").write_text("\n".join(said) + "\n")
    return folder / "oxts"


@log("OpenSense, .sto of orientations")
def opensense(folder: Path, world: World) -> Path:
    head = "DataRate=100.000000\nDataType=Quaternion\nversion=3\nOpenSimVersion=4.1\nendheader\n"
    cells = [f"{x:.6f},{y:.6f},{z:.6f},0.5" for x, y, z in world.g / 2]
    frame = table("time,pelvis_imu,tibia_r_imu,femur_r_imu", world.t_s, cells, cells, cells)
    return text(folder / "in.sto", frame, head, sep="\t", quoting=3)


@log("OpenSense, .sto of rates: three numbers in a cell")
def opensense_rates(folder: Path, world: World) -> Path:
    head = "DataRate=100.000000\nDataType=Vec3\nversion=3\nOpenSimVersion=4.1\nendheader\n"
    cells = [f"{x:.8f},{y:.8f},{z:.8f}" for x, y, z in world.rad]
    frame = table("time,pelvis_imu", world.t_s, cells)
    return text(folder / "angular_velocities.sto", frame, head, sep="\t", quoting=3)


@log("ArduPilot, DataFlash as Mission Planner's text")
def dataflash_text(folder: Path, world: World) -> Path:
    names = "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,EG,EA,T,GH,AH,GHz,AHz"
    head = "FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns\n"
    head += f"FMT, 163, 57, IMU, QBffffffIIfBBHH, {names}\n"
    at_us = np.rint(world.t_s * 1e6).astype(np.int64) + 10**8
    rows = (
        f"IMU, {at}, 0, "
        + ", ".join(f"{v:.9g}" for v in (*r, *f))
        + f", 0, 0, {w:.4f}, 1, 1, 100, 100\n"
        for at, r, f, w in zip(at_us, world.rad, world.mps2, world.degc)
    )
    (folder / "in.log").write_text(head + "".join(rows))
    return folder / "in.log"


@log("PX4, vehicle_angular_velocity by ulog2csv: xyz[0]", "--gyro-unit rad/s")
def px4_xyz(folder: Path, world: World) -> Path:
    at = np.rint(world.t_s * 1e6).astype(np.int64) + 10**8
    names = ["timestamp", "timestamp_sample", *(f"xyz[{i}]" for i in range(3))]
    names += [f"xyz_derivative[{i}]" for i in range(3)]
    frame = table(names, at, at - 200, world.rad, np.gradient(world.rad, axis=0) * 100)
    return text(folder / "log_vehicle_angular_velocity_0.csv", frame)


@log("PX4, vehicle_imu by ulog2csv: angles, not rates")
def px4_angles(folder: Path, world: World) -> Path:
    at = np.rint(world.t_s * 1e6).astype(np.int64) + 10**8
    names = ["timestamp", "accel_device_id", *(f"delta_angle[{i}]" for i in range(3))]
    names += [*(f"delta_velocity[{i}]" for i in range(3)), "delta_angle_dt", "delta_velocity_dt"]
    dt = np.full(world.samples, 10_000)
    frame = table(names, at, dt, world.rad / 100, world.mps2 / 100, dt, dt)
    return text(folder / "log_vehicle_imu_0.csv", frame)


@log("Betaflight 4.5: unfiltered rates beside the filtered ones, counts of 2048 a g",
     "--accel-unit lsb --accel-lsb-per-g 2048")  # fmt: skip
def betaflight(folder: Path, world: World) -> Path:
    names = ["loopIteration", "time", *(f"gyroADC[{i}]" for i in range(3))]
    names += [f"gyroUnfilt[{i}]" for i in range(3)] + [f"accSmooth[{i}]" for i in range(3)]
    before = '"Product","Blackbox flight data recorder by Nicholas Sherlock"\n"acc_1G","2048"\n'
    at = np.rint(world.t_s * 1e6).astype(np.int64) + 10**8
    force = np.rint(world.g * 2048).astype(int)
    count = np.arange(world.samples)
    smooth = pd.DataFrame(world.dps).rolling(5, min_periods=1).mean().to_numpy()
    return text(folder / "in.csv", table(names, count, at, smooth, world.dps, force), before)


@log("Arduino's serial monitor: a clock and an arrow before each line")
def serial_monitor(folder: Path, world: World) -> Path:
    said = _at(world).strftime("%H:%M:%S.%f").str[:-3]
    rows = (f"{t} -> {x:.4f},{y:.4f},{z:.4f}\n" for t, (x, y, z) in zip(said, world.dps))
    (folder / "in.txt").write_text(f"{said[0]} -> gx_dps,gy_dps,gz_dps\n" + "".join(rows))
    return folder / "in.txt"


@log("Arduino's serial monitor: a clock, an arrow, tabs and no names")
def serial_monitor_tabs(folder: Path, world: World) -> Path:
    said = _at(world).strftime("%H:%M:%S.%f").str[:-3]
    rows = (f"{t} -> {x:.4f}\t{y:.4f}\t{z:.4f}\r\n" for t, (x, y, z) in zip(said, world.dps))
    (folder / "in.txt").write_text("".join(rows))
    return folder / "in.txt"


@log("PuTTY's log of a sketch that prints names and rows")
def putty(folder: Path, world: World) -> Path:
    before = "=~=~=~=~=~=~= PuTTY log 2026.05.01 14:17:54 =~=~=~=~=~=~=\nstarting...\n"
    names = "millis,gx_dps,gy_dps,gz_dps"
    frame = table(names, np.rint(world.t_s * 1e3).astype(int) + 812, world.dps)
    return text(folder / "putty.log", frame, before, lineterminator="\r\n")


@log("InfluxDB's annotated CSV: a field on each row")
def influx(folder: Path, world: World) -> Path:
    before = "#group,false,false,false,false,true\n"
    before += "#datatype,string,long,dateTime:RFC3339,double,string\n"
    said = _at(world).strftime("%Y-%m-%dT%H:%M:%S.%fZ")
    parts = [
        table(",result,table,_time,_value,_field".split(",")[1:], np.full(world.samples, ""),
              np.full(world.samples, number), said, world.dps[:, number],
              np.full(world.samples, f"gyro_{axis}"))
        for number, axis in enumerate("xyz")
    ]  # fmt: skip
    return text(folder / "in.csv", pd.concat(parts), before)


@log("Grafana's CSV: a unit in each cell")
def grafana(folder: Path, world: World) -> Path:
    said = _at(world).strftime("%Y-%m-%d %H:%M:%S.%f").str[:-3]
    cells = [[f"{value:.4f} °/s" for value in row] for row in world.dps]
    frame = table(["Time", *_axes("gyro {}")], said, np.array(cells))
    return text(folder / "in.csv", frame, quoting=1)


@log("ST's Unicleo: mg and mdps")
def unicleo(folder: Path, world: World) -> Path:
    before = "STMicroelectronics Unicleo-GUI\nODR 100 Hz\n\n"
    names = ["Time [us]", *_axes("A_{} [mg]", "XYZ"), *_axes("G_{} [mdps]", "XYZ"), "T [°C]"]
    at = np.rint(world.t_s * 1e6).astype(np.int64)
    frame = table(names, at, world.g * 1e3, world.dps * 1e3, world.degc)
    return text(folder / "in.txt", frame, before, sep="\t")


@log("ST BLE Sensor, its file of rates")
def st_ble(folder: Path, world: World) -> Path:
    before = "Log start on,2026-05-01 14:17:54\nFeature,Gyroscope\nNodes,SensorTile @C0821A\n"
    names = ["Date", "HostTimestamp", "NodeName", "NodeTimestamp", "RawData"]
    names += [*_axes("{} (dps)", "XYZ"), ""]
    said = _at(world).strftime("%d-%b-%y %H:%M:%S.%f").str[:-3]
    at_ms = np.rint(world.t_s * 1e3).astype(int)
    node = np.full(world.samples, "SensorTile @C0821A")
    raw, end = np.full(world.samples, "0A0B0C0D"), np.full(world.samples, "")
    frame = table(names, said, at_ms, node, at_ms + 7000, raw, world.dps, end)
    return text(folder / "20260501_141754_Gyroscope.csv", frame, before)


@log("GoPro's telemetry: columns called 1 and 2", "--gyro-unit rad/s")
def gopro(folder: Path, world: World) -> Path:
    names = ["cts", "date", "Gyroscope (x,y,z) [rad/s]", "1", "2"]
    said = _at(world).strftime("%Y-%m-%dT%H:%M:%S.%f").str[:-3] + "Z"
    return text(folder / "GX010042-GYRO.csv", table(names, world.t_s * 1e3, said, world.rad))


@log("LP-Research's LPMS: a sensor's number and a frame's")
def lpms(folder: Path, world: World) -> Path:
    names = ["SensorId", " TimeStamp (s)", " FrameNumber", *_axes(" Acc{} (g)", "XYZ")]
    names += [
        *_axes(" Gyro{} (deg/s)", "XYZ"),
        *_axes(" Mag{} (uT)", "XYZ"),
        *_axes(" Q{}", "WXYZ"),
    ]
    one = np.ones(world.samples, int)
    turned = np.tile([1.0, 0.0, 0.0, 0.0], (world.samples, 1))
    frame = table(names, one, world.t_s, one.cumsum(), world.g, world.dps, 40 * world.g, turned)
    return text(folder / "in.csv", frame)


@log("Inertial Sense: pqr[0] and acc[0]", "--gyro-unit rad/s --accel-unit m/s2 --time-unit s")
def inertial_sense(folder: Path, world: World) -> Path:
    names = ["time", *(f"pqr[{i}]" for i in range(3)), *(f"acc[{i}]" for i in range(3)), "status"]
    none = np.zeros(world.samples, int)
    return text(
        folder / "LOG_SN30013_imu.csv", table(names, world.t_s, world.rad, world.mps2, none)
    )


@log("x-io's x-IMU3")
def x_imu3(folder: Path, world: World) -> Path:
    names = ["Timestamp (us)", *_axes("Gyroscope {} (deg/s)", "XYZ")]
    names += _axes("Accelerometer {} (g)", "XYZ")
    at = np.rint(world.t_s * 1e6).astype(np.int64) + 8 * 10**6
    return text(folder / "Inertial.csv", table(names, at, world.dps, world.g))


@log("phyphox: rates and acceleration in one zip, of which one table ends sooner", least=0.7)
def phyphox_shorter(folder: Path, world: World) -> Path:
    rates = table(["Time (s)", *_axes("Gyroscope {} (rad/s)")], world.t_s, world.rad)
    force = table(["Time (s)", *_axes("Acceleration {} (m/s^2)")], world.t_s, world.mps2)
    files = [text(folder / "in" / "Gyroscope.csv", rates)]
    files.append(text(folder / "in" / "Accelerometer.csv", force[:2400]))
    return zipped(folder / "in.zip", files, folder / "in")


@log("a phone's JSON of two lists, {gyroscope: [], accelerometer: []}", "--time-unit ms")
def json_of_lists(folder: Path, world: World) -> Path:
    at = (_ns(world) // 10**6).tolist()

    def of(values: np.ndarray) -> list[dict]:
        return [{"timestamp": t, **dict(zip("xyz", v.tolist()))} for t, v in zip(at, values)]

    content = {"accelerometer": of(world.mps2), "gyroscope": of(world.rad)}
    (folder / "in.json").write_text(json.dumps(content))
    return folder / "in.json"


@log("iNav and Android mix: gravity taken away, and no word of it")
def free_force_unnamed(folder: Path, world: World) -> Path:
    free = world.mps2 - [0, 0, STANDARD_GRAVITY]
    names = ["t_s", *_axes("g{}_dps"), *_axes("a{}_m/s2")]
    return text(folder / "in.csv", table(names, world.t_s, world.dps, free))
