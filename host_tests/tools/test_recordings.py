"""A recording comes back as it was written, in every format, whole or in batches."""

import gzip
import json
import sys

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from zerorate_tools.errors import BadRecording, InFile
from zerorate_tools.recordings import (
    Scales,
    open_recording,
    read_recording,
    recording_from_columns,
    recording_writer,
    write_recording,
)
from zerorate_tools.recordings.atomic import written_beside
from zerorate_tools.recordings.bounded import at_most, each_at_most
from zerorate_tools.recordings.checks import GAP

if sys.platform == "linux":
    import resource

SCALES = Scales("MPU-6050", 25.0, 131.0, 16384.0, 340.0, 36.53, {"latitude_deg": 48.1})
_SCALES = '{"sensor": "X", "odr_hz": %s, "gyro_lsb_per_dps": 1}'
FORMATS = ["run.parquet", "run.csv", "run.csv.gz"]


def a_recording(n=10, **extra):
    rng = np.random.default_rng(1)
    names = ("gx", "gy", "gz", "ax", "ay", "az", "temp")
    readings = {name: rng.integers(-32768, 32768, n) for name in names}
    return recording_from_columns({"t_us": np.arange(n) * 40_000, **readings, **extra}, SCALES)


@pytest.mark.parametrize("file_name", FORMATS)
def test_a_recording_comes_back_as_it_was_written(tmp_path, file_name):
    written = a_recording(vdd_mv=np.arange(10) + 3300)
    write_recording(written, tmp_path / file_name)
    read = read_recording(tmp_path / file_name)
    assert read.scales == SCALES
    assert read.name == "run"
    assert read.column_names == written.column_names
    for name in written.columns:
        np.testing.assert_array_equal(read.columns[name], written.columns[name])


@pytest.mark.parametrize("file_name", FORMATS)
def test_batches_join_to_the_whole(tmp_path, file_name):
    write_recording(a_recording(1000), tmp_path / file_name)
    parts = list(open_recording(tmp_path / file_name).batches(rows=300))
    assert max(len(part["t_us"]) for part in parts) <= 300
    joined = np.concatenate([part["gx"] for part in parts])
    np.testing.assert_array_equal(joined, read_recording(tmp_path / file_name).columns["gx"])


def test_parquet_row_groups_are_read_only_as_they_are_needed(tmp_path):
    rows, groups = 100_000, 24
    with recording_writer(tmp_path / "run.parquet", ["t_us", "gx", "gy", "gz"], SCALES) as writer:
        for group in range(groups):
            t_us = np.arange(rows) + group * rows
            writer.append(dict.fromkeys(("t_us", "gx", "gy", "gz"), t_us))
    opened = open_recording(tmp_path / "run.parquet")
    assert opened.n_samples == rows * groups
    assert pq.ParquetFile(tmp_path / "run.parquet").num_row_groups == groups
    before, most = pa.total_allocated_bytes(), 0
    for _ in opened.batches(rows=10_000):
        most = max(most, pa.total_allocated_bytes() - before)
    whole = rows * groups * (8 + 3 * 4)
    assert 0 < most < whole / 4


@settings(max_examples=20, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(st.integers(GAP + 1, 2**31 - 1), min_size=1, max_size=50), st.sampled_from(FORMATS))
def test_any_32_bit_extra_channel_survives(tmp_path, values, file_name):
    recording = a_recording(len(values), load=np.array(values, np.int64))
    write_recording(recording, tmp_path / file_name)
    assert read_recording(tmp_path / file_name).columns["load"].tolist() == values


def test_without_acceleration_and_temperature_no_such_scales_are_needed(tmp_path):
    columns = {name: np.arange(3) for name in ("t_us", "gx", "gy", "gz")}
    recording = recording_from_columns(columns, Scales("X", 1.0, 100.0))
    write_recording(recording, tmp_path / "run.csv")
    read = read_recording(tmp_path / "run.csv")
    assert not read.has_accel and not read.has_temp
    assert "accel_lsb_per_g" not in json.loads((tmp_path / "run.json").read_text())


