"""Tables as people have them: each is read, or the error has the words that mend it."""

import re

import numpy as np
import pandas as pd
import pytest
from zerorate_tools.errors import BadRecording, InFile
from zerorate_tools.importers import Options, import_recording, parsed_mapping, read_foreign

HEAD = "t_s,gx_dps,gy_dps,gz_dps"


def table(n=2000, hz=100.0):
    """A rest with usual names and units in them."""
    rng = np.random.default_rng(3)
    columns = {"t_s": np.arange(n) / hz}
    columns |= {f"g{a}_dps": 0.8 + 0.05 * rng.standard_normal(n) for a in "xyz"}
    columns |= {f"a{a}_g": (a == "z") + 0.004 * rng.standard_normal(n) for a in "xyz"}
    return pd.DataFrame(columns | {"temp_c": 25 + 0.001 * np.arange(n)})


def read(tmp_path, frame, name="in.csv", mapping="", **options):
    """What an import makes of a frame, or of a text."""
    if isinstance(frame, pd.DataFrame):
        frame = frame.to_csv(index=False)
    content = frame if isinstance(frame, bytes) else frame.encode()
    (tmp_path / name).write_bytes(content)
    words = [parsed_mapping(word) for word in mapping.split()]
    return read_foreign(tmp_path / name, mapping=words, **options)


def told(report, words):
    return any(words in line for line in report.lines())


# Text


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "utf-16-le", "latin-1"])
def test_any_encoding_is_read(tmp_path, encoding):
    frame = table(200).rename(columns={"temp_c": "temp [°C]"})
    recording, _ = read(tmp_path, frame.to_csv(index=False).encode(encoding))
    assert len(recording) == 200
    assert recording.temp_degc()[0] == pytest.approx(25)


def test_a_decimal_comma_is_read(tmp_path):
    text = table(200).to_csv(index=False, sep=";", decimal=",")
    recording, _ = read(tmp_path, text)
    assert recording.gyro_dps().mean() == pytest.approx(0.8, abs=0.02)


@pytest.mark.parametrize(
    "before", ["\n\n", "# a log\n# of a day\n", "Device: X\nStarted at noon\n\n"]
)
def test_lines_before_the_header_are_skipped(tmp_path, before):
    recording, _ = read(tmp_path, before + table(200).to_csv(index=False))
    assert len(recording) == 200


@pytest.mark.parametrize("units", ["s,deg/s,deg/s,deg/s", "[ms],[rad/s],[rad/s],[rad/s]"])
def test_a_line_of_units_beneath_the_names_is_one(tmp_path, units):
    frame = table()[["t_s", "gx_dps", "gy_dps", "gz_dps"]]
    if "ms" in units:
        frame = np.radians(frame).assign(t_s=1000 * frame["t_s"])
    text = f"t,gx,gy,gz\n{units}\n" + frame.to_csv(index=False, header=False)
    recording, _ = read(tmp_path, text)
    assert len(recording) == 2000 and recording.scales.odr_hz == pytest.approx(100)
    assert recording.gyro_dps().mean() == pytest.approx(0.8, abs=0.02)


def test_json_says_what_to_do_with_it(tmp_path):
    with pytest.raises(BadRecording, match="JSON, which is not read; write it as a CSV"):
        read(tmp_path, '{"t": 0.01, "gx": 0.1}\n{"t": 0.02, "gx": 0.1}\n')


def test_comments_between_rows_are_no_rows(tmp_path):
    lines = table(200).to_csv(index=False).splitlines()
    lines.insert(50, "# somebody knocked")
    recording, report = read(tmp_path, "\n".join(lines))
    assert len(recording) == 200 and not report.dropped


def test_a_header_in_a_comment_and_columns_by_number(tmp_path):
    rows = "\n".join("0.01,0.8,0.8,0.9".replace("0.01", str(i / 100)) for i in range(50))
    recording, _ = read(tmp_path, f"# {HEAD}\n{rows}\n")
    assert len(recording) == 50
    recording, _ = read(tmp_path, f"{rows}\n", mapping="t_us=1:s gx=2:dps gy=3:dps gz=4:dps")
    assert len(recording) == 50
    with pytest.raises(BadRecording, match="if these are rates: --map t_us=1:s --map gx=2:dps"):
        read(tmp_path, f"{rows}\n")


