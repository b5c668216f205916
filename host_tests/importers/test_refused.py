"""What cannot be imported is refused, each with the words that mend it."""

import json
import os
import re
import zipfile

import numpy as np
import pandas as pd
import pytest
from zerorate_tools.errors import BadRecording, ZerorateError
from zerorate_tools.importers import Options, import_recording, parsed_mapping, read_foreign
from zerorate_tools.importers.report import cut_words

from .test_tables import HEAD, lines, rates, read, table

COUNTS = table()[["t_s", *"gx_dps gy_dps gz_dps ax_g ay_g az_g".split()]]
COUNTS = (16384 * COUNTS).round().set_axis("t_us gx gy gz ax ay az".split(), axis=1)
RAW = dict.fromkeys(("gyro", "accel", "temp"), "lsb")
SCALED = Options(hz=100, gyro_lsb_per_dps=131)
NOISE = np.random.default_rng(4).normal(size=(50, 6)) * [0.01, 0.02, 0.01, 0.1, 0.1, 0.1]
UNNAMED_DATES = "\n".join(f"2026-05-01   10:00:{i // 5:02d} 0.8  0.8   0.9" for i in range(50))
NINE = np.tile(NOISE[:, :3], 3) * np.repeat([9, 1, 9], 3) + [0.8, -0.5, 0.3, 0, 0, 1, 20, -5, 40]
WITH_A_RATE = "// Sample rate: 50.0Hz\nGyr_X;Gyr_Y;Gyr_Z\n" + "0.1;0.2;0.3\n" * 20
SHAKEN = rates("t_s gx_dps gy_dps gz_dps ax ay az".split(), 500)
SHAKEN[["ax", "ay", "az"]] = [0.5, 0.0, 11.6] + 5.0 * np.sin(np.outer(np.arange(500), [1, 2, 3]))
TENS = np.arange(0, 5000, 10)
MINUTE = rates("second gx_dps gy_dps gz_dps minute".split(), 500)
CLOCK = 141700 + np.r_[30:60:0.1, 100:160:0.1]
TURNED = pd.DataFrame({"t_s": TENS / 1e3, "gx": np.sin(TENS), "gy": 0.0, "gz": np.cos(TENS)})
#: Rates that are as long as 1 g, too.
TWO_AS_LONG = table(500).iloc[:, :7].set_axis("t r_x r_y r_z s_x s_y s_z".split(), axis=1)
TWO_AS_LONG.iloc[:, 1:4] *= 1.0 / (0.8 * np.sqrt(3.0))
LISTS = pd.DataFrame({"t_s": np.arange(300) / 100, "pulse": 70, "gyro": "[0.8, -0.5, 0.3]"})


