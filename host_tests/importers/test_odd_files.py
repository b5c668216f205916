"""Tables as people have them: each is read, or the error has the words that mend it."""

import re

import numpy as np
import pandas as pd
import pytest
from zerorate_bench.foreign_logs.binary import vectornav_line
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


def test_json_without_numbers_says_what_to_do(tmp_path):
    with pytest.raises(BadRecording, match="JSON, and no numbers in it; write an object for each"):
        read(tmp_path, '{"t": "now"}\n{"t": "then"}\n')


def test_a_line_that_is_no_json_is_counted(tmp_path):
    lines = table(50).to_json(orient="records", lines=True).splitlines()
    recording, report = read(tmp_path, "\n".join([*lines[:49], lines[49][:20]]), "in.jsonl")
    assert len(recording) == 49 and report.dropped["a line that is no JSON"] == 1


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


def test_lines_of_blanks_are_no_rows(tmp_path):
    text = table(50).to_csv(index=False).replace("\n", "\n  \n")
    recording, report = read(tmp_path, text)
    assert len(recording) == 50 and not report.dropped


def test_comments_between_rows_are_no_rows(tmp_path):
    lines = table(200).to_csv(index=False).splitlines()
    lines.insert(50, "# somebody knocked")
    recording, report = read(tmp_path, "\n".join(lines))
    assert len(recording) == 200 and not report.dropped


def test_a_header_in_a_comment_and_columns_by_number(tmp_path):
    rows = lines([i / 100, 0.8, 0.8, 0.9] for i in range(50))
    recording, _ = read(tmp_path, f"# {HEAD}\n{rows}\n")
    assert len(recording) == 50
    recording, _ = read(tmp_path, f"{rows}\n", mapping="t_us=1:s gx=2:dps gy=3:dps gz=4:dps")
    assert len(recording) == 50
    with pytest.raises(BadRecording, match="if these are rates: --map t_us=1:s --map gx=2:dps"):
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
    with pytest.raises(BadRecording, match="--map t_us=2:s --map gx=3:dps --map gy=4:dps"):
        read(tmp_path, f"{rows}\n")


def test_no_mapping_is_offered_where_nothing_tells_which_columns_are_rates(tmp_path):
    values = [0.01, 0.02, 0.01, 0.1, 0.1, 0.1] * np.random.default_rng(4).normal(size=(50, 6))
    with pytest.raises(BadRecording, match="map it: --map gx=COLUMN:dps, COLUMN one of 1, 2, 3"):
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


def test_settings_above_a_table_are_not_the_table(tmp_path):
    head = "sep=,\nFirmware,1.6\nacc_1G,2048\ngyro_scale,1\n" + "d_min,30\n" * 150
    recording, _ = read(tmp_path, head + table(200).to_csv(index=False))
    assert len(recording) == 200


def test_a_line_of_units_may_have_an_empty_cell_as_the_names_do(tmp_path):
    frame = table()[["t_s", *(f"g{a}_dps" for a in "xyz"), *(f"a{a}_g" for a in "xyz")]]
    names = [f"S_67_Gyro_{a}_CAL" for a in "XYZ"] + [f"S_67_Accel_LN_{a}_CAL" for a in "XYZ"]
    units = "ms\tdeg/s\tdeg/s\tdeg/s\tm/(s^2)\tm/(s^2)\tm/(s^2)\t"
    frame["t_s"] *= 1000
    frame.iloc[:, 4:] *= 9.80665
    rows = frame.assign(end="").to_csv(index=False, header=False, sep="\t")
    head = "\t".join(["S_67_Timestamp_Unix_CAL", *names]) + "\t\n" + units + "\n"
    recording, _ = read(tmp_path, '"sep=\t"\n' + head + rows)
    assert recording.scales.odr_hz == pytest.approx(100, rel=1e-4)
    assert recording.accel_g()[:, 2].mean() == pytest.approx(1.0, abs=0.01)


