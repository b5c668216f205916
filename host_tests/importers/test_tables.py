"""Tables as people have them come out as integers in LSB, and every loss is told."""

import json
import re
import shlex
from functools import reduce
from operator import xor

import numpy as np
import pandas as pd
import pytest
from zerorate_tools.errors import BadRecording
from zerorate_tools.importers import Options, import_recording, parsed_mapping, read_foreign
from zerorate_tools.importers.tables import checked_lines, delimited
from zerorate_tools.recordings import (
    Scales,
    read_recording,
    recording_from_columns,
    write_recording,
)
from zerorate_tools.recordings.checks import GAP

HEAD = "t_s,gx_dps,gy_dps,gz_dps"
RATES = HEAD.split(",")[1:]


def table(n=2000, hz=100.0):
    """A rest with usual names and units in them."""
    rng = np.random.default_rng(3)
    columns = {"t_s": np.arange(n) / hz}
    columns |= {name: 0.8 + 0.05 * rng.standard_normal(n) for name in RATES}
    columns |= {f"a{a}_g": (a == "z") + 0.004 * rng.standard_normal(n) for a in "xyz"}
    return pd.DataFrame(columns | {"temp_c": 25 + 0.001 * np.arange(n)})


def rates(names, n=2000):
    """The time and the rates of that rest under these names; what is named beyond them is 1."""
    frame = table(n)[HEAD.split(",")].set_axis(names[:4], axis=1)
    return frame.assign(**dict.fromkeys(names[4:], 1.0))


def read(tmp_path, frame, name="in.csv", mapping="", **options):
    """What an import makes of a frame, or of a text."""
    if isinstance(frame, pd.DataFrame):
        frame = frame.to_csv(index=False)
    content = frame if isinstance(frame, bytes) else f"{frame.rstrip()}\n".encode()
    (tmp_path / name).write_bytes(content)
    words = [parsed_mapping(word) for word in shlex.split(mapping)]
    return read_foreign(tmp_path / name, mapping=words, **options)


def lines(rows):
    """A text of numbers without a head."""
    return "\n".join(",".join(f"{v:.6g}" for v in row) for row in rows)


def told(report, words):
    return any(words in line for line in report.lines())


def test_a_mapping_with_units_gives_integers(tmp_path):
    n = np.arange(4.0)
    columns = {"ms": n * 10, "wx": n * 0.1, "wy": n * 0, "wz": -n, "fx": n * 0, "fy": n * 0,
               "fz": n * 0 + 9.80665, "die": 1.8 * n + 80.33, "volts": n * 0 + 3.3}  # fmt: skip
    words = (
        "t_us=ms:ms gx=wx:rad/s gy=-wy:rad/s gz=-wz:dps ax=fx:m/s2 ay=fy:m/s2 az=fz:m/s2 "
        "temp=die:degf vdd_mv=volts:x1000"
    )
    options = Options(sensor="MPU-6050", gyro_lsb_per_dps=131, accel_lsb_per_g=16384,
                      temp_lsb_per_degc=340, temp_offset_degc=36.53)  # fmt: skip
    recording, _ = read(tmp_path, pd.DataFrame(columns), mapping=words, options=options)
    found = {name: values.tolist() for name, values in recording.columns.items()}
    assert found["t_us"] == [0, 10_000, 20_000, 30_000]
    assert found["gx"] == np.rint(np.degrees(n * 0.1) * 131).tolist()
    assert found["gz"] == [0, 131, 262, 393]
    assert found["az"] == [16384] * 4 and found["vdd_mv"] == [3300] * 4
    assert found["temp"] == np.rint((n + 26.85 - 36.53) * 340).tolist()
    assert recording.scales.sensor == "MPU-6050"
    assert recording.scales.odr_hz == pytest.approx(100)