def test_columns_that_nothing_names_are_offered_by_what_they_hold(tmp_path):
    rows = [[i * 20, 0.1, 0.2, 9.79, 0.01, 0.02, -0.03, 21.5] for i in range(50)]
    ready = "t_us=1:ms ax=2:m/s2 ay=3:m/s2 az=4:m/s2 gx=5:rad/s gy=6:rad/s gz=7:rad/s"
    text = "\n".join(",".join(map(str, row)) for row in rows)
    with pytest.raises(BadRecording, match=" ".join(f"--map {word}" for word in ready.split())):
        read(tmp_path, text)
    recording, _ = read(tmp_path, text, mapping=ready)
    assert recording.scales.odr_hz == pytest.approx(50)
    counts = "\n".join(f"{100 + i % 3},{-40 - i % 2},{7 + i % 5}" for i in range(50))
    with pytest.raises(BadRecording, match="--map gx=1:lsb --map gy=2:lsb --map gz=3:lsb"):
        read(tmp_path, counts)


def test_cells_may_stand_in_columns_of_blanks(tmp_path):
    rows = "".join(f"   {i / 100:.7e}   {0.8:.7e}  -8.0e-01\t 9.0e-01 \r\n" for i in range(50))
    (tmp_path / "in.mat").write_bytes(rows.encode())
    mapping = [parsed_mapping(word) for word in "t_us=1:s gx=2:dps gy=3:dps gz=4:dps".split()]
    recording, report = read_foreign(tmp_path / "in.mat", mapping=mapping)
    assert len(recording) == 50 and not report.dropped
    assert recording.gyro_dps().mean(axis=0) == pytest.approx([0.8, -0.8, 0.9], abs=0.01)


def test_a_rate_in_the_head_is_offered_with_the_units(tmp_path):
    text = "// Sample rate: 50.0Hz\n" + "".join(f"{x}\n" for x in ["Gyr_X;Gyr_Y;Gyr_Z"])
    text += "0.1;0.2;0.3\n" * 20
    with pytest.raises(BadRecording, match="--gyro-unit dps .*, --hz 50 [(]as the file says[)]"):
        read(tmp_path, text)
    with pytest.raises(BadRecording, match="no time stamps; give --hz 50 [(]as the file says[)]"):
        read(tmp_path, text, units={"gyro": "dps"})


def test_rows_without_readings_have_no_say_about_the_clock(tmp_path):
    rows = "".join(f"{1.4e18 + i * 5e6:.0f},0.8,0.8,0.9\n" for i in range(50))
    notes = "1403636763.853,,,\n1403636763.848,,,\n"
    recording, report = read(tmp_path, "timestamp [ns],gx_dps,gy_dps,gz_dps\n" + rows + notes)
    assert len(recording) == 50 and report.dropped["no reading of these columns"] == 2
    assert not told(report, "ran over")


def test_a_flight_is_no_steady_rate(tmp_path):
    frame = table()
    frame["gz_dps"] = 60 + 40 * np.sin(np.arange(len(frame)) / 500)
    assert not told(read(tmp_path, frame)[1], "a steady rate")
    frame["gz_dps"] = 60 + 0.05 * np.sin(np.arange(len(frame)))
    assert told(read(tmp_path, frame)[1], "a steady rate of 60 dps")


def test_a_pointer_of_git_lfs_is_told_from_a_table(tmp_path):
    with pytest.raises(BadRecording, match="a pointer of Git LFS, not the file; .*git lfs pull"):
        read(tmp_path, "version https://git-lfs.github.com/spec/v1\noid sha256:1bf6\nsize 41\n")


# Names and units


@pytest.mark.parametrize(
    "names",
    [
        "imu.gyro.x imu.gyro.y imu.gyro.z",
        "wx wy wz",
        "gyr_x gyr_y gyr_z",
        "AngVelX AngVelY AngVelZ",
        "Gyroscope_X Gyroscope_Y Gyroscope_Z",
        "xgyro ygyro zgyro",
    ],
)
def test_usual_names_need_but_a_unit_and_the_words_for_it_work(tmp_path, names):
    frame = table()[["t_s", *(f"g{a}_dps" for a in "xyz")]]
    frame.columns = ["t_s", *names.split()]
    with pytest.raises(BadRecording, match="not known; give --gyro-unit dps [(]or"):
        read(tmp_path, frame)
    recording, _ = read(tmp_path, frame, units={"gyro": "dps"})
    assert recording.gyro_dps().mean() == pytest.approx(0.8, abs=0.02)


def test_a_unit_in_the_name_is_enough(tmp_path):
    frame = table()[["t_s", *(f"g{a}_dps" for a in "xyz")]]
    frame.columns = ["Time (s)", "GyroX [deg/s]", "GyroY [deg/s]", "GyroZ [deg/s]"]
    recording, _ = read(tmp_path, frame)
    assert recording.gyro_dps().mean() == pytest.approx(0.8, abs=0.02)


