"""Logs of further tools: wearables, straps, cameras, terminals, makers' programs, data sets."""

import json

import numpy as np
import pandas as pd

from .world import AFTERNOON, STANDARD_GRAVITY, Logs, World, csv, plain, table

log = Logs(samples=1000)
# fmt: off
_BOOTED_US = 10**8
_DATE = "%Y-%m-%d %H:%M:%S.%f"


log.csv("Physics Toolbox: a clock with a colon before its milliseconds",
    lambda w: table("time,gF{xyz},w{xyz}", w.dates("%H:%M:%S:%f", 3), w.g, w.rad))
log.csv("Physics Toolbox of iOS: dates",
    lambda w: table("time,gF{xyz},w{xyz}", w.dates(_DATE, 4), w.g, w.rad))


def _metawear(world: World) -> dict[str, str]:
    stamps = world.ns // 10**6, world.dates("%Y-%m-%dT%H.%M.%S.%f", 3), world.t_s
    names = "epoch (ms),time (-13:00),elapsed (s),{{xyz}}-axis ({})"
    of = ("Accelerometer", "g", world.g), ("Gyroscope", "deg/s", world.dps)
    return {_METAWEAR.format(sensor): csv(table(names.format(unit), *stamps, values))
        for sensor, unit, values in of}


_METAWEAR = "MetaWear_2026-05-01T14.17.54.120_D1C36F1F_{}_100.000Hz.csv"
log.files("MbientLab's MetaWear, its file of rates", _METAWEAR.format("Gyroscope"),
    lambda w: dict([_metawear(w).popitem()]))
log.files("MbientLab's MetaWear, the folder of its files", "in", _metawear)


def _sensor_server(world: World, *kinds: str) -> str:
    """A message a line, of two sensors, each with its type, or of one."""
    rows = {"gyroscope_uncalibrated": world.rad.tolist(), "accelerometer": world.mps2.tolist()}
    lines = [{"accuracy": 3, "timestamp": at, "values": rows[kind][n]}
        | ({"type": f"android.sensor.{kind}"} if len(kinds) > 1 else {})
        for n, at in enumerate(world.ns.tolist()) for kind in kinds]
    return "".join(f"{json.dumps(line)}\n" for line in lines)


log.text("Android's SensorServer, messages of one sensor",
    lambda w: _sensor_server(w, "gyroscope_uncalibrated"), "gyroscope.jsonl",
    words="--gyro-unit rad/s")
log.text("Android's SensorServer, messages of two sensors",
    lambda w: _sensor_server(w, "gyroscope_uncalibrated", "accelerometer"), "in.jsonl",
    words="--gyro-unit rad/s")
log.csv("SensorLog of iOS: bars between the columns",
    lambda w: table("loggingTime(txt),loggingSample(N),accelerometerAcceleration{XYZ}(G),"
        "gyroTimestamp_sinceReboot(s),gyroRotation{XYZ}(rad/s),label(N)",
        w.dates(_DATE, 3) + " +0200", w.each(0), w.g, w.t_s + 4e5, w.rad, w.each(0)), sep="|")


log.text("SensorLog of iOS, its JSON",
    lambda w: json.dumps(table(
        "gyroTimestamp_sinceReboot,accelerometerAcceleration{XYZ},gyroRotation{XYZ}",
        w.t_s + 4e5, w.g, w.rad).astype(str).to_dict("records")), "in.json")


def _mt_manager(world: World) -> pd.DataFrame:
    at = pd.Timestamp(AFTERNOON) + pd.to_timedelta(world.t_s, unit="s")
    date = world.ns % 10**9, *map(world.each, (2026, 5, 1))
    return table(
        "PacketCounter,UTC_Nano,UTC_Year,UTC_Month,UTC_Day,UTC_Hour,UTC_Minute,UTC_Second,"
        "UTC_Valid,Acc_{XYZ},Gyr_{XYZ},Mag_{XYZ}",
        *(world.count + 1, *date, at.hour, at.minute, at.second, world.each(55)),
        *(world.mps2, world.rad, world.each([0.4, 0.1, -0.9])),
    )


