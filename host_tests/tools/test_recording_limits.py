"""Columns, rows and scales up to every end of what they may be, and one beyond."""

import json
from pathlib import Path

import numpy as np
import pyarrow as pa
import pytest
from zerorate_tools.errors import BadRecording
from zerorate_tools.recordings import (
    Scales,
    open_recording,
    read_recording,
    recording_from_columns,
    write_recording,
)
from zerorate_tools.recordings.checks import check_names
from zerorate_tools.recordings.csv_format import read_header
from zerorate_tools.recordings.scales import example_for, scales_from_text

from .test_recordings import SCALES

HEADER = "t_us,gx,gy,gz"
_SCALES = '{"sensor": "X", "odr_hz": %s, "gyro_lsb_per_dps": 1}'


@pytest.mark.parametrize(("names", "complaint"), [
    (["t_us", "gx", "gy"], "column gz is missing; turn it into a recording: zerorate import"),
    (["gx", "gy", "gz"], "column t_us is missing; "),
    (["t_us", "gy"], "columns gx, gz are missing; "),
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


def test_rows_at_one_time_are_in_order(csv_of):
    path = csv_of(f"{HEADER}\n-5,1,2,3\n-5,1,2,3\n-5,1,2,3\n")
    assert read_recording(path).columns["t_us"].tolist() == [-5, -5, -5]


@pytest.mark.parametrize("bad", [0, 1, 99, 100, 199, 200, 249])
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
    for length, ending in ((65535, ""), (65534, "\n1"), (65536, ""), (70000, "\n")):
        path.write_text("a" * length + ending)
        if length < 65536:
            assert read_header(path).names == ["a" * length]
        else:
            with pytest.raises(BadRecording, match="no line ends within the first 64 KiB"):
                read_header(path)


@pytest.mark.parametrize("cell", ["1", "-1", "+1", " 7 ", "\t7", "9" * 18, "-" + "9" * 18, ""])
def test_a_cell_that_is_an_integer_is_not_named(csv_of, cell):
    path = csv_of(f"{HEADER}\n0,1,2,3\n1,{cell},2,x\n")
    with pytest.raises(BadRecording, match="row 2: gz is 'x', no integer"):
        read_recording(path)


@pytest.mark.parametrize("cell", ["1.0", "1e3", "--1", "0x10", "9" * 19, "one", "1 2", "+", "-"])
def test_a_cell_that_is_none_is_named_before_a_later_one(csv_of, cell):
    path = csv_of(f"{HEADER}\n0,1,2,3\n1,2,{cell},3\n2,x,2,3\n")
    with pytest.raises(BadRecording) as caught:
        read_recording(path)
    assert f"row 2: gy is {cell!r}, no integer; give raw LSB" in str(caught.value)


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


def test_a_long_value_of_the_scales_is_shown_by_its_beginning(csv_of):
    for letters, shown in ((38, "a" * 38 + "'"), (39, "a" * 39 + "...")):
        path = csv_of(f"{HEADER}\n0,1,2,3\n", _SCALES % f'"{"a" * letters}"')
        with pytest.raises(BadRecording, match=f"odr_hz is '{shown}, no number; write a number"):
            read_recording(path)