@pytest.mark.parametrize(
    "names",
    [
        "w_RS_S_x [rad s^-1] w_RS_S_y [rad s^-1] w_RS_S_z [rad s^-1]",
        "raw_angular_rate_x_rad_per_s raw_angular_rate_y_rad_per_s raw_angular_rate_z_rad_per_s",
        "X (rad/sec) Y (rad/sec) Z (rad/sec)",
        "imu rate x [radians per second] imu rate y [radians per second] "
        "imu rate z [radians per second]",
    ],
)
def test_a_unit_of_rates_tells_what_a_column_is(tmp_path, names):
    frame = table()[["t_s", *(f"g{a}_dps" for a in "xyz")]]
    frame.columns = ["timestamp_seconds", *re.findall(r"\S.*?(?:[])]|per_s)", names)]
    recording, _ = read(tmp_path, frame)
    assert recording.gyro_dps().mean() == pytest.approx(np.degrees(0.8), abs=0.5)


def test_body_rates_are_offered(tmp_path):
    frame = table()[["t_s", *(f"g{a}_dps" for a in "xyz")]]
    frame.columns = ["t_s", "p", "q", "r"]
    with pytest.raises(BadRecording, match="if these are rates: --map gx=p:dps --map gy=q:dps"):
        read(tmp_path, frame)


def test_bare_axes_are_offered_too(tmp_path):
    frame = table()[["t_s", *(f"g{a}_dps" for a in "xyz")]]
    frame.columns = ["t_s", "xaxis", "yaxis", "zaxis"]
    with pytest.raises(BadRecording, match="--map gx=xaxis:dps --map gy=yaxis:dps"):
        read(tmp_path, frame)


def test_a_phones_sensor_logger_is_known_by_its_columns(tmp_path):
    frame = table()
    at_ns = 1_777_636_800_000_000_000 + (frame["t_s"] * 1e9).astype("int64")
    rates = {a: np.radians(frame[f"g{a}_dps"]) for a in "zyx"}
    logged = pd.DataFrame({"time": at_ns, "seconds_elapsed": frame["t_s"], **rates})
    recording, report = read(tmp_path, logged, name="Gyroscope.csv")
    assert recording.scales.odr_hz == pytest.approx(100, rel=1e-3)
    assert recording.gyro_dps().mean() == pytest.approx(0.8, abs=0.02)
    assert told(report, "gyro taken in rad/s: as Sensor Logger writes")


def test_a_phones_sensorlog_is_known_by_its_columns(tmp_path):
    frame = table()
    logged = {"loggingTime(txt)": [f"2026-05-01 12:00:{t:06.3f} +0200" for t in frame["t_s"]]}
    logged |= {f"gyroRotation{a.upper()}(rad/s)": np.radians(frame[f"g{a}_dps"]) for a in "xyz"}
    recording, _ = read(tmp_path, pd.DataFrame(logged))
    assert recording.scales.odr_hz == pytest.approx(100, rel=1e-3)
    assert recording.gyro_dps().mean() == pytest.approx(0.8, abs=0.02)


def test_a_csv_of_plotjuggler_is_known_by_its_columns(tmp_path):
    frame = table()
    columns = {"__time": 1_777_636_800 + frame["t_s"]}
    for topic in ("/imu", "/second"):
        columns |= {f"{topic}/angular_velocity/{a}": np.radians(frame[f"g{a}_dps"]) for a in "xyz"}
        columns |= {f"{topic}/linear_acceleration/{a}": 9.8 * frame[f"a{a}_g"] for a in "xyz"}
    recording, report = read(tmp_path, pd.DataFrame(columns))
    assert recording.gyro_dps().mean() == pytest.approx(0.8, abs=0.02)
    assert recording.accel_g()[:, 2].mean() == pytest.approx(1, abs=0.01)
    assert told(report, "of several gyroscopes (/imu/angular_velocity/x, /second/")
    with pytest.raises(BadRecording, match="there are 2 gyroscopes; give --instance 0 to 1"):
        read(tmp_path, pd.DataFrame(columns), instance=2)
    with pytest.raises(BadRecording, match="there is one gyroscope; leave --instance away"):
        read(tmp_path, frame, instance=1)