log.csv("Xsens MT Manager: time in eight columns of UTC",
    _mt_manager,
    "// General information:\n//  MT Manager version: 2022.0.0\n// Update Rate: 100.0Hz\n",
    name="MT_0380.txt", words="--hz 100", sep="\t", float_format="%.6f")
_MOVELLA = """\
sep=,
DeviceTag:,Xsens DOT
FirmwareVersion:,3.0.0
OutputRate:,100Hz
Measurement Mode:,Sensor fusion Mode - Rate quantities
StartTime: ,2026-05-01_14:17:54_120 CEST
© Movella Technologies B. V. 2005-2026

"""
log.csv("Movella DOT: a sign of copyright above its table",
    lambda w: table("PacketCounter,SampleTimeFine,Acc_{XYZ},Gyr_{XYZ}", w.count,
        w.whole(1e6, 2_268_972_329), w.mps2, w.dps), _MOVELLA,
    words="--gyro-unit dps --time-unit us")


def _euroc(world: World) -> dict[str, str]:
    names = "#timestamp [ns],w_RS_S_{xyz} [rad s^-1],a_RS_S_{xyz} [m s^-2]"
    cam = table("#timestamp [ns],filename", at := world.ns[::5], [f"{t}.png" for t in at])
    imu = table(names, world.ns, world.rad, world.mps2)
    return {"imu0/data.csv": csv(imu), "cam0/data.csv": csv(cam)}


log.files("EuRoC, the folder mav0", "mav0", _euroc)
log.csv("TUM VI, its text for DSO: names with dots and a unit of the time alone",
    lambda w: table("t,{abcdef}", w.ns, w.rad, w.mps2), "# timestamp[ns] w.x w.y w.z a.x a.y a.z\n",
    name="imu.txt", words="--gyro-unit rad/s", sep=" ", header=False)


def _kitti(world: World) -> dict[str, str]:
    files = {"timestamps.txt": "\n".join(world.dates(f"{_DATE}000", 9)[:300]) + "\n"}
    for at in range(0, 300):
        row = [49.0, 8.4, 112.8, *world.mps2[at], *world.mps2[at], *world.rad[at], *world.rad[at]]
        said = " ".join(f"{value:.12g}" for value in row)
        files[f"data/{at:010d}.txt"] = f"{said} 4 11\n"
    return files


log.files("KITTI's oxts: a file of thirty numbers for each sample", "oxts", _kitti)
_OPENSENSE = "DataRate=100.000000\nDataType={}\nversion=3\nOpenSimVersion=4.1\nendheader\n"


def _cells(line: str, rows: np.ndarray) -> list[str]:
    """Three numbers in a cell."""
    return [line.format(*row) for row in rows]


log.csv("OpenSense, .sto of orientations",
    lambda w: table("time,pelvis_imu,tibia_r_imu,femur_r_imu", w.t_s,
        *[_cells("{:.6f},{:.6f},{:.6f},0.5", w.g / 2)] * 3),
    _OPENSENSE.format("Quaternion"), name="in.sto", sep="\t", quoting=3)
log.csv("OpenSense, .sto of rates: three numbers in a cell",
    lambda w: table("time,pelvis_imu", w.t_s, _cells("{:.8f},{:.8f},{:.8f}", w.rad)),
    _OPENSENSE.format("Vec3"), name="angular_velocities.sto", sep="\t", quoting=3)


def _dataflash_text(world: World) -> str:
    head = "FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns\n"
    head += "FMT, 163, 57, IMU, QBffffffIIfBBHH, "
    head += "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,EG,EA,T,GH,AH,GHz,AHz\n"
    rows = (
        f"IMU, {at}, 0, {', '.join(f'{v:.9g}' for v in (*r, *f))}, 0, 0, {t:.4f}, 1, 1, 100, 100\n"
        for at, r, f, t in zip(world.whole(1e6, _BOOTED_US), world.rad, world.mps2, world.degc)
    )
    return head + "".join(rows)


