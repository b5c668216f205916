"""A recording comes back as it was written, in every format, up to the ends of every range."""

import json
from pathlib import Path
from threading import current_thread, main_thread

import numpy as np
import pyarrow as pa
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from zerorate_tools.errors import BadRecording
from zerorate_tools.recordings import (
    Scales,
    open_recording,
    read_recording,
    recording_from_columns,
    write_recording,
)
from zerorate_tools.recordings.checks import GAP, check_names
from zerorate_tools.recordings.csv_format import read_header
from zerorate_tools.recordings.scales import example_for, scales_from_text
from zerorate_tools.recordings.text import rows_of

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


@settings(max_examples=20, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    st.lists(st.tuples(st.integers(-(2**62), 2**62), st.integers(GAP + 1, 2**31 - 1)), min_size=1),
    st.sampled_from(FORMATS),
)
def test_any_time_of_62_bits_and_channel_of_32_survive(tmp_path, rows, file_name):
    times, load = np.array(sorted(rows), np.int64).T
    columns = {name: np.arange(len(rows)) for name in ("gx", "gy", "gz", "temp", "zz")}
    recording = recording_from_columns({"t_us": times, **columns, "load": load}, SCALES)
    write_recording(recording, tmp_path / file_name)
    read = read_recording(tmp_path / file_name).columns
    assert (read["t_us"] == times).all() and (read["load"] == load).all()


def test_a_number_that_does_not_fit_is_refused_where_a_recording_is_made():
    with pytest.raises(BadRecording, match="row 2: load is 2147483648, which does not fit"):
        a_recording(2, load=np.array([0, 2**31]))


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


def test_physical_units_follow_the_scales():
    columns = {"gx": [131, 0], "gy": [0, 0], "gz": [-262, 0], "ax": [0, 0], "ay": [0, 0]}
    columns |= {"t_us": [300_000, 800_000], "az": [16384, 0], "temp": [-680, 0]}
    recording = recording_from_columns(columns, SCALES)
    assert recording.gyro_dps()[0].tolist() == [1.0, 0.0, -2.0]
    assert recording.accel_g()[0].tolist() == [0.0, 0.0, 1.0]
    assert recording.temp_degc()[0] == 34.53
    assert recording.samples()[0].tolist() == [0, 0, 16384, -680, 131, 0, -262]
    frame = recording.to_frame()
    assert list(frame.columns) == ["t_us", "gx", "gy", "gz", "ax", "ay", "az", "temp"]
    assert frame.attrs["zerorate"]["gyro_lsb_per_dps"] == 131.0
    assert recording.to_frame(physical=True).index.tolist() == [0.0, recording.duration_s]


def test_no_other_thread_calls_python_while_a_text_is_read():
    threads = []

    def take(row):
        threads.append(current_thread())
        return "skip"

    assert rows_of(b"1,2\n3\n" * 100_000, ["a", "b"], pa.int64(), 0, take).num_rows == 100_000
    assert set(threads) == {main_thread()}


@pytest.mark.parametrize(("name", "said"), [
    ("run.xlsx", "no format goes by this name; end the name in .parquet"),
    ("none/run.csv", "there is no folder .*none; make it first"),
    ("folder.csv", "is a folder; name a file in it"),
])  # fmt: skip
def test_where_no_recording_can_be_written_is_said(tmp_path, name, said):
    (tmp_path / "folder.csv").mkdir()
    with pytest.raises(BadRecording, match=said):
        write_recording(a_recording(), tmp_path / name)


HEADER = "t_us,gx,gy,gz"


@pytest.mark.parametrize(("names", "complaint"), [
    (["t_us", "gx", "gy"], "column gz is missing; turn it into a recording: zerorate import"),
    (["gx", "gy", "gz"], "column t_us is missing; "),
    (["t_us", "gy", "b", "b"], "columns gx, gz are missing; "),
    (["t_us", "gx", "gy", "gz", "ax"], "of ax ay az only ax is there; give all three or none"),
    (["t_us", "gx", "gy", "gz", "ay", "az"], "of ax ay az only ay, az is there"),
    (["t_us", "gx", "gy", "gz", "b", "b"], "column b comes twice; rename or drop one"),
    (["t_us", "gx", "gy", "gz", "b\x07"], "column name 'b.x07' is not printable; rename it"),
    (["t_us", "gx", "gy", "gz"], None), (["az", "ay", "ax", "gz", "gy", "gx", "t_us"], None),
])  # fmt: skip
def test_names_of_columns_are_those_of_a_recording(names, complaint):
    for suffix in (".csv", ".csv.gz", ".parquet"):
        if complaint is None:
            check_names(names, Path("x" + suffix))
            continue
        with pytest.raises(BadRecording, match=complaint) as caught:
            check_names(names, Path("x" + suffix))
        imported = "imported.parquet" if suffix == ".parquet" else "imported.csv"
        assert str(caught.value).endswith(imported) is ("missing" in complaint)