@pytest.mark.parametrize(
    ("frame", "how", "said"),
    [
        ("", {}, "empty file"),
        (HEAD, {}, "no data row"),
        ("a,b\n1,2", {}, "no column for gx, gy, gz; map it: --map gx=COLUMN"),
        ("gx_dps,gy_dps,gz_dps\n1,2,3", {}, "no time stamps; give --hz"),
        (f"{HEAD}\n1,2,3,4", {}, "time stands still"),
        (f"{HEAD},temp_c\n1,0,0,0,0", {}, "no sample is left; 1 row: all readings"),
        (f"{HEAD}\n1,1,1,1", {"mapping": "load=weight"}, "no column 'weight'; choose of t_s, gx_d"),
        (f"{HEAD},load\n0,1,1,1,1\n1,1,1,1,3e9", {"mapping": "load=load"},
         r"row 2: load is 3e\+09, no integer of 32 bits; scale it down"),
        ("t_us,gx_dps,gy_dps,gz_dps\n1,1,1,1\n18446744073709551615,1,1,1", {},
         "row 2: the time stamp is .*name the unit"),
        ("gx,gy,gz\n7,1,0\n-9,1,3", {}, "units of columns 'gx', 'gy', 'gz' are.*--gyro-unit dps"),
        ("gx,gy,gz\n7,1,0\n-9,1,3", {"units": {"gyro": "knots"}}, "column 'gx' cannot be 'knots'"),
        ("gx,gy,gz\n7,1,0\n-9,1,3", {"units": {"gyro": "lsb"}, "options": Options(hz=100)},
         "scale of raw counts.*give --gyro-lsb-per-dps 131 "),
        (COUNTS.assign(temp=-3400), {}, "--gyro-unit lsb .*--accel-unit lsb .*--temp-unit lsb "),
        (COUNTS.assign(temp=-3400), {"units": RAW},
         "--gyro-lsb-per-dps 131 --accel-lsb-per-g 16384 --temp-lsb-per-degc 340 --temp-offset"),
        # as many seconds would be years since 1970
        (table(500).assign(t_s=1.3e9 + 1000 * TENS).rename(columns={"t_s": "timestamp"}), {},
         "--time-unit ms .0.1 Hz. or us .100 Hz.; .*, or --map t_us=COLUMN:xSIZE, ticks of"),
        (" (1.5)  can0  174   [8]  A0 00\n" * 9, {}, "frames of a CAN bus; .* cantools decode"),
        ("(1.500000) can0 174#A000\n" * 9, {}, "frames of a CAN bus; .* cantools decode"),
        ("%RAWIMUSA,2300,4.0;2300,4.0,00000077,1,2,3,4,5,6*ab\n" * 9, {}, "angles .* not rates"),
        ("<UBX(ESF-RAW, data_01=1, dataType_01=14)>\n" * 9, {}, "write kinds 14, 13, 5 as gx"),
        (json.dumps({"fs": 50, "odd": [[1], [2, 3]], "imu": {"gyro_dps": [[1, 2, 3]] * 20}}), {},
         "the source has no time stamps; give --hz 50 .as the file says"),
        ('{"t": "now"}\n{"t": "then"}', {}, "JSON, and no numbers in it; write an object for each"),
        (b"\x00\x01\xff\xfe" * 99, {}, "neither text nor a log of a known kind"),
        (b"ULog\x01\x12\x35" + bytes(9999), {}, "nothing but zeros behind its start"),
        ("hello\nworld", {}, "no table; name a CSV with a row for each sample"),
        ("gx,gy,gz\n7,1,0\n-9,1,99999", {"units": {"gyro": "lsb"}, "options": SCALED},
         "counts from -9 to 99999 are no words of 16 bits; divide them"),
        (rates("t_s deg/h_x deg/h_y deg/h_z".split(), 99),
         {"mapping": "gx=deg/h_x gy=deg/h_y gz=deg/h_z"}, "divide them by 3600"),
        (b"PK\x03\x04" + bytes(500), {}, "the zip is cut off or damaged; copy it again"),
        ("version https://git-lfs.github.com/spec/v1\noid sha256:1bf6", {},
         "a pointer of Git LFS, not the file; .*git lfs pull"),
        ("$GPGGA,205250.75,5242.3734,N,0,,*0F\n$GNGSA,A,1,,*1D\n" * 20, {}, "no column for gx"),
        (f"{HEAD},flag\n0,1,2,3\n1,2,3,4", {}, "line 1 names 5 columns, but rows have 4: they are"),
        ("\n".join(f"{i},{'walk' if i % 9 else 'run'},0.{i},{i}.5" for i in range(50)), {},
         r"called 1, 2, 3, ...\); map it: --map gx=COLUMN:UNIT"),
        (UNNAMED_DATES, {}, "--map t_us=2:s --map gx=3 --map gy=4 "),
        (lines(NOISE + [49.0, 0, 0, 0, 0, 0]), {}, "map it: --map gx=COLUMN:UNIT.* one of 1, 2, 3"),
        (SHAKEN, {}, "give --accel-unit m/s2 [(]or g, mg"),
        (lines(np.column_stack([TENS / 1e3, SHAKEN.iloc[:, 4:] / 10, SHAKEN.iloc[:, 4:] - 0.6])),
         {}, "--map t_us=1:s --map ax=5:m/s2 .*--map gx=2:rad/s"),
        (SHAKEN, {"units": {"accel": "g"}}, "mean m/s2[?] Give --accel-unit m/s2; else map other"),
        (WITH_A_RATE, {}, "--gyro-unit dps .*, --hz 50 [(]as the file says[)]"),
        (WITH_A_RATE.replace("// Sample rate", "Acquisition frequency"), {"units": {"gyro": "dps"}},
         "time stamps; give --hz 50 [(]as the file says"),
        (LISTS, {}, "COLUMN one of t_s, pulse; gyro: no number alone"),
        (rates(["n", *HEAD.split(",")[1:]]).assign(n=range(2000)), {}, "no time stamps; give --hz"),
        (table(500).assign(t_s=10).rename(columns={"t_s": "dt"}), {}, "--hz 100 .as column 'dt'"),
        (table(500).assign(t_s=TENS, ticks=TENS).rename(columns={"t_s": "n"}), {},
         "give --time-unit s .0.1 Hz. or ms .100 Hz.*; or --hz, .* ticks of SIZE us"),
        (table(500).rename(columns=lambda name: name.replace("g", "r", 1)[:2]), {},
         "ax=ax, ay=ay, az=az; .* --map gx=rx --map gy=ry --map gz=rz"),
        (table(500).set_axis("t 旋x 旋y 旋z 力x 力y 力z T".split(), axis=1), {},
         "rates: --map 'gx=旋x' .*--map 'ax=力x'"),
        (table(500).set_axis("t xv yv zv xa ya za T".split(), axis=1).assign(xo=0, yo=0, zo=0), {},
         "rates: --map gx=xv .*--map ax=xa"),
        (lines(table(500)[[*HEAD.split(","), "az_g", "ax_g", "ay_g"]].to_numpy()), {},
         "--map ax=5:g --map ay=6:g --map az=7:g --map gx=2:dps"),
        (TWO_AS_LONG, {}, "rates: --map gx=r_x .*--map ax=s_x"),
        (table(500).assign(temp_c=77.5).rename(columns={"temp_c": "temp"}), {},
         "unit of column 'temp' is not known; give --temp-unit degc .or k, degf"),
        (table(500).assign(t_s=range(500)).rename(columns={"t_s": "time"}), {},
         "--time-unit s .*; or --hz, rows a second, if it counts them"),
        ("t_s,gx_dps,gy_dps,gz_dps,ax,ay,az\n0,1,1,1,2.5,2.5,0", {}, "--accel-unit m/s2 [^-]*$"),
        (table(500).assign(az_g=0.1), {}, "map other columns, or leave it out by --map ax=none"),
        (table(500).rename(columns={"t_s": "min.timestamp"}), {}, r"--time-unit s \(100 Hz\)"),
        (table(500).assign(t_s=TENS, clock_ms=TENS), {}, "--map t_us=t_s:ms, or map .clock_"),
        (table(900).assign(t_s=CLOCK), {}, "write colons"),
        ("t_s,gx,gy,gz\n" + "0,9 dps,1 dps,1 dps\n" * 500 + "1,9 dps,0.1 rad/s,1 dps\n", {},
         "row 501: 0.1 rad/s is in another unit than column 'gy .dps.'; write all"),
        (MINUTE.assign(second=TENS // 1000, msec=TENS % 1000), {}, "no time stamps; give --hz"),
        (table(500).rename(columns={"t_s": "time"}).assign(time="May 1st, at noon"), {},
         "no time can be read from column 'time'; .*--hz N"),
        (table(500), {"instance": 1}, "there is one gyroscope; leave --instance away"),
        (table(500).assign(**{f"b_gyro_{a}_dps": 1.0 for a in "xyz"}), {"instance": 2},
         "there are 2 gyroscopes; give --instance 0 to 1"),
        (COUNTS[["ax", "ay", "az"]], {}, "gz beside ax=ax, .*; map it: --map gx=COLUMN:UNIT"),
        (COUNTS[["ax", "ay", "az"]].set_axis([*"xyz"], axis=1), {}, "no rates .they are as long"),
        (lines(COUNTS[["ax", "ay", "az"]].to_numpy()), {}, r"3, ...\); map it: --map gx=COLUMN:UN"),
        (TURNED, {}, "no column for gx, gy, gz beside t_us=t_s; map it"),
        (TURNED.assign(rot_rate_x=0.1, rot_rate_y=0.2, rot_rate_z=0.3), {},
         "units of columns 'rot_rate_x', 'rot_rate_y', 'rot_rate_z' are not"),
        (table(500).assign(t_s=TENS / 6e4).rename(columns={"t_s": "at min"}), {}, "give --hz, s"),
        (lines(NINE), {}, "--map az=6:g --map gx=1:dps --map gy=2:dps --map gz=3:dps"),
        (lines(NINE[:, 3:]), {}, r"3, ...\); map it: --map gx=COLUMN:UNIT"),
        ("#IMU,1,2,3\n" * 9, {}, "row 1: each line begins with '#', as comments do: .*; take it"),
        (json.dumps({"fs": 50, "data": [{"gx_dps": 1, "gy_dps": 2, "gz_dps": 3}] * 10}), {},
         "give --hz 50 .as the file says"),
        (rates("t_s gyro_x_rpm gyro_y_rpm gyro_z_rpm".split()), {}, "the unit 'rpm' .*dps one is"),
        (rates("t_s r.beta r.gamma r.alpha".split()), {}, "--map gx=r.beta:dps --map gy=r.gamma:d"),
        (rates("t_s omega_x omega_y omega_z".split()), {}, "give --gyro-unit rad/s .or dps"),
        (rates("t_s p q r".split()), {}, "if these are rates: --map gx=p --map gy=q"),
        # a quaternion is none, and a phone's Sensor Logger writes radians
        (rates("t_s x y z w".split()), {}, "--map gx=COLUMN:UNIT.* COLUMN one of t_s, x"),
        (rates("seconds_elapsed x y z".split()), {}, "--map gx=x:rad/s --map gy=y:rad/s"),
        (rates([f"Acc{end}" for end in ("_t (s)", *(f" {a} (m/s^2)" for a in "xyz"))]), {},
         "these are no rates .the units of all columns"),
        (f",{LISTS.to_csv(index=False)}".replace("\n", "\n,"), {}, "t_s, pulse; gyro: no number"),
    ],
)  # fmt: skip
def test_a_table_that_cannot_be_imported_says_what_to_do(tmp_path, frame, how, said):
    with pytest.raises(BadRecording, match=said) as caught:
        read(tmp_path, frame, "in.csv", **how)
    assert "\n" not in str(caught.value)


def test_a_stepper_that_shakes_at_an_eighth_of_the_rate_is_no_eight_devices(tmp_path):
    frame, at = table(4000), np.arange(4000)
    frame["gx_dps"] += np.sin(2 * np.pi * 0.1263 * at) + np.sin(np.pi * 0.1263 * at)
    assert not read(tmp_path, frame)[1].doubts
    frame["gx_dps"] += 3.0 * np.sin(np.pi * at / 4)
    with pytest.raises(BadRecording, match="rows of 8 devices take turns"):
        read(tmp_path, frame)


def test_a_limb_that_swings_is_pushed_along_itself(tmp_path):
    swung = SHAKEN.assign(az=SHAKEN.az - 9.5)
    assert read(tmp_path, swung, units={"accel": "g"})


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        ("gx", "no mapping: write gx=COLUMN:UNIT"),
        ("gx=w:furlongs", "unit 'furlongs' of gx is none of dps"),
        ("load=w:dps", "an extra channel takes a factor: load=w:x100"),
        ("t=time:s", "t is none of t_us, gx, .*, temp, and"),
    ],
)
def test_a_mapping_that_is_none_says_how(words, complaint):
    with pytest.raises(ValueError, match=complaint):
        parsed_mapping(words)