def test_columns_that_nothing_names_are_offered_by_what_they_hold(tmp_path):
    rows = [[i * 20, 0.1, 0.2, 9.79, 0.01, 0.02, -0.03, 21.5] for i in range(50)]
    ready = "t_us=1:ms ax=2:m/s2 ay=3:m/s2 az=4:m/s2 gx=5:rad/s gy=6:rad/s gz=7:rad/s"
    text = lines(rows)
    with pytest.raises(BadRecording, match=" ".join(f"--map {word}" for word in ready.split())):
        read(tmp_path, text)
    recording, _ = read(tmp_path, text, mapping=ready)
    assert recording.scales.odr_hz == pytest.approx(50)
    counts = [[100 + i % 3, -40 - i % 2, 7 + i % 5] for i in range(50)]
    with pytest.raises(BadRecording, match="--map gx=1:lsb --map gy=2:lsb --map gz=3:lsb"):
        read(tmp_path, lines(counts))


def test_numbers_of_a_kind_and_quaternions_are_offered_as_no_rates(tmp_path):
    rng = np.random.default_rng(6)
    wide = [
        [i / 50, 3, *rng.normal([0, 0, 9.8], 0.02), 4, *rng.normal(0, 0.1, 3)] for i in range(50)
    ]
    with pytest.raises(BadRecording, match="--map az=5:m/s2 --map gx=7:rad/s --map gy=8:rad/s"):
        read(tmp_path, lines(wide))
    angle = np.arange(50) / 9
    turned = np.column_stack([np.sin(angle), np.zeros((50, 2)), np.cos(angle)])
    wide = [[*q, *rng.normal([0, 0, 9.8], 0.02), *rng.normal(0, 0.1, 3)] for q in turned]
    with pytest.raises(BadRecording, match="--map az=7:m/s2 --map gx=8:rad/s --map gy=9:rad/s"):
        read(tmp_path, lines(wide))


@pytest.mark.parametrize(
    ("rest", "offered"),
    [
        # faster than any sensor
        ([0.0, 0.0, 9.8, 8e4, 6e4, -7e4], "map it: --map gx=COLUMN:dps"),
        # as long as gravity twice: 9.8 comes first
        ([0.6, 0, 0.8, 0, 0, 9.8, 0, 0, 0], "--map az=6:m/s2 --map gx=7:rad/s --map gy=8:rad/s"),
    ],
)
def test_a_rest_of_columns_without_names_is_told_by_how_large_they_are(tmp_path, rest, offered):
    noise = np.random.default_rng(8).normal(0, 0.01, (50, len(rest)))
    with pytest.raises(BadRecording, match=offered):
        read(tmp_path, lines(rest + noise))


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


def test_a_flight_is_no_steady_rate(tmp_path):
    frame = table()
    frame["gz_dps"] = 60 + 40 * np.sin(np.arange(len(frame)) / 500)
    assert not told(read(tmp_path, frame)[1], "a steady rate")
    frame["gz_dps"] = 60 + 0.05 * np.sin(np.arange(len(frame)))
    assert told(read(tmp_path, frame)[1], "a steady rate of 60 dps")


def test_a_pointer_of_git_lfs_is_told_from_a_table(tmp_path):
    with pytest.raises(BadRecording, match="a pointer of Git LFS, not the file; .*git lfs pull"):
        read(tmp_path, "version https://git-lfs.github.com/spec/v1\noid sha256:1bf6\nsize 41\n")


def test_lines_of_a_vectornav_need_but_their_rate(tmp_path):
    lines = "\n".join([vectornav_line((0.01, 0.02, 0.03))] * 50)
    recording, _ = read(tmp_path, lines, options=Options(hz=40))
    assert recording.gyro_dps()[0] == pytest.approx(np.degrees([0.01, 0.02, 0.03]), abs=0.005)
    assert recording.accel_g()[0, 2] == pytest.approx(-1.0, abs=0.01)
    assert recording.temp_degc()[0] == pytest.approx(26.8, abs=0.01)


def test_a_channel_that_would_lose_its_digits_is_offered_with_a_factor(tmp_path):
    frame = table().assign(quat_w=np.cos(np.linspace(0.0, 3.0, len(table()))))
    with pytest.raises(BadRecording, match="qw loses its digits.*--map qw=quat_w:x10000") as no:
        read(tmp_path, frame, mapping="qw=quat_w")
    words = str(no.value).rpartition("--map ")[2]
    recording, _ = read(tmp_path, frame, mapping=words)
    assert recording.columns["qw"] == pytest.approx(1e4 * frame["quat_w"], abs=0.51)
