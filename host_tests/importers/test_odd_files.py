"""Tables and times as people have them: each is read, or the error has the words that mend it."""

import re
import shlex

import numpy as np
import pandas as pd
import pytest
from zerorate_tools.errors import BadRecording
from zerorate_tools.importers import Options, parsed_mapping, read_foreign

HEAD = "t_s,gx_dps,gy_dps,gz_dps"


def table(n=2000, hz=100.0):
    """A rest with usual names and units in them."""
    rng = np.random.default_rng(3)
    columns = {"t_s": np.arange(n) / hz}
    columns |= {f"g{a}_dps": 0.8 + 0.05 * rng.standard_normal(n) for a in "xyz"}
    columns |= {f"a{a}_g": (a == "z") + 0.004 * rng.standard_normal(n) for a in "xyz"}
    return pd.DataFrame(columns | {"temp_c": 25 + 0.001 * np.arange(n)})


def rates(names, n=2000):
    """The time and the rates of that rest under these names; what is named beyond them is 1."""
    frame = table(n)[["t_s", *(f"g{a}_dps" for a in "xyz")]]
    return frame.set_axis(names[:4], axis=1).assign(**dict.fromkeys(names[4:], 1.0))


def read(tmp_path, frame, name="in.csv", mapping="", **options):
    """What an import makes of a frame, or of a text."""
    if isinstance(frame, pd.DataFrame):
        frame = frame.to_csv(index=False)
    content = frame if isinstance(frame, bytes) else f"{frame.rstrip()}\n".encode()
    (tmp_path / name).write_bytes(content)
    words = [parsed_mapping(word) for word in mapping.split()]
    return read_foreign(tmp_path / name, mapping=words, **options)


def lines(rows):
    """A text of numbers without a head."""
    return "\n".join(",".join(f"{v:.6g}" for v in row) for row in rows)


def told(report, words):
    return any(words in line for line in report.lines())


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "utf-16-le", "latin-1"])
def test_any_encoding_is_read(tmp_path, encoding):
    frame = table(200).rename(columns={"temp_c": "temp [°C]"})
    recording, _ = read(tmp_path, frame.to_csv(index=False).encode(encoding))
    assert len(recording) == 200
    assert recording.temp_degc()[0] == pytest.approx(25)


def test_json_without_numbers_says_what_to_do(tmp_path):
    with pytest.raises(BadRecording, match="JSON, and no numbers in it; write an object for each"):
        read(tmp_path, '{"t": "now"}\n{"t": "then"}\n')


def test_dicts_as_python_prints_them_are_read_one_a_line(tmp_path):
    printed = [str({"t": r.t_s, "gyro": {"x": r.gx_dps, "y": r.gy_dps, "z": r.gz_dps}})
               for r in table(50).itertuples()]  # fmt: skip
    text = "\n".join([*printed, printed[0][:30]])
    mapping = "t_us=t:s gx=gyro.x:dps gy=gyro.y:dps gz=gyro.z:dps"
    recording, report = read(tmp_path, text, mapping=mapping)
    assert len(recording) == 50 and report.dropped["a line that is no JSON"] == 1
    assert recording.gyro_dps() == pytest.approx(
        table(50)[["gx_dps", "gy_dps", "gz_dps"]], abs=0.01
    )


@pytest.mark.parametrize("kind", [list, tuple])
def test_numbers_as_python_prints_a_list_or_a_tuple_are_columns(tmp_path, kind):
    rows = table(50)[["gx_dps", "gy_dps", "gz_dps"]].to_numpy()
    text = "\n".join(str(kind(row.tolist())) for row in rows)
    mapping = "gx=[0]:dps gy=[1]:dps gz=[2]:dps"
    recording, _ = read(tmp_path, text, mapping=mapping, options=Options(hz=100.0))
    assert recording.gyro_dps() == pytest.approx(rows, abs=0.01)


@pytest.mark.parametrize("tag", ["[IMU DEBUG] ", "[12:00:01.250]"])
def test_a_tag_in_brackets_before_named_values_is_no_json(tmp_path, tag):
    rows = table(50)[["gx_dps", "gy_dps", "gz_dps"]]
    text = "\n".join(
        f"{tag}gx_dps={x:.4f} gy_dps={y:.4f} gz_dps={z:.4f}" for x, y, z in rows.to_numpy()
    )
    recording, _ = read(tmp_path, text, options=Options(hz=100.0))
    assert recording.gyro_dps() == pytest.approx(rows.to_numpy(), abs=0.01)


@pytest.mark.parametrize(
    "first, words",
    [
        (b"PK\x03\x04", "the zip is cut off or damaged; copy it again"),
        (b"SQLite format 3\x00", "a database, and no .db3 of ROS 2; write its table as CSV"),
    ],
)
def test_what_holds_tables_and_is_not_read_says_what_to_do_with_it(tmp_path, first, words):
    with pytest.raises(BadRecording, match=re.escape(words)):
        read(tmp_path, first + bytes(500))