def test_degrees_declared_as_radians_are_refused_with_the_right_words(tmp_path):
    frame = table()
    for axis in "xyz":
        frame[f"g{axis}_dps"] += 60.0 * np.sin(np.arange(2000) / 50)
    frame.columns = ["t_s", "p", "q", "r", *frame.columns[4:]]
    words = "gx=p:rad/s gy=q:rad/s gz=r:rad/s"
    with pytest.raises(BadRecording, match="did you mean dps[?] Give --map gx=p:dps") as error:
        read(tmp_path, frame, mapping=words)
    assert "34" in str(error.value)  # more than 3400 dps
    mended = words.replace("rad/s", "dps")
    assert read(tmp_path, frame, mapping=mended)[1].doubts == []


@pytest.mark.parametrize(
    ("words", "doubt"),
    [
        ("gx=gx_dps:rad/s gy=gy_dps:rad/s gz=gz_dps:rad/s", "a steady rate of 4[56].*mean dps"),
        ("gx=gx_dps:mdps gy=gy_dps:mdps gz=gz_dps:mdps", None),
        ("ax=ax_g:m/s2 ay=ay_g:m/s2 az=az_g:m/s2", "usual acceleration is 0.102 g.*mean g[?]"),
        ("temp=temp_c:k", "usual temperature is -24.*--map temp=temp_c:k"),
        ("temp=zero:degc", "temperature is 0 throughout.*--map temp=none"),
    ],
)
def test_a_unit_that_cannot_be_is_doubted(tmp_path, words, doubt):
    _, report = read(tmp_path, table().assign(zero=0), mapping=words)
    if doubt is None:
        assert report.doubts == []
    else:
        [said] = report.doubts
        assert re.search(doubt, said)


def test_a_rest_in_degrees_declared_as_radians_is_doubted(tmp_path):
    frame = table().rename(columns={f"g{a}_dps": f"gyro_{a}" for a in "xyz"})
    frame[[f"gyro_{a}" for a in "xyz"]] -= 0.7
    _, report = read(tmp_path, frame, units={"gyro": "rad/s"})
    [said] = report.doubts
    assert re.search("noise of 3 dps is more .* did you mean dps[?] [(]--gyro-unit dps[)]", said)
    assert read(tmp_path, frame, units={"gyro": "dps"})[1].doubts == []


def test_raw_counts_are_asked_for_units_and_then_scales_in_one_go_each(tmp_path):
    frame = (16384 * table()[["t_s", *"gx_dps gy_dps gz_dps ax_g ay_g az_g".split()]]).round()
    frame.columns = ["t_us", "gx", "gy", "gz", "ax", "ay", "az"]
    frame["temp"] = -3400
    give = "--gyro-unit lsb .*--accel-unit lsb .*--temp-unit lsb "
    with pytest.raises(BadRecording, match=give):
        read(tmp_path, frame)
    units = dict.fromkeys(("gyro", "accel", "temp"), "lsb")
    give = "--gyro-lsb-per-dps 131 --accel-lsb-per-g 16384 --temp-lsb-per-degc 340 --temp-offset"
    with pytest.raises(BadRecording, match=give):
        read(tmp_path, frame, units=units)


def test_radians_declared_as_degrees_are_doubted(tmp_path):
    frame = table()
    for axis in "xyz":
        frame[f"g{axis}_dps"] = np.radians(frame[f"g{axis}_dps"])
    _, report = read(tmp_path, frame)
    assert "did you mean rad/s?" in report.doubts[0]


def test_ninety_degrees_within_seconds_are_doubted(tmp_path):
    frame = table(400).assign(temp_c=np.linspace(-20, 74, 400))
    _, report = read(tmp_path, frame)
    assert "90.2 degC within 3.99 s cannot be" in report.doubts[0]
    _, report = read(tmp_path, frame, options=Options(hz=1))
    assert report.doubts == []


def test_rows_that_are_means_are_known_as_such(tmp_path):
    frame = table(200, 1 / 15)
    recording, report = read(tmp_path, frame)
    assert recording.scales.more["row_is_mean_of_s"] == 15
    assert recording.scales.gyro_lsb_per_dps == 1000
    assert told(report, "a row every 15 s: each taken as the mean over that time")


def test_a_name_as_long_as_names_may_be_is_written(tmp_path):
    source = tmp_path / "in.csv"
    source.write_text(table(50).to_csv(index=False))
    out = tmp_path / ("x" * 242 + ".parquet")
    import_recording(source, out)
    assert [path.name for path in tmp_path.glob("*.parquet")] == [out.name]
    with pytest.raises(InFile, match="the name is longer than 255 bytes; give it a shorter one"):
        import_recording(source, tmp_path / ("x" * 250 + ".parquet"))