log.text("ArduPilot, DataFlash as Mission Planner's text", _dataflash_text, "in.log")
log.csv("PX4, vehicle_angular_velocity by ulog2csv: xyz[0]",
    lambda w: table("timestamp,timestamp_sample,xyz[{012}],xyz_derivative[{012}]",
        at := w.whole(1e6, _BOOTED_US), at - 200, w.rad, np.gradient(w.rad, axis=0) * 100),
    name="log_vehicle_angular_velocity_0.csv", words="--gyro-unit rad/s")
log.csv("PX4, vehicle_imu by ulog2csv: angles, not rates",
    lambda w: table("timestamp,accel_device_id,delta_angle[{012}],delta_velocity[{012}],"
        "delta_angle_dt,delta_velocity_dt", w.whole(1e6, _BOOTED_US), w.each(10_000), w.rad / 100,
        w.mps2 / 100, w.each(10_000), w.each(10_000)), name="log_vehicle_imu_0.csv")
log.csv("Betaflight 4.5: unfiltered rates beside the filtered ones, counts of 2048 a g",
    lambda w: table("loopIteration,time,gyroADC[{012}],gyroUnfilt[{012}],accSmooth[{012}]", w.count,
        w.whole(1e6, _BOOTED_US), pd.DataFrame(w.dps).rolling(5, min_periods=1).mean().to_numpy(),
        w.dps, np.rint(w.g * 2048).astype(int)),
    '"Product","Blackbox flight data recorder by Nicholas Sherlock"\n"acc_1G","2048"\n',
    words="--accel-unit lsb --accel-lsb-per-g 2048")


def _monitored(world: World, line: str) -> list[str]:
    """A clock before each line of an Arduino."""
    said = world.dates("%H:%M:%S.%f", 3)
    return [f"{t} -> {line.format(*rates)}" for t, rates in zip(said, world.dps)]


log.text("Arduino's serial monitor: a clock and an arrow before each line",
    lambda w: "\n".join([_monitored(w, "gx_dps,gy_dps,gz_dps")[0],
        *_monitored(w, "{:.4f},{:.4f},{:.4f}"), ""]))
log.text("Arduino's serial monitor: a clock, an arrow, tabs and no names",
    lambda w: "\r\n".join([*_monitored(w, "{:.4f}\t{:.4f}\t{:.4f}"), ""]))
log.csv("PuTTY's log of a sketch that prints names and rows",
    lambda w: table("millis,g{xyz}_dps", w.whole(1e3, 812), w.dps),
    "=~=~=~=~=~=~= PuTTY log 2026.05.01 14:17:54 =~=~=~=~=~=~=\nstarting...\n", name="putty.log",
    lineterminator="\r\n")


def _influx(world: World) -> pd.DataFrame:
    said, names = world.dates("%Y-%m-%dT%H:%M:%S.%fZ", 6), "result,table,_time,_value,_field"
    return pd.concat([table(names, world.each(""), world.each(n), said, of, world.each(f"gyro_{a}"))
        for n, (a, of) in enumerate(zip("xyz", world.dps.T))])


log.csv("InfluxDB's annotated CSV: a field on each row",
    _influx,
    "#group,false,false,false,false,true\n#datatype,string,long,dateTime:RFC3339,double,string\n")
log.csv("Grafana's CSV: a unit in each cell",
    lambda w: table("Time,gyro {xyz}", w.dates(_DATE, 3),
        np.array([[f"{value:.4f} °/s" for value in row] for row in w.dps])), quoting=1)
log.csv("ST's Unicleo: mg and mdps",
    lambda w: table("Time [us],A_{XYZ} [mg],G_{XYZ} [mdps],T [°C]", w.whole(1e6), w.g * 1e3,
        w.dps * 1e3, w.degc), "STMicroelectronics Unicleo-GUI\nODR 100 Hz\n\n", name="in.txt",
    sep="\t")
log.csv("ST BLE Sensor, its file of rates",
    lambda w: table("Date,HostTimestamp,NodeName,NodeTimestamp,RawData,{XYZ} (dps),",
        w.dates("%d-%b-%y %H:%M:%S.%f", 3), w.whole(1e3), w.each("SensorTile @C0821A"),
        w.whole(1e3, 7000), w.each("0A0B0C0D"), w.dps, w.each("")),
    "Log start on,2026-05-01 14:17:54\nFeature,Gyroscope\nNodes,SensorTile @C0821A\n",
    name="20260501_141754_Gyroscope.csv")