def test_comments_and_blanks_between_rows_are_no_rows(tmp_path):
    lines = table(200).to_csv(index=False).splitlines()
    lines[50:50] = ["# somebody knocked", "  ", ""]
    recording, report = read(tmp_path, "\n".join(lines))
    assert len(recording) == 200 and not report.dropped


def test_a_header_in_a_comment_and_columns_by_number(tmp_path):
    rows = lines([i / 100, 0.8, 0.8, 0.9] for i in range(50))
    of_another_table = "# gx_dps,gy_dps,gz_dps,t_s"
    recording, _ = read(tmp_path, f"# {HEAD}\n{rows}\n{of_another_table}\n")
    assert len(recording) == 50
    recording, _ = read(tmp_path, f"{rows}\n", mapping="t_us=1:s gx=2:dps gy=3:dps gz=4:dps")
    assert len(recording) == 50
    with pytest.raises(
        BadRecording, match="rates: --map t_us=1:s --map gx=2 --map gy=3 --map gz=4,"
    ):
        read(tmp_path, f"{rows}\n")


def test_a_log_that_begins_in_the_middle_of_a_line_is_as_wide_as_most_lines(tmp_path):
    rows = "\n".join(f"{25 + i / 1000},{i / 100},0.8,0.8,0.9" for i in range(50))
    log = f"=~=~= PuTTY log 2026.05.08 =~=~=\n08,0.8,0.9\n{rows}\n"
    recording, report = read(
        tmp_path, log, mapping="temp=1:degc t_us=2:s gx=3:dps gy=4:dps gz=5:dps"
    )
    assert len(recording) == 50 and recording.temp_degc()[0] == pytest.approx(25, abs=0.01)
    assert report.dropped == {"not as many cells as the header": 1}


def test_a_time_of_day_among_columns_without_names_is_offered_as_time(tmp_path):
    rows = "\n".join(f"2026-05-01   10:00:{i // 5:02d} 0.8  0.8   0.9" for i in range(50))
    with pytest.raises(BadRecording, match="--map t_us=2:s --map gx=3 --map gy=4 "):
        read(tmp_path, f"{rows}\n")


def test_no_mapping_is_offered_where_nothing_tells_which_columns_are_rates(tmp_path):
    values = [0.01, 0.02, 0.01, 0.1, 0.1, 0.1] * np.random.default_rng(4).normal(size=(50, 6))
    with pytest.raises(BadRecording, match="map it: --map gx=COLUMN:UNIT.* COLUMN one of 1, 2, 3"):
        read(tmp_path, lines(values + [49.0, 0, 0, 0, 0, 0]))


def test_a_header_in_a_comment_is_one_where_a_column_has_words(tmp_path):
    rows = "\n".join(f"{i / 100},imu_link,0.8,0.8,0.9" for i in range(50))
    recording, _ = read(tmp_path, f"%t_s,frame_id,gx_dps,gy_dps,gz_dps\n{rows}\n")
    assert len(recording) == 50


def test_rows_with_a_word_and_no_header_have_columns_by_number(tmp_path):
    rows = "\n".join(f"GYRO;{i / 100};0.8;0.8;0.9" for i in range(50))
    mapping = "t_us=2:s gx=3:dps gy=4:dps gz=5:dps"
    recording, _ = read(tmp_path, rows + "\n", mapping=mapping)
    assert len(recording) == 50


def test_cells_may_stand_in_columns_of_blanks(tmp_path):
    rows = "".join(f"   {i / 100:.7e}   {0.8:.7e}  -8.0e-01\t 9.0e-01 \r\n" for i in range(50))
    words = "t_us=1:s gx=2:dps gy=3:dps gz=4:dps"
    recording, report = read(tmp_path, rows, "in.mat", words)
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


def test_a_pointer_of_git_lfs_is_told_from_a_table(tmp_path):
    with pytest.raises(BadRecording, match="a pointer of Git LFS, not the file; .*git lfs pull"):
        read(tmp_path, "version https://git-lfs.github.com/spec/v1\noid sha256:1bf6\nsize 41\n")


def test_a_channel_that_would_lose_its_digits_is_offered_with_a_factor(tmp_path):
    frame = table().assign(quat_w=np.cos(np.linspace(0.0, 3.0, len(table()))))
    with pytest.raises(BadRecording, match="qw loses its digits.*--map qw=quat_w:x10000") as no:
        read(tmp_path, frame, mapping="qw=quat_w")
    words = str(no.value).rpartition("--map ")[2]
    recording, _ = read(tmp_path, frame, mapping=words)
    assert recording.columns["qw"] == pytest.approx(1e4 * frame["quat_w"], abs=0.51)


