"""A recording comes back as it was written, in every format, whole or in batches."""

import json
import sys
from pathlib import Path

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


@pytest.mark.parametrize("file_name", FORMATS)
def test_every_small_number_of_an_extra_channel_is_a_number(tmp_path, file_name):
    values = np.arange(-1000, 1000)
    write_recording(a_recording(2000, load=values), tmp_path / file_name)
    np.testing.assert_array_equal(read_recording(tmp_path / file_name).columns["load"], values)


@settings(max_examples=20, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    st.lists(st.integers(-(2**62), 2**62), min_size=1, max_size=20, unique=True),
    st.sampled_from(FORMATS),
)
def test_any_time_of_62_bits_survives(tmp_path, times, file_name):
    columns = {name: np.arange(len(times)) for name in ("gx", "gy", "gz", "temp", "zz")}
    recording = recording_from_columns({"t_us": np.array(sorted(times)), **columns}, SCALES)
    write_recording(recording, tmp_path / file_name)
    assert read_recording(tmp_path / file_name).columns["t_us"].tolist() == sorted(times)


DTYPES = [f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)]


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.data(), st.sampled_from(DTYPES))
def test_a_channel_is_taken_where_it_fits_32_bits_whatever_its_type(tmp_path, data, dtype):
    limits, path = np.iinfo(dtype), tmp_path / "run.parquet"
    near = [-(2**31) - 1, -(2**31), 2**31 - 1, 2**31, limits.min, limits.max, 0]
    value = data.draw(st.sampled_from([n for n in near if limits.min <= n <= limits.max]))
    held = np.array([0, value], dtype)
    write_recording(a_recording(2), path)
    pq.write_table(pq.read_table(path).append_column("load", pa.array(held)), path)
    if -(2**31) <= value < 2**31:
        assert read_recording(path).columns["load"].tolist() == [0, value]
        assert a_recording(2, load=held).columns["load"].tolist() == [0, value]
    else:
        with pytest.raises(BadRecording, match=f"row 2: load is {value}, more than 32 bits"):
            read_recording(path)
        with pytest.raises(BadRecording, match=f"row 2: load is {value}, which does not fit"):
            a_recording(2, load=held)


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
def test_a_failed_write_leaves_the_older_file_alone(tmp_path, file_name):
    write_recording(a_recording(), tmp_path / file_name)
    with (
        pytest.raises(KeyError),
        recording_writer(tmp_path / file_name, list(a_recording().columns), SCALES) as writer,
    ):
        writer.append({"t_us": np.arange(1)})
    assert len(read_recording(tmp_path / file_name)) == 10
    assert not list(tmp_path.glob(".*"))


def test_a_folder_that_is_not_there_is_named(tmp_path):
    with pytest.raises(BadRecording, match="no folder .*nowhere; make it first"):
        write_recording(a_recording(), tmp_path / "nowhere" / "run.parquet")


def test_a_name_without_a_format_is_refused(tmp_path):
    with pytest.raises(BadRecording, match="no format goes by this name; end the name in .parquet"):
        write_recording(a_recording(), tmp_path / "run.xlsx")


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
    taken = int(Path("/proc/self/statm").read_text().split()[5]) * resource.getpagesize()
    with at_most(100):
        bound, _ = resource.getrlimit(resource.RLIMIT_DATA)
    assert abs(bound - taken - (100 << 20)) < 8 << 20
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