def test_rows_that_are_no_samples_are_dropped_and_counted(tmp_path):
    columns = {
        "t_s": [0, 1, 2, 3, 2.5, 4, np.nan, 5, 1e306],
        "gx_dps": [1, 0, 1, 1, 1, np.nan, 1, 1e200, 1],
        "gy_dps": [1, 0, 1, 300, 1, 1, 1, 1, 1],
        "gz_dps": [1, 0, 1, 1, 1, 1, 1, 1, 1],
        "temp_c": [20, 0, 20, 20, 20, 20, 20, 20, 20],
    }
    table, options = pd.DataFrame(columns), Options(gyro_lsb_per_dps=131)
    with np.errstate(over="raise"):
        recording, report = read(tmp_path, table, options=options)
    assert recording.columns["t_us"].tolist() == [0, 2_000_000, 2_500_000, 3_000_000]
    assert report.rows_read == 9 and report.rows_written == 4
    assert report.dropped == {
        "all readings are zero": 1, "a reading is no number": 2, "the time stamp is no number": 2
    }  # fmt: skip
    assert told(report, "time goes back at 1 row: sorted by time")
    assert told(report, "gy: 1 reading at the end of the 16-bit range (clipped)")
    # three zero rates alone may be a sample
    assert len(read(tmp_path, f"{HEAD}\n0,1,0,0\n1,0,0,0")[0]) == 2


@pytest.mark.parametrize("name", ["out.parquet", "out.csv.gz"])
def test_gaps_of_a_channel_stay_gaps_however_often_it_is_imported(tmp_path, name):
    (tmp_path / "in.csv").write_text(f"{HEAD},load\n0,1,1,1,1\n1,1,1,1,\n")
    mapping = [parsed_mapping("load=load")]
    import_recording(tmp_path / "in.csv", tmp_path / "first.csv", mapping=mapping)
    import_recording(tmp_path / "first.csv", tmp_path / name)
    assert read_recording(tmp_path / name, keep_gaps=True).columns["load"].tolist() == [1, GAP]


def test_a_recording_in_this_form_only_changes_its_format(tmp_path):
    columns = {name: np.arange(5) for name in ("gx", "gy", "gz", "load")}
    columns["t_us"] = 3000 + 100_000 * np.arange(5)
    write_recording(recording_from_columns(columns, Scales("X", 10, 77)), tmp_path / "in.csv")
    report = import_recording(tmp_path / "in.csv", tmp_path / "out.parquet")
    recording = read_recording(tmp_path / "out.parquet")
    assert recording.columns["load"].tolist() == [0, 1, 2, 3, 4]
    assert recording.scales.gyro_lsb_per_dps == 77
    assert report.notes == ["a recording in this form already"]
    assert report.lines()[0] == "5 samples: 400 ms at 10 Hz, of 5 rows"
    for told_more in ({"options": Options(hz=5.0)}, {"units": {"gyro": "dps"}}):
        report = read_foreign(tmp_path / "in.csv", **told_more)[1]
        assert told(report, "its own scales and times are kept") and report.odr_hz == 10


@pytest.mark.parametrize("block", [60, 500, 1 << 20])
@pytest.mark.parametrize("checked", [False, True])
def test_a_line_that_is_no_row_keeps_its_place_in_blocks_of_any_size(
    tmp_path, monkeypatch, checked, block
):
    rows = [f"{number % 7 + 0.25},2,{number}" for number in range(60)]
    lost = [3, 4, 29, 59]
    for number in lost:
        rows[number] = rows[number].rpartition(",")[0]
    if checked:
        rows = [f"$IMU,{row}*{reduce(xor, f'IMU,{row}'.encode()):02X}" for row in rows]
    else:
        rows.insert(2, "# a comment")
    head = [] if checked else ["A note", "", "a,b,c"]
    (tmp_path / "in.csv").write_text("\n".join([*head, *rows, ""]))
    for reader in (checked_lines, delimited):
        monkeypatch.setattr(reader, "_BLOCK_BYTES", block)
    opened = checked_lines.checked_lines if checked else delimited.delimited
    found = opened(tmp_path / "in.csv")
    name = found.names[2]
    chunks = list(found.chunks([name]))
    places = np.concatenate([chunk.place for chunk in chunks])
    values = np.concatenate([chunk.columns[name] for chunk in chunks])
    whole = [number for number in range(60) if number not in lost]
    assert places.tolist() == values.tolist() == whole and sum(found.dropped.values()) == len(lost)
    assert checked or "not 3 cells (the first, row 4, has 2)" in found.dropped


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "utf-16-le", "latin-1", "gbk"])
def test_any_encoding_is_read(tmp_path, encoding):
    names = {f"g{a}_dps": f"角速度{a} [°/s]" for a in "xyz" if encoding != "latin-1"}
    frame = table(200).rename(columns={"temp_c": "temp [°C]", **names})
    torn = b"\xff\xff\n" if encoding in ("latin-1", "gbk") else b""
    recording, _ = read(tmp_path, frame.to_csv(index=False).encode(encoding) + torn)
    assert recording.temp_degc()[0] == pytest.approx(25)