def test_the_parts_of_a_quaternion_keep_their_digits(tmp_path):
    turn = np.linspace(0.0, 0.04, len(table()))
    frame = table().assign(qw=np.cos(turn), qx=np.sin(turn), qy=0.0, qz=0.0)
    recording, _ = read(tmp_path, frame, mapping="qw=qw qx=qx qy=qy qz=qz")
    assert recording.columns["qx"] == pytest.approx(1e6 * np.sin(turn), abs=0.51)


@pytest.mark.parametrize(
    "names",
    [
        ["Orientation W", "Orientation X", "Orientation Y", "Orientation Z"],
        ["imu.quat_x", "imu.quat_y", "imu.quat_z", "imu.quat_w"],
        ["QuatI", "QuatJ", "QuatK", "QuatReal"],
        ["qw", "qx", "qy", "qz"],
    ],
)
def test_an_attitude_is_offered_with_ready_words(tmp_path, names):
    turn = np.linspace(0.0, 0.04, len(table()))
    parts = {"w": np.cos(turn), "x": np.sin(turn), "y": 0.0 * turn, "z": 0.0 * turn}
    letters = {"l": "w", "i": "x", "j": "y", "k": "z"}
    of = {name: letters.get(name[-1].lower(), name[-1].lower()) for name in names}
    frame = table().assign(**{name: parts[letter] for name, letter in of.items()})
    _, report = read(tmp_path, frame)
    line = next(line for line in report.lines() if "an attitude" in line)
    words = [word for word in shlex.split(line.rpartition(": ")[2]) if word != "--map"]
    assert words == [
        f"q{letter}={name}" for letter in "wxyz" for name in names if of[name] == letter
    ]
    _, report = read(tmp_path, frame.assign(**{names[0]: 0.5}))
    assert not told(report, "an attitude")


def test_quick_motion_and_coarse_counts_lie_on_no_lines(tmp_path):
    at = np.arange(5000) / 1000
    for noise_lsb in (0, 1):
        frame = pd.DataFrame({"t_s": at})
        for axis, hz in zip("xyz", (1.0, 1.3, 1.7)):
            dps = 150 * np.sin(2 * np.pi * hz * at) + 100 * np.sin(4.4 * np.pi * hz * at)
            counts = 16.4 * dps + noise_lsb * RNG.standard_normal(len(at))
            frame[f"g{axis}_dps"] = np.rint(counts) / 16.4
        recording, report = read(tmp_path, frame)
        assert len(recording) == len(frame) and not report.dropped


RNG = np.random.default_rng(3)


def test_a_column_of_days_beside_one_of_times_is_no_time(tmp_path):
    frame = table(500).rename(columns={"t_s": "Time"})
    frame["Time"] = [f"12:00:{t:06.3f}" for t in frame["Time"]]
    for day in ("05/05/2021", "20210505"):
        recording, _ = read(tmp_path, frame.assign(Date=day)[["Date", *frame]])
        assert (np.diff(recording.columns["t_us"]) == 10_000).all()


@pytest.mark.parametrize("name, scale", [("Zeit (s)", 1), ("Temps (s)", 1), ("uptime_ms", 1000)])
def test_a_column_in_a_unit_of_time_that_only_grows_is_the_time(tmp_path, name, scale):
    frame = table(500).assign(t_s=lambda f: scale * f["t_s"]).rename(columns={"t_s": name})
    recording, _ = read(tmp_path, frame.assign(**{"delay (s)": 0.5})[["delay (s)", *frame]])
    assert (np.diff(recording.columns["t_us"]) == 10_000).all()


def test_a_column_of_dates_is_the_time_whatever_it_is_called(tmp_path):
    frame = table(500).rename(columns={"t_s": "hhmmss.ms"})
    frame["hhmmss.ms"] = [f"12:00:{t:06.3f}" for t in frame["hhmmss.ms"]]
    recording, _ = read(tmp_path, frame)
    assert (np.diff(recording.columns["t_us"]) == 10_000).all()


def test_midnight_falls_between_rows_that_are_rare(tmp_path):
    stamps = pd.Timestamp("2021-03-05T23:50") + pd.to_timedelta(np.arange(100) * 15, unit="s")
    frame = table(100).assign(t_s=stamps.strftime("%H:%M:%S")).rename(columns={"t_s": "time"})
    recording, _ = read(tmp_path, frame)
    assert (np.diff(recording.columns["t_us"]) == 15_000_000).all()


def test_a_time_that_cannot_be_read_says_how_to_write_it(tmp_path):
    frame = table(500).rename(columns={"t_s": "time"})
    frame["time"] = [f"May 1st, at noon and {t:06.3f}" for t in frame["time"]]
    with pytest.raises(BadRecording, match="no time can be read from column 'time'; .*--hz N"):
        read(tmp_path, frame)


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