log.csv("GoPro's telemetry: columns called 1 and 2",
    lambda w: table(["cts", "date", "Gyroscope (x,y,z) [rad/s]", "1", "2"], w.t_s * 1e3,
        w.dates("%Y-%m-%dT%H:%M:%S.%f", 3) + "Z", w.rad), name="GX010042-GYRO.csv",
    words="--gyro-unit rad/s")
log.csv("LP-Research's LPMS: a sensor's number and a frame's",
    lambda w: table("SensorId, TimeStamp (s), FrameNumber, Acc{XYZ} (g), Gyro{XYZ} (deg/s),"
        " Mag{XYZ} (uT), Q{WXYZ}", w.each(1), w.t_s, w.count + 1, w.g, w.dps, 40 * w.g,
        w.each([1.0, 0.0, 0.0, 0.0])))
log.csv("Inertial Sense: pqr[0] and acc[0]",
    lambda w: table("time,pqr[{012}],acc[{012}],status", w.t_s, w.rad, w.mps2, w.each(0)),
    name="LOG_SN30013_imu.csv", words="--gyro-unit rad/s --accel-unit m/s2 --time-unit s")
log.csv("x-io's x-IMU3",
    lambda w: table("Timestamp (us),Gyroscope {XYZ} (deg/s),Accelerometer {XYZ} (g)",
        w.whole(1e6, 8 * 10**6), w.dps, w.g), name="Inertial.csv")


def _shorter(world: World) -> dict[str, str]:
    rates = table("Time (s),Gyroscope {xyz} (rad/s)", world.t_s, world.rad)
    force = table("Time (s),Acceleration {xyz} (m/s^2)", world.t_s, world.mps2)
    return {"Gyroscope.csv": csv(rates), "Accelerometer.csv": csv(force[:2400])}


log.files("phyphox: rates and acceleration in one zip, of which one table ends sooner", "in.zip",
    _shorter, least=0.7, samples=3000)