THREE = table(50)[RATES].to_numpy()
ROWS = [f"{i / 100},{x:.4f},{y:.4f},{z:.4f}" for i, (x, y, z) in enumerate(THREE)]
PRINTED = [str({"t": i / 100, "gyro": dict(zip("xyz", row.tolist()))})
           for i, row in enumerate(THREE)]  # fmt: skip
TAGGED = ["{}" + " ".join(f"{n}={v:.4f}" for n, v in zip(RATES, row)) for row in THREE]
YEI = ['# Data format: "%int(ChipTimeUS),%float(RawGyroX),%float(RawGyroY),%float(RawGyroZ)"',
       *(f"{10_000 * i},{','.join(map(str, row))}" for i, row in enumerate(THREE))]  # fmt: skip
OWN_UNIT = [str({"t_s": i / 100, "gyro": {"unit": "deg/s", "now": dict(zip("xyz", row.tolist()))}})
            for i, row in enumerate(THREE)]  # fmt: skip
ESP = [f"\x1b[0;32mI ({320 + 10 * i}) imu: gx={r[0]} gy={r[1]} gz={r[2]}\x1b[0m"
       for i, r in enumerate(THREE)]  # fmt: skip
PARTED = [f"12:00:00.{10 * i:03d} -> gX = {x}dps gY = {y}dps | gZ = {z}dps"
          for i, (x, y, z) in enumerate(THREE)]  # fmt: skip
IN_TURNS = [line for i, (x, y, z) in enumerate(THREE)
            for line in (f"[2026-05-01 12:00:00,{10 * i:03d}] INFO: Temperature: 25.5 C",
                         f"Gyro X:{x} Y: {y} Z:{z} deg/s", "knocked"[:i % 2])]  # fmt: skip
SAID = [f"gyro {x} {y} {z}\naccel 0.1 0.2 9.8" for x, y, z in THREE]
LVM = ["LabVIEW Measurement\t", "***End_of_Header***\t", "X_Dimension\tTime\tTime\tTime",
       "X0\t0\t0\t0", "***End_of_Header***", "\t".join(["X_Value", *RATES, "Comment"]),
       *(row.replace(",", "\t") for row in ROWS)]  # fmt: skip
XYZ, DOWN = [dict(zip("xyz", row.tolist())) for row in THREE], {"x": 0.0, "y": 0.0, "z": 9.8}
MESSAGES = [{"Timestamp": 50 * n, "ArrayAcc": 5 * [DOWN], "ArrayGyro": XYZ[5 * n :][:5]}
            for n in range(10)]  # fmt: skip
SENSORS = [{"name": f"gyr{axis}", "units": "deg/s"} for axis in "XYZ"]
EDGE_IMPULSE = {"interval_ms": 10, "sensors": SENSORS, "values": THREE.tolist()}
UNIT_BESIDE = [f"Gyro (deg/s): X = {x}, Y = {y}, Z = {z}" for x, y, z in THREE]
UNIT_AND_NAME = [f"LSM6DSL [acc/mg]:  1, 2, 998\nLSM6DSL [gyro/mdps]:  {x}, {y}, {z}"
                 for x, y, z in 1e3 * THREE]  # fmt: skip
SIGNALS = [f" ({i / 100})  can0  174   [8]  00 0A :: IMU(YawRate: {z} deg/s, RollRate: {x} deg/s, "
           f"PitchRate: {y} deg/s)" for i, (x, y, z) in enumerate(THREE.tolist())]  # fmt: skip
TIMED = [f"2026-05-01 10:00:00.{i:02d}\n  gyro: {x}, {y}, {z}"
         for i, (x, y, z) in enumerate(THREE)]  # fmt: skip
MONITORED = [f"{{}}{i / 100:06.3f}{{}}{row}" for i, row in enumerate(lines(THREE).splitlines())]
COUNTED, BY_NUMBER = Options(hz=100.0), "t_us=1:s gx=2:dps gy=3:dps gz=4:dps"