def test_a_time_of_unknown_unit_is_taken_where_one_can_be_and_else_offered_with_its_rate(tmp_path):
    frame = table().rename(columns={"t_s": "time"})
    _, report = read(tmp_path, frame)
    assert told(report, "time taken in s: that is 100 Hz")
    with pytest.raises(BadRecording, match=r"give --time-unit s \(100 Hz\)"):
        read(tmp_path, frame.rename(columns={"time": "min.timestamp"}))
    with pytest.raises(BadRecording, match=r"give --time-unit s \(0.1 Hz\) or ms \(100 Hz\)"):
        read(tmp_path, frame.assign(time=frame["time"] * 1000))


def test_stamps_beyond_64_bits_are_refused_with_their_row(tmp_path):
    text = "t_us,gx_dps,gy_dps,gz_dps\n1,1,1,1\n18446744073709551615,1,1,1\n"
    with pytest.raises(BadRecording, match="row 2: the time stamp is .*name the unit"):
        read(tmp_path, text)


def test_lines_of_esp_idf_have_their_own_clock_and_colours(tmp_path):
    clock = [f"\x1b[0;32mI ({320 + 10 * n}) imu:" for n in range(300)]
    rates = np.random.default_rng(1).normal(0.5, 0.1, 300)
    rows = [f"{c} gx={x:.3f} gy=1 gz=2\x1b[0m" for c, x in zip(clock, rates)]
    text = "\n".join(["rst:0x1 (POWERON_RESET)", "I (28) boot: ESP-IDF v5.1", *rows])
    words = "gx=gx:dps gy=gy:dps gz=gz:dps"
    recording, report = read(tmp_path, text, name="in.log", mapping=words)
    assert len(recording) == 300 and recording.scales.odr_hz == pytest.approx(100)


def test_one_unit_is_offered_for_the_three_rates_if_one_of_them_is_fast(tmp_path):
    frame = table()[["gx_dps", "gy_dps", "gz_dps", "ax_g", "ay_g", "az_g"]]
    frame = frame.set_axis(["Gyro_X", "Gyro_Y", "Gyro_Z", "Accel_X", "Accel_Y", "Accel_Z"], axis=1)
    frame.iloc[:, 3:] *= 9.81
    frame["Gyro_Z"] *= 200.0
    with pytest.raises(BadRecording) as refused:
        read(tmp_path, frame, options=Options(hz=100.0))
    assert str(refused.value).count("--gyro-unit") == 1 and "--gyro-unit dps" in str(refused.value)


def test_p_q_r_are_offered_as_rates_even_as_long_as_gravity(tmp_path):
    frame = table()[["ax_g", "ay_g", "az_g", "gx_dps", "gy_dps", "gz_dps"]]
    frame = frame.set_axis(["Ax", "Ay", "Az", "p", "q", "r"], axis=1)
    frame[["p", "q", "r"]] = [0.6, 0.0, 0.8]
    with pytest.raises(BadRecording, match="if these are rates: --map gx=p"):
        read(tmp_path, frame)


def test_milliseconds_beside_a_second_are_the_time(tmp_path):
    at_ms = np.arange(2000) * 10 + np.random.default_rng(3).integers(0, 4, 2000)
    frame = rates(["Timestamp", "X", "Y", "Z"]).assign(Milliseconds=at_ms)
    frame["Timestamp"] = pd.Timestamp("2026-05-01") + pd.to_timedelta(frame["Timestamp"] // 1, "s")
    recording, _ = read(tmp_path, frame, "Gyroscope.csv", "gx=X:dps gy=Y:dps gz=Z:dps")
    assert (np.diff(recording.columns["t_us"]) == 1000 * np.diff(at_ms)).all()


def test_the_file_beside_is_that_of_the_same_recording(tmp_path):
    for name, force in (
        ("Accelerometer", 1),
        ("Accelerometer_2", 1),
        ("Accelerometer_2-linear", 0),
    ):
        (tmp_path / f"{name}.csv").write_text(f"t_s,x,y,z\n0,0,0,{force}\n1,0,0,{force}\n")
    _, report = read(
        tmp_path, rates(["t_s", "x", "y", "z"]), "Gyroscope_2.csv", "gx=x:dps gy=y:dps gz=z:dps"
    )
    assert any("Accelerometer_2.csv" in words for words in report.notes)


def test_lines_of_a_receiver_are_no_rates(tmp_path):
    lines = "$GPGGA,205250.75,5242.3734,N,0,,*0F\n$GNGSA,A,1,,*1D\n" * 20
    with pytest.raises(BadRecording, match="no column for gx"):
        read(tmp_path, lines)