@pytest.mark.parametrize("bad", [0, 99, 100, 249])
def test_the_row_is_counted_over_batches(tmp_path, parquet_of, bad):
    t_us = np.arange(250)
    gaps = pa.array([None if row == bad else 7 for row in t_us], pa.int64())
    path = parquet_of({**dict.fromkeys(("t_us", "gx", "gy", "gz"), t_us), "load": gaps})
    with pytest.raises(BadRecording, match=f"row {bad + 1}: load has no value; fill the gaps"):
        list(open_recording(path).batches(rows=100))
    if bad:
        t_us[bad] -= 2
        write_recording(
            recording_from_columns(dict.fromkeys(("t_us", "gx", "gy", "gz"), t_us), SCALES),
            tmp_path / "y.parquet",
        )
        said = f"row {bad + 1}: time goes backwards, from {bad - 1} to {bad - 2} us"
        with pytest.raises(BadRecording, match=said):
            list(open_recording(tmp_path / "y.parquet").batches(rows=100))


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig"])
def test_a_header_is_the_first_line_that_is_not_blank_up_to_64_kib(tmp_path, encoding):
    path = tmp_path / "x.csv"
    path.write_bytes('\n  \n t_us ,"g,x", gy\n1,2,3\n'.encode(encoding))
    header = read_header(path)
    assert (header.names, header.skip) == (["t_us", "g,x", "gy"], 3)
    path.write_bytes(b"a\n" + b"x" * 65533 + "µ\n".encode())  # cut in two by the end of these
    assert read_header(path).encoding == "utf-8"
    for length, ending in ((65535, ""), (65534, "\n1"), (65536, ""), (70000, "\n")):
        path.write_text("a" * length + ending)
        if length < 65536:
            assert read_header(path).names == ["a" * length]
        else:
            with pytest.raises(BadRecording, match="no line ends within the first 64 KiB"):
                read_header(path)


def test_scales_take_numbers_of_any_kind_and_keep_what_they_do_not_know():
    text = '{"sensor": "X", "odr_hz": 25, "gyro_lsb_per_dps": 1e7, "latitude_deg": 48.1, "m": [1]}'
    scales = scales_from_text(text, "x.json", ["t_us", "gx"])
    assert scales == Scales("X", 25.0, 1e7, more={"latitude_deg": 48.1, "m": [1]})
    assert scales.to_json() == json.loads(text)
    with pytest.raises(ValueError, match="no temperature"):
        scales.temp_degc(0)
    with pytest.raises(ValueError, match="no temperature"):
        Scales("X", 1.0, 1.0, temp_lsb_per_degc=340.0).temp_degc(0)
    assert Scales("X", 1.0, 1.0, None, 340.0, 36.53).temp_degc(680) == 38.53


@pytest.mark.parametrize(("columns", "needed"), [
    ((), 0), (("gx",), 0), (("ax",), 1), (("temp",), 2), (("ax", "temp"), 3),
])  # fmt: skip
def test_the_example_has_what_the_columns_need_and_no_more(columns, needed):
    keys = ["sensor", "odr_hz", "gyro_lsb_per_dps"]
    keys += {0: [], 1: ["accel_lsb_per_g"]}[needed & 1]
    keys += ["temp_lsb_per_degc", "temp_offset_degc"] if needed > 1 else []
    told = json.loads(example_for(columns))
    mpu6050 = {"sensor": "MPU-6050", "odr_hz": 100, "gyro_lsb_per_dps": 131}
    mpu6050 |= {"accel_lsb_per_g": 16384, "temp_lsb_per_degc": 340, "temp_offset_degc": 36.53}
    assert told == {key: mpu6050[key] for key in keys}
    assert scales_from_text(json.dumps(told), "x", columns).sensor == "MPU-6050"
    for key in keys:
        with pytest.raises(BadRecording, match=f"the scales lack {key}; add .{key}.: "):
            scales_from_text(json.dumps({k: told[k] for k in keys if k != key}), "x", columns)


@pytest.mark.parametrize("size", [(1 << 20) - 1, 1 << 20, (1 << 20) + 1])
def test_scales_are_of_a_megabyte_at_most(tmp_path, size):
    (tmp_path / "x.csv").write_text(f"{HEADER}\n0,1,2,3\n")
    text = '{"odr_hz": 1, "gyro_lsb_per_dps": 1, "sensor": ""}'
    (tmp_path / "x.json").write_text(text[:-2] + "X" * (size - len(text)) + text[-2:])
    if size <= 1 << 20:
        assert len(read_recording(tmp_path / "x.csv").scales.sensor) == size - len(text)
    else:
        with pytest.raises(BadRecording, match="x.json: more than 1 MiB; write there"):
            read_recording(tmp_path / "x.csv")