@pytest.mark.parametrize(
    ("text", "mapping", "options", "lost"),
    [
        ([HEAD, *ROWS[:20], "# somebody knocked", "  ", "", *ROWS[20:]], "", None, 0),
        ([f"# {HEAD}", *ROWS, "# gx_dps,gy_dps,gz_dps,t_s"], "", None, 1),
        (ROWS, BY_NUMBER, None, 0),
        ([*PRINTED, PRINTED[0][:30]],
         "t_us=t:s gx=gyro.x:dps gy=gyro.y:dps gz=gyro.z:dps", None, 2),
        (OWN_UNIT, "", None, 0),
        (YEI, "gx=RawGyroX:dps gy=RawGyroY:dps gz=RawGyroZ:dps", None, 0),
        ([str(row.tolist()) for row in THREE], "gx=[0]:dps gy=[1]:dps gz=[2]:dps", COUNTED, 0),
        ([str(tuple(row)) for row in THREE.tolist()], "gx=[0]:dps gy=[1]:dps gz=[2]:dps", COUNTED,
         0),
        ([str((1, tuple(row))) for row in THREE.tolist()],
         "gx=[1][0]:dps gy=[1][1]:dps gz=[1][2]:dps", COUNTED, 0),
        ([row.format("[IMU DEBUG] ") for row in TAGGED], "", COUNTED, 0),
        ([row.format("[12:00:01.250]") for row in TAGGED], "", COUNTED, 0),
        (["rst:0x1 (POWERON_RESET)", "I (28) boot: ESP-IDF v5.1", *ESP],
         "gx=gx:dps gy=gy:dps gz=gz:dps", None, 0),
        (["ready!", *PARTED, "1 -> gX = 1e999",
          "2999-05-01 12:00:00 -> gX = 1dps gY = 1dps | gZ = 0dps"], "", None, 2),
        (IN_TURNS, "", None, 0),
        (SAID, "'gx=gyro x:dps' 'gy=gyro y:dps' 'gz=gyro z:dps'", COUNTED, 0),
        (LVM, "t_us=X_Value:s", None, 0),
        ([json.dumps({"columns": RATES, "index": [1], "data": THREE.tolist()})], "", COUNTED, 0),
        ([json.dumps(THREE.tolist())], "gx=[0]:dps gy=[1]:dps gz=[2]:dps", COUNTED, 0),
        ([HEAD.replace("g", "imu2_g"), *ROWS], "", None, 0),
        ([json.dumps({"Meas": {"IMU6": MESSAGES}})], "", None, 0),
        ([json.dumps({"protected": {}, "payload": EDGE_IMPULSE})], "", None, 0),
        ([f"{row};" for row in ROWS], BY_NUMBER, None, 0),
        (UNIT_AND_NAME, "", COUNTED, 0),
        (UNIT_BESIDE, "", COUNTED, 0),
        (['"Log Date","1/5/26","","s"', '"Log Time","14:17:54","","s"', HEAD, *ROWS], "", None, 0),
        (SIGNALS, "", None, 0),
        ([f"{row.format('[00:00:', ',000] <inf> imu: ')},25" for row in MONITORED], BY_NUMBER, None,
         0),
        ([f"I ({10 * i}) imu: {row}" for i, row in enumerate(ROWS)],
         "t_us=1:s gx=3:dps gy=4:dps gz=5:dps", None, 0),
        ([row.format("2026-05-01 10:00:", " ") for row in MONITORED], BY_NUMBER, None, 0),
        ([f"00> {row}" for row in ROWS], BY_NUMBER, None, 0),
        (TIMED, "'gx=gyro x:dps' 'gy=gyro y:dps' 'gz=gyro z:dps'", None, 0),
    ],
    ids="comments commented-head no-head dicts unit yei lists tuples nested tag clock esp "
    "parted turns said labview split rows numbered movesense "
    "edge-impulse semicolons named-unit unit-beside settings cantools "
    "zephyr esp-idf coolterm segger clock-above".split(),
)  # fmt: skip
def test_text_of_people_is_read(tmp_path, text, mapping, options, lost):
    recording, report = read(tmp_path, "\n".join(text), "in.log", mapping, options=options)
    assert recording.gyro_dps() == pytest.approx(THREE, abs=0.01)
    assert recording.scales.odr_hz == pytest.approx(100) and sum(report.dropped.values()) == lost


def test_the_digits_of_a_channel_are_kept_by_the_words_that_are_offered(tmp_path):
    turn = np.linspace(0.0, 3.0, 500)
    frame = table(500).assign(quat_w=np.cos(turn))
    with pytest.raises(Exception, match="qw loses its digits.*--map qw=quat_w:x10000") as no:
        read(tmp_path, frame, mapping="qw=quat_w")
    recording, _ = read(tmp_path, frame, mapping=str(no.value).rpartition("--map ")[2])
    assert recording.columns["qw"] == pytest.approx(1e4 * frame["quat_w"], abs=0.51)


