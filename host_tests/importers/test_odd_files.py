"""Tables as people have them: each is read, or the error has the words that mend it."""

import re

import numpy as np
import pandas as pd
import pytest
from zerorate_tools.errors import BadRecording, InFile
from zerorate_tools.importers import Options, import_recording, parsed_mapping, read_foreign

RNG = np.random.default_rng(3)
HEAD = "t_s,gx_dps,gy_dps,gz_dps"


def table(n=2000, hz=100.0):
    """A rest with usual names and units in them."""
    columns = {"t_s": np.arange(n) / hz}
    columns |= {f"g{a}_dps": 0.8 + 0.05 * RNG.standard_normal(n) for a in "xyz"}
    columns |= {f"a{a}_g": (a == "z") + 0.004 * RNG.standard_normal(n) for a in "xyz"}
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


# Time


def test_a_gap_of_five_minutes_does_not_change_the_rate(tmp_path):
    frame = table()
    frame.loc[1000:, "t_s"] += 300
    recording, report = read(tmp_path, frame)
    assert recording.scales.odr_hz == pytest.approx(100, rel=1e-4)
    assert told(report, "a gap of 5 min in the time stamps")


def test_rows_out_of_order_are_sorted_and_said(tmp_path):
    frame = table()
    shuffled = frame.iloc[np.argsort(np.arange(2000) + RNG.uniform(0, 4, 2000))]
    recording, report = read(tmp_path, shuffled)
    assert recording.columns["t_us"].tolist() == [i * 10_000 for i in range(2000)]
    assert told(report, "rows: sorted by time")


def test_the_second_half_of_a_log_before_the_first_is_sorted(tmp_path):
    frame = table()
    recording, _ = read(tmp_path, pd.concat([frame[1000:], frame[:1000]]))
    assert recording.columns["t_us"].tolist() == [i * 10_000 for i in range(2000)]


def test_two_power_ons_in_one_file_are_not_mixed(tmp_path):
    frame = table()
    with pytest.raises(BadRecording, match="row 2001: time begins anew; cut it there"):
        read(tmp_path, pd.concat([frame, frame]))


def test_a_counter_that_ran_over_goes_on(tmp_path):
    frame = table().rename(columns={"t_s": "t_us"})
    frame["t_us"] = (2**32 - 5_000_000 + np.arange(2000) * 10_000) % 2**32
    recording, report = read(tmp_path, frame)
    assert (np.diff(recording.columns["t_us"]) == 10_000).all()
    assert told(report, "a clock of 32 bits ran over at row 501: counted on")


@pytest.mark.parametrize(
    "stamp",
    ["2026-05-01T12:00:{:06.3f}Z", "2026-05-01 12:00:{:06.3f}", "2026-05-01T14:00:{:06.3f}+02:00"],
)
def test_dates_of_iso_8601_are_times(tmp_path, stamp):
    frame = table().rename(columns={"t_s": "time"})
    frame["time"] = [stamp.format(i / 100) for i in range(2000)]
    recording, _ = read(tmp_path, frame)
    assert recording.columns["t_us"][0] == 1_777_636_800_000_000
    assert (np.diff(recording.columns["t_us"]) == 10_000).all()


@pytest.mark.parametrize("stamp", ["01.05.2026 12:00:{:06.3f}", "12:00:{:06.3f}"])
def test_a_time_that_cannot_be_read_says_how_to_write_it(tmp_path, stamp):
    frame = table(500).rename(columns={"t_s": "time"})
    frame["time"] = [stamp.format(t) for t in frame["time"]]
    with pytest.raises(BadRecording, match="no time can be read from column 'time'; .*--hz N"):
        read(tmp_path, frame)


def test_stamps_that_are_coarser_than_the_samples_tell_the_rate(tmp_path):
    frame = table()
    frame["t_s"] = frame["t_s"].round(1)
    frame.loc[1000:, "t_s"] += 300
    recording, report = read(tmp_path, frame)
    assert recording.scales.odr_hz == pytest.approx(100, rel=0.01)
    assert told(report, "time stamps repeat, and rows at a time that stands still teach nothing")