def _lists_of_two(world: World) -> str:
    at = (world.ns // 10**6).tolist()
    said = {name: [{"timestamp": t, **dict(zip("xyz", v))} for t, v in zip(at, values.tolist())]
        for name, values in (("accelerometer", world.mps2), ("gyroscope", world.rad))}
    return json.dumps(said)


log.text("a phone's JSON of two lists, {gyroscope: [], accelerometer: []}",
    _lists_of_two, "in.json", words="--time-unit ms")
log.csv("iNav and Android mix: gravity taken away, and no word of it",
    lambda w: table("t_s,g{xyz}_dps,a{xyz}_m/s2", w.t_s, w.dps, w.mps2 - [0, 0, STANDARD_GRAVITY]))


def _beside_each_other(world: World) -> pd.DataFrame:
    """Acceleration at half the rate, each channel behind a time of its own."""
    force = [table(f"X[s],Acc 1.{axis} [g]", world.t_s[::2], of[::2])
        for axis, of in zip("XYZ", world.g.T)]
    rate = [table(f"X[s],Gyro 1.{axis} [deg/s]", world.t_s, of)
        for axis, of in zip("XYZ", world.dps.T)]
    return pd.concat([*force, *rate], axis=1)


log.csv("Delsys: a time before each channel, of two rates", _beside_each_other)


def _realsense(world: World) -> str:
    names = "Stream Type,F#,HW Timestamp (ms),Backend Timestamp(ms),Host Timestamp(ms),3DOF_{xyz}"
    at = world.whole(1e6, 5_000_000), *[world.whole(1e3, 1_700_000_000_000)] * 2
    tables = [table(names, world.each(sensor), world.count, *at, of)
        for sensor, of in (("Accel", world.mps2), ("Gyro", world.rad))]
    return "".join(f"\n\n{csv(one)}" for one in tables)


log.text("RealSense, rs-convert: two tables in one, microseconds called ms", _realsense, "in.csv",
    words="--gyro-unit rad/s")


def _long(world: World) -> pd.DataFrame:
    of = {"accelerometer": world.mps2, "gyroscope": world.rad}
    each = [table("time,sensor,axis,value", world.t_s, world.each(name), world.each(axis), column)
        for name, three in of.items() for axis, column in zip("xyz", three.T)]
    return pd.concat(each)


log.csv("a long table by sensor and axis: time,sensor,axis,value", _long,
    words="--gyro-unit rad/s")
log.csv("two sensors under a heading: label IMU1, IMU2",
    lambda w: pd.concat([plain(w).assign(label="IMU1"), plain(w).assign(label="IMU2", gx_dps=9)])
        .sort_values("t_s", kind="stable"))


def _evtest(world: World) -> str:
    """An axis that does not change is not said."""
    names = ["ABS_X", "ABS_Y", "ABS_Z", "ABS_RX", "ABS_RY", "ABS_RZ"]
    lines = [f"    Event code {n} ({name})\n      Resolution {14247 if n > 2 else 4096}"
        for n, name in enumerate(names)]
    before: dict[str, int] = {}
    values = np.rint(np.hstack([world.g * 4096, world.dps * 14247])).astype(int)
    for at, row in zip(world.whole(1e6, 2**32 - 5_000_000) % 2**32, values.tolist()):
        said = {n: v for n, v in zip(names, row) if before.get(n) != v}
        events = [f"4 (EV_MSC), code 5 (MSC_TIMESTAMP), value {at}"]
        events += [f"3 (EV_ABS), code {names.index(n)} ({n}), value {v}" for n, v in said.items()]
        events = [f"type {event}" for event in events] + ["-------------- SYN_REPORT ------------"]
        lines += [f"Event: time 1789294043.831028, {event}" for event in events]
        before |= said
    return "\n".join([*lines, ""])


log.text("Linux's evtest of a gamepad: axes that do not change are not said", _evtest)
log.csv("a browser's devicemotion: alpha, beta, gamma",
    lambda w: table("t_ms,acceleration.{xyz},accelerationIncludingGravity.{xyz},"
        "rotationRate.beta,rotationRate.gamma,rotationRate.alpha",
        w.whole(1e3), w.mps2 / 100, w.mps2, w.dps))
log.csv("MATLAB's timetable: 0.01 sec, columns _1 to _3",
    lambda w: table("Time,AngularVelocity_{123},Acceleration_{123}", [f"{t:g} sec" for t in w.t_s],
        w.rad, w.mps2), words="--gyro-unit rad/s")


def _scaled(world: World) -> str:
    line = "Scaled. Acc (mg) [ {}, {}, {} ], Gyr (DPS) [ {}, {}, {} ], Tmp (C) [ {} ]\n"
    rows = np.column_stack([1e3 * world.g, world.dps, world.degc])
    return "".join(line.format(*(f"{value: 09.2f}" for value in row)) for row in rows)


log.text("SparkFun's sketch: Acc (mg) [ x, y, z ], Gyr (DPS) [ ... ]", _scaled, words="--hz 100")


def _of_two_devices(world: World) -> pd.DataFrame:
    of = {"accel": world.g, "gyro": world.dps}
    names = "time,device,sensor,{xyz}"
    each = [table(names, world.t_s, *map(world.each, (device, name)), three + n)
        for n, device in enumerate("AB") for name, three in of.items()]
    return pd.concat(each).sort_values("time", kind="stable")


log.csv("rows of two sensors of two devices: time,device,sensor,x,y,z", _of_two_devices,
    words="--gyro-unit dps --accel-unit g")


def _motec(world: World) -> str:
    """Settings in as many cells as rows have may stand above MoTeC's table."""
    names = "Time,G Force {XYZ},Gyro Roll Velocity,Gyro Pitch Velocity,Gyro Yaw Velocity"
    above = '"Format","MoTeC CSV File"\n"Log Date","1/5/2026","","","Origin","0.0","s"\n'
    above += '"Log Time","14:17:54","","","Start Time","0.0","s"\n\n'
    head, *rows = csv(table(names, world.t_s, world.g, world.dps), quoting=1).splitlines()
    units = '"s","G","G","G","deg/s","deg/s","deg/s"'
    return above + "\n".join([head, units, "", *rows, ""])


log.text("MoTeC, its CSV: settings above the table, units beneath the names", _motec, "in.csv")


def _topics(world: World) -> str:
    lines = (f"dev/{of} {json.dumps({'ts': at, **dict(zip('xyz', three))})}\n"
        for at, *both in zip(world.whole(1e3).tolist(), world.g.tolist(), world.dps.tolist())
        for of, three in zip(("accel", "gyro"), both))
    return "".join(lines)


log.text("mosquitto_sub -v: a topic before the JSON of each sensor", _topics,
    words="--gyro-unit dps --time-unit ms")

_GYROFLOW = """\
GYROFLOW IMU LOG
version,1.3
id,custom_logger
orientation,YxZ
tscale,{}
gscale,0.00122173
ascale,0.000244140625
"""


def _gcsv(world: World, ticks_a_second: float) -> pd.DataFrame:
    counts = world.counts(gyro=1 / np.degrees(0.00122173), accel=4096)
    return table("t,g{xyz},a{xyz}", world.whole(ticks_a_second), *counts)


log.csv("Gyroflow, .gcsv: counts, whose scales stand above the table",
    lambda w: _gcsv(w, 1e3), _GYROFLOW.format(0.001), name="in.gcsv")
log.csv("Gyroflow, .gcsv: time in counts of a tenth of a millisecond",
    lambda w: _gcsv(w, 1e4), _GYROFLOW.format(0.0001), name="in.gcsv")


log.csv("a watch's table: a list of 25 readings in each cell",
    lambda w: table("timestamp_s,gyro_{xyz}", w.t_s[::25],
        *([str(part.tolist()) for part in axis.reshape(-1, 25)] for axis in w.dps.T)),
    words="--gyro-unit dps")
log.csv("a watch's table: three rates in a cell, [x, y, z]",
    lambda w: table("timestamp_s,heart_rate,gyro", w.t_s, 70 + w.count % 9,
        [str(row.tolist()) for row in w.dps]), words="--gyro-unit dps")
log.csv("Garmin FIT's CSV: field, value and units take turns",
    lambda w: table("Type,Local Number,Message,Field 1,Value 1,Units 1,Field 2,Value 2,Units 2",
        *map(w.each, ("Data", 3, "gyroscope_data", "timestamp_ms")), w.whole(1e3), w.each("ms"),
        w.each("gyro_x"), [json.dumps(row.tolist()).replace(", ", "|") for row in w.dps],
        w.each("deg/s")))
log.csv("Axivity AX6, with names and a temperature",
    lambda w: table("Time,Accel-{XYZ} (g),Gyro-{XYZ} (d/s),Temp (C)",
        w.dates("%Y-%m-%d %H:%M:%S.%f", 3), w.g, w.dps, w.degc))


def _numbers(world: World) -> dict[str, str]:
    imu = table("t,{abcdefg}", at := world.whole(1e6), world.rad, world.mps2, world.degc)
    tables = {"IMU.txt": imu, "ATT.txt": table("t,{abc}", at, world.g)}
    return {name: csv(of, sep=" ", header=False) for name, of in tables.items()}


log.files("text without names in a zip: numbers of a board's files", "in.zip", _numbers)


def _of_25_samples(world: World) -> str:
    said = [dict(zip("xyz", row.tolist())) for row in world.dps]
    parts = [{"ts": 40 * n, "gyro": said[n : n + 25]} for n in range(0, world.samples, 25)]
    return "".join(json.dumps(part) + "\n" for part in parts)


log.text("a watch's JSON lines: a list of 25 samples in each", _of_25_samples, "in.jsonl")
log.text("Xsens MTw, .mvnx",
    lambda w: '<?xml version="1.0"?>\n<mvnx version="4">' + "".join(
        f'<frame time="{n}"><x>{row}</x></frame>' for n, row in enumerate(w.dps.tolist()))
        + "</mvnx>\n", "in.mvnx")
log.csv("a time by another name: Zeit;wx;wy;wz",
    lambda w: table("Zeit,w{xyz}", w.t_s, w.rad).round(5), words="--gyro-unit rad/s", sep=";",
    decimal=",")