@pytest.mark.parametrize("file_name", FORMATS)
@pytest.mark.parametrize("name", ['<script>alert("x")</script>', "a,b", "Spannung µV", ""])
def test_strangers_channel_names_survive(tmp_path, name, file_name):
    write_recording(a_recording(3, **{name: np.arange(3)}), tmp_path / file_name)
    assert read_recording(tmp_path / file_name).columns[name].tolist() == [0, 1, 2]


@pytest.mark.parametrize("file_name", FORMATS)
def test_a_channel_name_of_two_lines_is_refused(tmp_path, file_name):
    with pytest.raises(BadRecording, match=r"column name 'new\\nline' is not printable"):
        write_recording(a_recording(3, **{"new\nline": np.arange(3)}), tmp_path / file_name)
    assert list(tmp_path.iterdir()) == []


def test_a_frame_holds_raw_integers_and_the_scales():
    frame = a_recording().to_frame()
    assert list(frame.columns) == ["t_us", "gx", "gy", "gz", "ax", "ay", "az", "temp"]
    assert frame.attrs["zerorate"]["gyro_lsb_per_dps"] == 131.0


def test_physical_units_follow_the_scales():
    columns = {"gx": [131], "gy": [0], "gz": [-262], "ax": [0], "ay": [0], "az": [16384]}
    recording = recording_from_columns({"t_us": [0], **columns, "temp": [-680]}, SCALES)
    assert recording.gyro_dps().tolist() == [[1.0, 0.0, -2.0]]
    assert recording.accel_g().tolist() == [[0.0, 0.0, 1.0]]
    assert recording.temp_degc().tolist() == [34.53]
    assert recording.samples().tolist() == [[0, 0, 16384, -680, 131, 0, -262]]


@pytest.mark.parametrize("file_name", FORMATS)
def test_nothing_half_written_stays_when_writing_fails(tmp_path, file_name):
    with (
        pytest.raises(RuntimeError),
        recording_writer(tmp_path / file_name, list(a_recording().columns), SCALES) as writer,
    ):
        writer.append(a_recording().columns)
        raise RuntimeError("power cut")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("file_name", FORMATS)
def test_a_failed_write_leaves_the_older_file_alone(tmp_path, file_name):
    write_recording(a_recording(), tmp_path / file_name)
    with (
        pytest.raises(KeyError),
        recording_writer(tmp_path / file_name, list(a_recording().columns), SCALES) as writer,
    ):
        writer.append({"t_us": np.arange(1)})
    assert len(read_recording(tmp_path / file_name)) == 10


def test_a_folder_that_is_not_there_is_named(tmp_path):
    with pytest.raises(BadRecording, match="no folder .*nowhere; make it first"):
        write_recording(a_recording(), tmp_path / "nowhere" / "run.parquet")


def test_a_name_without_a_format_is_refused(tmp_path):
    with pytest.raises(BadRecording, match="no format goes by this name; end the name in .parquet"):
        write_recording(a_recording(), tmp_path / "run.xlsx")


# Bad input: each ends in one line that names the file, the row where there is one, and what to do.

HEADER = "t_us,gx,gy,gz"