def test_seconds_and_nanoseconds_are_added(tmp_path):
    frame = table()
    at_ns = 1_777_636_800_990_000_000 + np.arange(2000) * 10_000_000
    frame.insert(0, "header.stamp.sec", at_ns // 10**9)
    frame.insert(1, "header.stamp.nanosec", at_ns % 10**9)
    recording, _ = read(tmp_path, frame.drop(columns="t_s"))
    assert np.abs(recording.columns["t_us"] - at_ns // 1000).max() <= 1
    named = frame.drop(columns="t_s").set_axis(["A", "B", *frame.columns[3:]], axis=1)
    again, _ = read(tmp_path, named, mapping="t_us=A:s+B:ns")
    assert again.columns["t_us"].tolist() == recording.columns["t_us"].tolist()


def test_a_rate_overrides_a_time_column_and_says_so(tmp_path):
    frame = table(50).rename(columns={"t_s": "when"}).assign(timestamp="yesterday")
    recording, report = read(tmp_path, frame, options=Options(hz=4))
    assert recording.columns["t_us"][1] == 250_000
    assert told(report, "time column 'timestamp' left aside, as --hz is given")


def test_a_time_of_unknown_unit_is_offered_with_its_rate(tmp_path):
    frame = table().rename(columns={"t_s": "time"})
    with pytest.raises(BadRecording, match=r"give --time-unit s \(100 Hz\)"):
        read(tmp_path, frame)


def test_stamps_beyond_64_bits_are_refused_with_their_row(tmp_path):
    text = "t_us,gx_dps,gy_dps,gz_dps\n1,1,1,1\n18446744073709551615,1,1,1\n"
    with pytest.raises(BadRecording, match="row 2: the time stamp is .*name the unit"):
        read(tmp_path, text)


# Sensors at their own times


def test_temperature_once_a_second_is_interpolated_and_said(tmp_path):
    frame = table(2000, 200.0)
    exact = frame["temp_c"].copy()
    frame.loc[np.arange(2000) % 200 != 0, "temp_c"] = np.nan
    recording, report = read(tmp_path, frame)
    assert len(recording) == 2000
    assert recording.temp_degc()[:1800] == pytest.approx(exact[:1800], abs=0.006)
    assert told(report, "temperature interpolated between its readings, over at most 1 s")


def test_a_merged_time_line_keeps_every_rate(tmp_path):
    frame = table(2000, 200.0)
    rates = frame[["t_s", *(f"g{a}_dps" for a in "xyz")]]
    force = frame[["t_s", *(f"a{a}_g" for a in "xyz")]].assign(t_s=frame["t_s"] + 0.002)
    warm = frame.loc[::200, ["t_s", "temp_c"]].assign(t_s=frame["t_s"][::200] + 0.001)
    merged = pd.concat([rates, force, warm]).sort_values("t_s")
    recording, report = read(tmp_path, merged)
    assert len(recording) == 2000
    assert recording.scales.odr_hz == pytest.approx(200)
    assert recording.accel_g()[:, 2] == pytest.approx(1, abs=0.02)
    assert told(report, "acceleration interpolated between its readings, over at most 5 ms")


def test_acceleration_on_rows_of_its_own_chooses_its_range(tmp_path):
    frame = table()
    forces = [f"a{axis}_g" for axis in "xyz"]
    apart = frame[["t_s", *forces]].assign(az_g=5.0)
    apart["t_s"] += 0.003
    merged = pd.concat([frame.drop(columns=forces), apart]).sort_values("t_s")
    recording, report = read(tmp_path, merged)
    assert recording.accel_g()[:, 2] == pytest.approx(np.full(len(recording), 5.0), abs=0.001)
    assert told(report, "strongest acceleration: 5 g")


def test_a_column_can_be_left_out(tmp_path):
    frame = table().assign(temp_c="broken")
    recording, report = read(tmp_path, frame)
    assert not recording.has_temp
    assert told(report, "column 'temp_c' left out: no number is in it")
    recording, _ = read(tmp_path, table(), mapping="temp=none ax=none")
    assert not recording.has_temp and not recording.has_accel


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
    with pytest.raises(BadRecording, match="no column for gx, gy, gz; map it: --map gx=COLUMN:dps"):
        read(tmp_path, f"{rows}\n")


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
    assert re.search("noise of 2.9 dps is more .* did you mean dps[?] [(]--gyro-unit dps[)]", said)
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