@pytest.mark.parametrize("names", ["QuatI QuatJ QuatK QuatReal", "qx qy qz qw"])
def test_an_attitude_is_offered_with_words_that_keep_its_digits(tmp_path, names):
    turn = np.linspace(0.0, 0.04, 500)
    parts = np.array([np.sin(turn), 0 * turn, 0 * turn, np.cos(turn)])
    frame = table(500).assign(**dict(zip(names.split(), parts)))
    _, report = read(tmp_path, frame)
    (offered,) = [line for line in report.lines() if "an attitude" in line]
    recording, _ = read(tmp_path, frame, mapping=offered.rpartition("up:")[2].replace("--map", ""))
    for name, part in zip(("qx", "qy", "qz", "qw"), parts):
        assert recording.columns[name] == pytest.approx(1e6 * part, abs=0.51)


def test_a_clock_that_is_set_back_is_refused(tmp_path):
    frame = table(1000)
    frame.loc[500:, "t_s"] -= 0.3
    with pytest.raises(BadRecording, match="row 501: the clock is set back; cut it there"):
        read(tmp_path, frame)


def test_a_counter_that_jumps_is_offered_as_the_time(tmp_path):
    frame = table(500).drop(columns="t_s").assign(seq=np.arange(500)).drop(range(100, 150))
    _, report = read(tmp_path, frame, options=COUNTED)
    assert any("nothing in the log confirms it" in note for note in report.notes)
    (doubt,) = report.doubts
    assert "'seq' skips 50 samples: give --map t_us=seq:x10000 and not --hz" in doubt
    assert not read(tmp_path, frame[:100], options=COUNTED)[1].doubts
    held = frame[HEAD.split(",")[1:]].loc[frame.index.repeat(2)]  # each row is a time, too
    assert not read(tmp_path, held, options=COUNTED)[1].doubts