@pytest.fixture
def csv_of(tmp_path):
    def write(text, scales=None):
        (tmp_path / "bad.csv").write_text(text)
        scales = {"sensor": "X", "odr_hz": 1, "gyro_lsb_per_dps": 1} if scales is None else scales
        (tmp_path / "bad.json").write_text(
            scales if isinstance(scales, str) else json.dumps(scales)
        )
        return tmp_path / "bad.csv"

    return write


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("", "empty file"),
        (f"{HEADER}\n", "no data row"),
        ("t_us,gx,gy\n0,1,2\n", "column gz is missing.*zerorate import"),
        (f"{HEADER},gx\n0,1,2,3,4\n", "column gx comes twice"),
        (f"{HEADER},ax\n0,1,2,3,4\n", "only ax is there"),
        (f"{HEADER}\n0,1,2,3\n1,1.5,2,3\n", "row 2: gx is '1.5', no integer"),
        (f"{HEADER}\n0,1,2,3\n1,one,2,3\n", "row 2: gx is 'one', no integer"),
        (f"{HEADER}\n0,1,2,3\n1,nan,2,3\n", "row 2: gx has no value; drop the row"),
        (f"{HEADER}\n0,1,2,3\n1,,2,3\n", "row 2: gx has no value"),
        (f"{HEADER},vdd_mv\n0,1,2,3,4\n1,1,2,3,\n", "row 2: vdd_mv has no value; fill the gaps"),
        (f"{HEADER}\n0,1,2,3\n1,1,2\n", "row 2: 3 cells where the header names 4"),
        (f"{HEADER}\n0,1,2,3\n1,1,x,3\n2,1,2\n", "row 2: gy is 'x', no integer"),
        (f"\n\n{HEADER}\n0,1,2,3\n1,1,2\n2,1,x,3\n", "row 2: 3 cells where the header names 4"),
        (f"{HEADER}\n0,1,2,3\n1,1,x,y\n", "row 2: gy is 'x', no integer"),
        (f"{HEADER}\n5,1,2,3\n9,1,2,3\n7,1,2,3\n", "row 3: time goes .* from 9 to 7 us; sort or"),
        (f"{HEADER}\n0,1,2,3\n1,99999999999,2,3\n", "row 2: gx is 99999999999, more than 32 bits"),
        (f"{HEADER}\n0,1,2,3\n1,99999999999999999999,2,3\n", "bad.csv"),
        (f"{HEADER},temp\n0,1,2,3,4\n", "lack temp_lsb_per_degc, temp_offset_degc; add"),
        (f"{HEADER},ax,ay,az\n0,1,2,3,4,5,6\n", "lack accel_lsb_per_g"),
    ],
)
def test_a_bad_csv_is_refused_in_one_line(csv_of, text, complaint):
    path = csv_of(text)
    with pytest.raises(BadRecording, match=complaint) as raised:
        read_recording(path)
    assert "\n" not in str(raised.value) and "bad." in str(raised.value)


@pytest.mark.parametrize(("last", "complaint"), [
    ("2,1,x,3", "row 200001: gy is 'x', no integer"), ("2,1,2", "row 200001: 3 cells where")
])  # fmt: skip
def test_a_row_far_behind_the_first_megabyte_is_named(csv_of, last, complaint):
    with pytest.raises(BadRecording, match=complaint):
        read_recording(csv_of(f"{HEADER}\n" + "1,1,2,3\n" * 200_000 + f"{last}\n"))


@pytest.mark.parametrize("bits", [30, 31, 32])
def test_a_clock_that_ran_over_is_told_from_time_that_goes_backwards(csv_of, bits):
    last = (1 << bits) - 4_000_000
    for later, do in ((5_999_999, f"clock of {bits} bits ran over: add {1 << bits} to it"),
                      (6_000_000, "sort or cut the recording there")):  # fmt: skip
        with pytest.raises(BadRecording, match=f"row 2: time goes backwards.*{do}"):
            read_recording(csv_of(f"{HEADER}\n{last},1,2,3\n{later},1,2,3\n"))


@pytest.mark.parametrize(
    ("scales", "complaint"),
    [
        ("{", "bad.json: the scales are not JSON .line 1"),
        ("[]", "no JSON object"),
        ({"odr_hz": 1, "gyro_lsb_per_dps": 1}, "lack sensor; add .sensor.: .MPU-6050. "),
        ({"sensor": "X", "gyro_lsb_per_dps": 1}, "lack odr_hz"),
        ({}, "lack sensor, odr_hz, gyro_lsb_per_dps; add"),
        ({"sensor": "X", "odr_hz": 0, "gyro_lsb_per_dps": 1}, "odr_hz is 0"),
        ({"sensor": "X", "odr_hz": "fast", "gyro_lsb_per_dps": 1}, "odr_hz is 'fast', no number"),
        ('{"sensor": "X", "odr_hz": NaN, "gyro_lsb_per_dps": 1}', "odr_hz is nan"),
    ],
)
def test_bad_scales_are_refused_in_one_line(csv_of, scales, complaint):
    path = csv_of(f"{HEADER}\n0,1,2,3\n", scales)
    with pytest.raises(BadRecording, match=complaint):
        read_recording(path)