def test_what_is_no_file_is_said(tmp_path):
    with pytest.raises(BadRecording, match="no such file"):
        read_foreign(tmp_path / "none.csv")
    (tmp_path / "a").write_text("x")
    with pytest.raises(BadRecording, match="a directory"):
        read_foreign(tmp_path / "a" / "b.csv")
    os.mkfifo(tmp_path / "pipe.csv")
    with pytest.raises(BadRecording, match="neither a file nor a folder"):
        import_recording(tmp_path / "pipe.csv", tmp_path / "out.parquet")


def test_any_damage_of_a_zip_is_said_in_one_line(tmp_path):
    path = tmp_path / "in.zip"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as packed:
        packed.writestr("run.csv", f"{HEAD}\n" + "0.1,1,2,3\n" * 99)
    whole = path.read_bytes()
    for at in range(0, len(whole), 8):
        damaged = bytearray(whole)
        damaged[at] ^= 0xB5
        path.write_bytes(damaged)
        with pytest.raises(ZerorateError) as caught:
            read_foreign(path)
        assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("name", "names", "told"),
    [
        ("Raw.csv", "X_(m/s^2) Y_(m/s^2) Z_(m/s^2)", "no rates [(]the unit of .X_"),
        ("turned.csv", "x y z", "no rates [(]they are as long as gravity"),
        ("Magnetometer.csv", "x y z", "no rates [(]the file is called Magnetometer.csv"),
    ],
)
def test_axes_of_another_sensor_are_offered_as_no_rates(tmp_path, name, names, told):
    (tmp_path / "Gyroscope.csv").write_text("t_s,x,y,z\n")
    frame = table()[["t_s", "ax_g", "ay_g", "az_g"]].set_axis(["t_s", *names.split()], axis=1)
    with pytest.raises(BadRecording, match=told) as error:
        read(tmp_path, frame, name)
    assert not re.search("--map gx=[xX]", str(error.value))
    assert "likely in Gyroscope.csv: zerorate import" in str(error.value)


def test_cut_is_offered_for_what_it_can_read(tmp_path):
    assert "zerorate cut" in cut_words(tmp_path / "a.csv", 9)
    assert "zerorate cut" not in cut_words(tmp_path, 9)