CLOCK = [f"12:00:{t:06.3f}" for t in table(500)["t_s"]]
RARE = pd.Timestamp("2021-03-05T23:50") + pd.to_timedelta(np.arange(500) * 15, unit="s")
SINCE_NS = 1_777_636_800_990_000_000 + np.arange(500) * 10_000_000
SINCE = pd.Timestamp("2026-05-01T12:00:57") + pd.to_timedelta(np.arange(500) / 100, "s")
SECONDS = pd.Timestamp("2026-05-01") + pd.to_timedelta(np.arange(500) // 100, "s")


@pytest.mark.parametrize(
    ("columns", "mapping", "step_us"),
    [
        ({"Date": "05/05/2021", "Time": CLOCK}, "", 10_000),  # a day beside its time
        ({"Date": "20210505", "Time": CLOCK}, "", 10_000),
        ({"delay (s)": 0.5, "Zeit (s)": np.arange(500) / 100}, "", 10_000),
        ({"delay (s)": 0.5, "uptime_ms": np.arange(500) * 10}, "", 10_000),
        ({"hhmmss.ms": CLOCK}, "", 10_000),
        ({"t": [f"2026-05-01 {t.replace('.', ':')}" for t in CLOCK]}, "", 10_000),
        ({"iTOW": 137_649_000 + np.arange(500) * 10}, "", 10_000),
        ({"uptime": np.arange(500) / 100}, "", 10_000),
        ({"msec": np.arange(500) * 10}, "", 10_000),
        ({"sys_time": np.arange(500) / 100}, "", 10_000),
        ({"T (°C)": np.arange(500) / 5000, "Zeit (s)": np.arange(500) / 100}, "", 10_000),
        ({"gps_tow": 137_649 + np.arange(500) / 100}, "", 10_000),
        ({"time": RARE.strftime("%H:%M:%S")}, "", 15_000_000),  # over midnight
        ({"time": RARE.strftime("%d-%b-%Y %H:%M:%S")}, "", 15_000_000),
        ({"time": (SINCE + pd.Timedelta("59min")).strftime("%M:%S.%f")}, "", 10_000),
        ({"Unix Time": SINCE_NS // 10**9, "Microseconds": SINCE_NS % 10**9 // 1000}, "", 10_000),
        ({"": SINCE.astype(str)}, "", 10_000),
        ({"time": SINCE.strftime("%Y-%m-%d %H:%M:%S.%f UTC")}, "", 10_000),
        ({"time": [f"{t / 100} sec" for t in range(500)]}, "", 10_000),
        ({"tv_sec": SINCE_NS // 10**9, "tv_usec": SINCE_NS % 10**9 // 1000}, "", 10_000),
        ({"header.stamp.sec": SINCE_NS // 10**9, "header.stamp.nanosec": SINCE_NS % 10**9}, "",
         10_000),
        ({"A": SINCE_NS // 10**9, "B": SINCE_NS % 10**9}, "t_us=A:s+B:ns", 10_000),
        ({"Timestamp": SECONDS, "Milliseconds": np.arange(500) * 10}, "", 10_000),
        ({"ticks": np.arange(500) * 250 + 2**32 - 999}, "t_us=ticks:x40", 10_000),
        ({"t_ms": (65_000 + np.arange(500) * 300) % 2**16}, "", 300_000),
    ],
)  # fmt: skip
def test_the_time_is_found_among_columns(tmp_path, columns, mapping, step_us):
    frame = table(500).drop(columns="t_s")
    recording, _ = read(tmp_path, pd.DataFrame(columns | dict(frame)), mapping=mapping)
    assert np.abs(np.diff(recording.columns["t_us"]) - step_us).max() <= 1


@pytest.mark.parametrize(
    "name",
    [
        *("imu.gyro.{}", "w{}", "gyr_{}", "AngVel{}", "Gyroscope_{}", "{}gyro", "Gy{}", "g{}_mean"),
        *(
            "w_RS_S_{} [rad s^-1]",
            "Гироскоп {} (рад/с)",
            "raw_angular_rate_{}_rad_per_s",
            "{} (rad/sec)",
            "g{}_rad_s",
        ),
        *(
            "Gyro{}_left_leg",
            "gyro_{}_clean",
            "gyro_uncalib_{}",
            "in_anglvel_{}",
            "{}_GYRO_OUT",
            "AngleRate{}",
        ),
        *("rot_rate_{}", "giro_{}", "Angular rate {}v", "Vélocité gyro {}", "giroscopio_{}"),
        *("{}-axis (rad/s)", "imu rate {} [radians per second]", "UncompGyro{}", "{}_rate"),
        *(
            "imu2_g{}",
            "imu1.wb[{}]",
            "g{}1",
            "gyro_{}_2",
            "gyroscope_lsm6ds3_c.{}",
            "gyro {} (in radians/s)",
            "w {} [rad·s⁻¹]",
            "AngularVelocity_{}",
            "gyro_{}",
            "{}_rad_s",
            "twist.angular.{}",
            "gyroscope sensor.values[{}]",
            "raw_g{}",
        ),
    ],
)
def test_usual_names_and_units_of_rates_are_known(tmp_path, name):
    named = {"UncompGyro{}": "012", "imu1.wb[{}]": "012", "AngularVelocity_{}": "123"}
    named["gyroscope sensor.values[{}]"] = "012"
    named |= dict.fromkeys(("{}_rate", "gyro_{}", "{}_rad_s"), ("roll", "pitch", "yaw"))
    axes = named.get(name, "xyz")
    frame = rates(["t_s", *map(name.format, axes)], 300)
    is_named = "rad" in name or "рад" in name
    frame.iloc[:, 1:] = np.radians(frame.iloc[:, 1:]) if is_named else frame.iloc[:, 1:]
    recording, _ = read(tmp_path, frame, units=None if is_named else {"gyro": "dps"})
    assert recording.gyro_dps().mean() == pytest.approx(0.8, abs=0.02)


@pytest.mark.parametrize(
    ("name", "size"),
    [
        ("accel_{}_ug", 1e6), ("imu1.fb{}", 9.80665), ("Corrected Accelerometer Vector {} (g)", 1),
        ("f_{}", 9.80665), ("acce_{} [m·s⁻²]", 9.80665), ("{}_ACCL_OUT (milli-g)", 1e3),
        ("accelerationIncludingGravity.{}", 9.80665), ("GForce{}", 1), ("acelerómetro_{}", 9.80665),
    ],
)  # fmt: skip
def test_usual_names_and_units_of_forces_are_known(tmp_path, name, size):
    force = {name.format(axis): table(300)[f"a{axis}_g"] * size for axis in "xyz"}
    recording, _ = read(tmp_path, table(300)[HEAD.split(",")].assign(**force))
    assert recording.accel_g().mean(axis=0) == pytest.approx([0, 0, 1], abs=0.01)


@pytest.mark.parametrize("axes", [RATES, ["ax_g", "ay_g", "az_g"]])
def test_a_number_that_stands_for_no_reading_on_three_axes_is_none(tmp_path, axes):
    frame = table(2000)
    frame.loc[7::500, axes] = -999.0
    recording, report = read(tmp_path, frame)
    assert len(recording) == 1996 and report.dropped.total() == 4
    assert np.abs(recording.gyro_dps()).max() < 2 and np.abs(recording.accel_g()).max() < 2


def test_dots_part_thousands_where_commas_are_decimal(tmp_path):
    frame = table(300)
    frame["gx_mdps"] = 5000 * frame.pop("gx_dps")
    cells = frame.map(lambda v: f"{v:,.3f}".translate(str.maketrans(",.", ".,")))
    recording, _ = read(tmp_path, cells.to_csv(index=False, sep=";"))
    assert recording.gyro_dps()[:, 0] == pytest.approx(frame["gx_mdps"] / 1000, abs=0.01)


def test_the_acceleration_on_the_left_goes_with_the_rates_on_the_left(tmp_path):
    frame = table(300)
    for side, size in (("l", 1.0), ("r", 1.1)):
        for axis in "xyz":
            frame[f"{side}_acc_{axis}_g"] = frame[f"a{axis}_g"] * size
            frame[f"{side}_gyro_{axis}_dps"] = frame[f"g{axis}_dps"]
    recording, _ = read(tmp_path, frame.drop(columns=[n for n in frame if n[0] in "ag"]))
    assert recording.accel_g()[:, 2].mean() == pytest.approx(1.0, abs=0.01)


def test_a_device_that_zeroes_its_rates_at_rest_is_no_sensor_read_too_fast_and_it_is_said(tmp_path):
    frame = table(2000)
    frame.loc[frame.index % 100 < 40, RATES] = 0.0
    recording, report = read(tmp_path, frame)
    assert len(recording) == 2000 and told(report, "exactly 0 in 40 % of the rows, which hides")
    assert not told(read(tmp_path, table(2000))[1], "exactly 0")


@pytest.mark.parametrize("name", ["gyroRotation{}", "rotationRate.{}"])
def test_rates_beside_the_acceleration_of_a_user_are_those_of_coremotion(tmp_path, name):
    frame = rates(["t_s", *map(name.format, "xyz"), *(f"userAcceleration.{a}" for a in "xyz")], 300)
    frame.iloc[:, 1:4] = np.radians(frame.iloc[:, 1:4])
    recording, report = read(tmp_path, frame)
    assert recording.gyro_dps().mean() == pytest.approx(0.8, abs=0.02)
    assert told(report, "gyro taken in rad/s: as CoreMotion writes")


@pytest.mark.parametrize(("unit", "dps"), [("dps", 1.0), ("rad/s", 57.29578)])
def test_the_steps_of_a_chip_tell_the_unit_of_rates(tmp_path, unit, dps):
    counts = np.rint(131 * rates(["t_s", "gyro_x", "gyro_y", "gyro_z"], 300))
    frame = (counts / 131 / dps).assign(t_s=table(300)["t_s"])
    recording, report = read(tmp_path, frame)
    assert told(report, f"gyro taken in {unit}: its steps are those of a chip")
    assert (recording.gyro_lsb() == counts.iloc[:, 1:]).all(axis=None)


@pytest.mark.parametrize("name", ["FreeAcc_{}_g", "lacc_{}_g", "LinAcc{} (g)"])
def test_acceleration_less_gravity_is_none(tmp_path, name):
    frame = table().rename(columns={f"a{a}_g": name.format(a.upper()) for a in "xyz"})
    assert "ax" not in read(tmp_path, frame)[0].columns


def test_columns_that_are_not_taken_are_offered(tmp_path):
    frame = table(500).rename(columns={"temp_c": "temp_h"}).assign(temp_cpu=40.0, volt=3087.0)
    _, report = read(tmp_path, frame)
    words = "by its name, but temp_h, temp_cpu: the bias cannot be followed over temperature"
    assert told(report, f"{words}; if one of them is the sensor's or near it: --map temp=temp_h")
    assert told(report, "left aside: temp_h, temp_cpu, volt; take one along as --map NAME=COLUMN")
    recording, report = read(tmp_path, frame, mapping="temp=temp_h vdd_mv=volt hot=temp_cpu")
    assert {"temp", "vdd_mv"} <= {*recording.columns} and not told(report, "left aside")
    _, report = read(tmp_path, table(500).rename(columns={"temp_c": "T [C]"}))
    assert told(report, "by its name, but T [C]: ") and told(report, "--map 'temp=T [C]'")
    _, report = read(tmp_path, table(500), mapping="temp=none")
    assert told(report, "no temperature: the bias")


def test_of_several_temperatures_the_gyroscopes_own_is_taken(tmp_path):
    others = {"Processor (degC)": 52.9, "Board (degC)": 31.4, "Gyroscope and more (degC)": 37.1}
    recording, _ = read(tmp_path, table(500).drop(columns="temp_c").assign(**others))
    assert recording.temp_degc().mean() == pytest.approx(37.1, abs=0.1)


def test_of_two_numbered_sensors_those_of_one_number_go_together(tmp_path):
    frame = table(500).rename(columns=lambda name: re.sub("^([ga].)_.*", r"\g<1>1", name))
    second = {f"{kind}{axis}2": frame[f"{kind}{axis}1"] for kind in "ga" for axis in "xyz"}
    frame = frame.assign(**second | {"ax2": frame["az1"], "az2": frame["ax1"]})
    recording, _ = read(tmp_path, frame, mapping="gx=gx2:dps gy=gy2:dps gz=gz2:dps")
    assert recording.accel_g().mean(axis=0) == pytest.approx([1, 0, 0], abs=0.01)


def test_the_acceleration_of_the_same_recording_in_a_file_beside_is_said(tmp_path):
    def beside(name, force):
        (tmp_path / f"{name}.csv").write_text(f"t_s,x,y,z\n0,0,0,{force}\n1,0,0,{force}\n")
        _, report = read(tmp_path, rates(HEAD.split(",")), "Gyroscope_2.csv")
        return report

    assert not told(beside("Accelerometer_2-linear", 0.01), "is beside it")  # it has no gravity
    assert told(beside("Accelerometer", 1.0), "Accelerometer.csv is beside it: zerorate import")
    assert told(beside("Accelerometer_2", 1.0), "Accelerometer_2.csv is beside it")


def test_of_two_accelerations_that_of_the_mapped_rates_is_taken(tmp_path):
    columns = {"t_s": np.arange(9) / 10}
    columns |= {f"imu{n}_{k}": [x] * 9 for n in (1, 2) for k, x in zip("pqr", (n, 2.0, 3.0))}
    columns |= {f"imu{n}_acc_{k}_g": [(k == "z") + n / 100] * 9 for n in (1, 2) for k in "xyz"}
    for n in (1, 2):
        mapping = " ".join(f"g{a}=imu{n}_{k}:dps" for a, k in zip("xyz", "pqr"))
        recording, _ = read(tmp_path, pd.DataFrame(columns), mapping=mapping)
        assert recording.columns["ax"][0] == pytest.approx(163.84 * n, abs=0.5)


def test_a_column_without_a_number_is_left_out_and_the_whole_acceleration_with_it(tmp_path):
    frame = table(400).assign(ax_g=0.0, ay_g="none", az_g=1.0, temp_c="none")
    recording, report = read(tmp_path, frame)
    assert {*recording.columns} == {"t_us", "gx", "gy", "gz"}
    left_out = [line for line in report.notes if "left out: no number is in it" in line]
    assert [line.split("'")[1] for line in left_out] == ["ay_g", "temp_c", "ax_g", "az_g"]


@pytest.mark.parametrize(("every", "lsb_dps"), [(2, 0.002), (4, 0.002), (1, 0.06), (1, 0.2)])
def test_a_sensor_read_faster_than_it_measures_has_each_reading_once(tmp_path, every, lsb_dps):
    readings = np.random.default_rng(5).normal(0.8, 0.05, (3000 // every, 3)) / lsb_dps
    frame = pd.DataFrame(np.repeat(np.rint(readings) * lsb_dps, every, axis=0), columns=RATES)
    frame = frame.assign(t_s=np.arange(3000) * 0.005, other=np.arange(3000))
    recording, report = read(tmp_path, frame, mapping="other=other")
    assert len(recording) == pytest.approx(3000 / every, rel=0.01)
    assert recording.scales.odr_hz == pytest.approx(200 / every)
    assert np.array_equal(recording.columns["other"], recording.columns["t_us"] // 5000)
    assert any("faster than" in reason for reason in report.dropped) is (every > 1)