def test_a_csv_without_scales_says_what_to_write(csv_of):
    path = csv_of("t_us,gx,gy,gz,ax,ay,az,temp\n0,1,2,3,4,5,6,7\n")
    path.with_name("bad.json").unlink()
    with pytest.raises(BadRecording, match="there is no bad.json beside it; write there") as raised:
        read_recording(path)
    path.with_name("bad.json").write_text("{" + str(raised.value).partition("{")[2])
    assert read_recording(path).scales.temp_offset_degc == 36.53


def test_a_foreign_csv_is_answered_with_the_command_that_imports_it(csv_of):
    with pytest.raises(BadRecording, match="t_us, gx, gy, gz are.*zerorate import .*bad.csv --out"):
        read_recording(csv_of("time,x,y,z\n0,1,2,3\n"))


def test_time_going_backwards_between_batches_is_seen(tmp_path):
    t_us = np.r_[np.arange(100), np.arange(50, 100)]
    columns = dict.fromkeys(("t_us", "gx", "gy", "gz"), t_us)
    write_recording(recording_from_columns(columns, Scales("X", 1, 1)), tmp_path / "bad.parquet")
    with pytest.raises(BadRecording, match="row 101: time goes backwards, from 99 to 50 us"):
        list(open_recording(tmp_path / "bad.parquet").batches(rows=100))


def test_a_truncated_gzip_is_refused(tmp_path):
    write_recording(a_recording(5000), tmp_path / "run.csv.gz")
    whole = (tmp_path / "run.csv.gz").read_bytes()
    for length in (5, len(whole) // 2, len(whole) - 4):
        (tmp_path / "run.csv.gz").write_bytes(whole[:length])
        with pytest.raises(BadRecording, match="cut off or damaged"):
            read_recording(tmp_path / "run.csv.gz")


def test_a_truncated_parquet_is_refused(tmp_path):
    write_recording(a_recording(5000), tmp_path / "run.parquet")
    whole = (tmp_path / "run.parquet").read_bytes()
    for length, complaint in ((0, "empty file"), (100, "cut off"), (len(whole) - 9, "cut off")):
        (tmp_path / "run.parquet").write_bytes(whole[:length])
        with pytest.raises(BadRecording, match=complaint):
            read_recording(tmp_path / "run.parquet")


def test_a_parquet_without_scales_is_refused(tmp_path):
    pq.write_table(pa.table({"t_us": [0], "gx": [1], "gy": [1], "gz": [1]}), tmp_path / "x.parquet")
    with pytest.raises(BadRecording, match="no scales .schema metadata"):
        read_recording(tmp_path / "x.parquet")


@pytest.mark.parametrize(
    ("values", "complaint"),
    [
        ([1.0, float("nan")], "row 2: gx is nan"),
        ([1.0, 2.5], "column gx holds double, not integers"),
        (["a", "b"], "column gx holds string, not integers"),
        ([1, None], "row 2: gx has no value"),
    ],
)
def test_wrong_types_in_a_parquet_are_refused(tmp_path, values, complaint):
    table = pa.table({"t_us": [0, 1], "gx": values, "gy": [1, 1], "gz": [1, 1]})
    scales = json.dumps({"sensor": "X", "odr_hz": 1, "gyro_lsb_per_dps": 1}).encode()
    pq.write_table(table.replace_schema_metadata({b"zerorate": scales}), tmp_path / "x.parquet")
    with pytest.raises(BadRecording, match=complaint):
        read_recording(tmp_path / "x.parquet")


def test_an_extra_channel_of_fractions_is_told_to_be_integers_gaps_or_not(tmp_path):
    columns = {"t_us": [0, 1], "gx": [1, 1], "gy": [1, 1], "gz": [1, 1]}
    table = pa.table({**columns, "vdd_mv": [4.5, float("nan")]})
    scales = json.dumps(SCALES.to_json()).encode()
    pq.write_table(table.replace_schema_metadata({b"zerorate": scales}), tmp_path / "x.parquet")
    with pytest.raises(BadRecording, match="column vdd_mv holds double, not integers"):
        read_recording(tmp_path / "x.parquet", keep_gaps=True)


def test_gaps_of_an_extra_channel_are_kept_when_asked(csv_of):
    path = csv_of(f"{HEADER},vdd_mv\n0,1,2,3,4\n1,1,2,3,\n")
    assert read_recording(path, keep_gaps=True).columns["vdd_mv"].tolist() == [4, GAP]


@pytest.mark.parametrize(
    ("name", "complaint"),
    [("none.csv", "no such file"), ("run.xlsx", "neither .csv"), (".", "is a folder")],
)
def test_what_is_no_recording_at_all_is_refused(tmp_path, name, complaint):
    (tmp_path / "run.xlsx").write_bytes(b"PK")
    with pytest.raises(BadRecording, match=complaint):
        open_recording(tmp_path / name)


def test_text_in_utf_16_is_read(tmp_path):
    (tmp_path / "x.csv").write_bytes("t_us,gx,gy,gz\n1,2,3,4\n".encode("utf-16"))
    (tmp_path / "x.json").write_text('{"sensor": "X", "odr_hz": 1, "gyro_lsb_per_dps": 1}')
    assert read_recording(tmp_path / "x.csv").columns["gz"].tolist() == [4]


@pytest.mark.parametrize(
    ("scales", "complaint"),
    [
        (_SCALES % ("9" * 400), r"odr_hz is 9+\.\.\.; write a number from"),
        (_SCALES % ("9" * 5000), "a number of thousands of digits"),
        ("[" * 100_000, "nested too deep"),
        (_SCALES % "1e-308", "odr_hz is 1e-308; write a number from"),
        ('{"sensor": "X", "odr_hz": 1, "gyro_lsb_per_dps": 1e300}', "gyro_lsb_per_dps is 1e"),
        ('{"sensor": "' + "X" * 2_000_000 + '"}', "scales of more than 1 MiB"),
    ],
)
def test_scales_that_no_sensor_has_are_refused_in_one_line(tmp_path, scales, complaint):
    (tmp_path / "x.csv").write_text("t_us,gx,gy,gz\n1,2,3,4\n")
    (tmp_path / "x.json").write_text(scales)
    with pytest.raises(BadRecording, match=complaint) as error:
        read_recording(tmp_path / "x.csv")
    assert len(str(error.value)) < 400


SCALES_OF_ALL = {"odr_hz": 1, "gyro_lsb_per_dps": 1, "accel_lsb_per_g": 1}
SCALES_OF_ALL |= {"sensor": "X", "temp_lsb_per_degc": 1, "temp_offset_degc": 1}


@pytest.mark.parametrize(("key", "least", "most"), [
    ("odr_hz", 1e-5, 1e6), ("gyro_lsb_per_dps", 1e-3, 1e7), ("accel_lsb_per_g", 1e-3, 1e8),
    ("temp_lsb_per_degc", 1e-3, 1e7), ("temp_offset_degc", -1e6, 1e6),
])  # fmt: skip
def test_every_scale_has_ends(csv_of, key, least, most):
    text = f"{HEADER}\n0,1,2,3\n"
    for end in (least, most):
        read = read_recording(csv_of(text, {**SCALES_OF_ALL, key: end}))
        assert getattr(read.scales, key) == end
    for beyond in (least - abs(least) / 100, most * 1.01, True):
        with pytest.raises(BadRecording, match=f"{key} is"):
            read_recording(csv_of(text, {**SCALES_OF_ALL, key: beyond}))


def test_a_cell_of_a_quarter_million_letters_is_named_by_its_row(tmp_path):
    (tmp_path / "x.csv").write_text("t_us,gx,gy,gz\n1,2,3,4\n2," + "a" * 250_000 + ",3,4\n")
    (tmp_path / "x.json").write_text('{"sensor": "X", "odr_hz": 1, "gyro_lsb_per_dps": 1}')
    with pytest.raises(BadRecording, match="row 2: gx is 'a{40}', no integer"):
        read_recording(tmp_path / "x.csv")


@pytest.mark.parametrize(("kind", "name", "value"), [
    ("uint64", "t_us", 2**63 - 1), ("int64", "t_us", 1), ("uint32", "gx", 2**31 - 1),
    ("int64", "load", -(2**31)), ("int64", "load", 2**31 - 1), ("int16", "gx", -(2**15)),
])  # fmt: skip
def test_numbers_that_just_fit_are_read(tmp_path, kind, name, value):
    columns = {n: pa.array([1, 2], pa.int64()) for n in ("t_us", "gx", "gy", "gz", "load")}
    columns[name] = pa.array([1, value], getattr(pa, kind)())
    scales = b'{"sensor": "X", "odr_hz": 1, "gyro_lsb_per_dps": 1}'
    pq.write_table(
        pa.table(columns).replace_schema_metadata({b"zerorate": scales}), tmp_path / "x.parquet"
    )
    assert read_recording(tmp_path / "x.parquet").columns[name].tolist() == [1, value]


@pytest.mark.parametrize(
    ("kind", "name", "value", "complaint"),
    [
        ("uint64", "t_us", 2**63, "row 2: t_us is 9223372036854775808, more than 64 bits"),
        ("uint32", "gx", 2**31, "row 2: gx is 2147483648, more than 32 bits"),
        ("uint32", "load", 2**32 - 1, "row 2: load is 4294967295, more than 32 bits"),
        ("int64", "load", -(2**31) - 1, "row 2: load is -2147483649, more than 32 bits"),
    ],
)
def test_numbers_that_do_not_fit_are_refused_instead_of_wrapped(
    tmp_path, kind, name, value, complaint
):
    columns = {n: pa.array([1, 2], pa.int64()) for n in ("t_us", "gx", "gy", "gz", "load")}
    columns[name] = pa.array([1, value], getattr(pa, kind)())
    scales = b'{"sensor": "X", "odr_hz": 1, "gyro_lsb_per_dps": 1}'
    table = pa.table(columns).replace_schema_metadata({b"zerorate": scales})
    pq.write_table(table, tmp_path / "x.parquet")
    with pytest.raises(BadRecording, match=complaint):
        read_recording(tmp_path / "x.parquet")


def test_a_gzip_that_is_none_is_refused(tmp_path):
    (tmp_path / "x.csv.gz").write_bytes(b"\x1f\x8b" + HEADER.encode())
    with pytest.raises(BadRecording, match="cut off or damaged"):
        open_recording(tmp_path / "x.csv.gz")
    with gzip.open(tmp_path / "x.csv.gz", "wb"):
        pass
    with pytest.raises(BadRecording, match="empty file"):
        open_recording(tmp_path / "x.csv.gz")


@pytest.mark.skipif(sys.platform != "linux", reason="no other system has such a limit")
def test_memory_within_a_bound_is_given_and_beyond_it_refused():
    before = resource.getrlimit(resource.RLIMIT_DATA)
    with at_most(80), at_most(40):
        bytearray(20 << 20)
        with pytest.raises(MemoryError):  # far beyond: tests before leave memory to be used again
            bytearray(600 << 20)
        with at_most(2000), pytest.raises(MemoryError):
            bytearray(1000 << 20)
    assert resource.getrlimit(resource.RLIMIT_DATA) == before
    sizes = each_at_most(iter(map(bytearray, (20 << 20, 600 << 20))), 40)
    assert len(next(sizes)) == 20 << 20
    bytearray(600 << 20)  # what takes the item is not bound
    with pytest.raises(MemoryError):
        next(sizes)


def test_a_file_written_beside_replaces_the_older_one_only_when_all_went_well(tmp_path):
    (tmp_path / "report.html").write_text("old")
    with pytest.raises(ValueError), written_beside(tmp_path / "report.html") as temporary:
        temporary.write_text("half")
        raise ValueError
    assert (tmp_path / "report.html").read_text() == "old"
    with written_beside(tmp_path / "report.html") as temporary:
        temporary.write_text("new")
    assert [p.name for p in tmp_path.iterdir()] == ["report.html"]
    assert (tmp_path / "report.html").read_text() == "new"
    with pytest.raises(InFile, match="cannot be written.*name a folder that exists"):
        with written_beside(tmp_path / "nowhere" / "x"):
            pass
