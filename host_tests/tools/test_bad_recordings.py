"""A bad recording is refused in one line that names the file, the row, and what to do."""

import math
import re
from types import SimpleNamespace

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from zerorate_tools.errors import BadRecording
from zerorate_tools.recordings import open_recording, read_recording, write_recording
from zerorate_tools.recordings.checks import GAP
from zerorate_tools.recordings.parquet_format import batches, open_file
from zerorate_tools.recordings.reading import whole

from .test_recordings import a_recording

HEADER = "t_us,gx,gy,gz"
_SCALES = '{"sensor": "X", "odr_hz": %s, "gyro_lsb_per_dps": 1}'


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("", "empty file"),
        (f"{HEADER}\n", "no data row"),
        ("time,x,y,z\n0,1,2,3\n", "t_us, gx, gy, gz are.*zerorate import .*bad.csv --out"),
        (f"{HEADER}\n0,1,2,3\n1,nan,2,3\n", "row 2: gx has no value; drop the row"),
        (f"{HEADER}\n0,1,2,3\n1,,2,3\n", "row 2: gx has no value"),
        (f"{HEADER},vdd_mv\n0,1,2,3,4\n1,1,2,3,\n", "row 2: vdd_mv has no value; fill the gaps"),
        (f"{HEADER}\n0,1,2,3\n1,1,2\n", "row 2: 3 cells where the header names 4"),
        (f"{HEADER}\n0,1,2,3\n1,1,x,3\n2,1,2\n", "row 2: gy is 'x', no integer"),
        *(
            (f"{HEADER}\n0,1,2,3\n1,2,{cell},3\n2,x,2,3\n", f"row 2: gy is '{re.escape(cell)}', no")
            for cell in ("1.0", "1e3", "0x10", "9" * 19, "1 2", "-")
        ),
        *(
            (f"{HEADER}\n0,1,2,3\n0,{cell},2,x\n", "row 2: gz is 'x', no integer")
            for cell in ("-1", "+1", " 7 ", "\t7", "-" + "9" * 18, "")
        ),
        (f"{HEADER}\n0,1,2,3\n1,x,y,3\n2,1,z,3\n", "row 2: gx is 'x', no integer"),
        (f"\n\n{HEADER}\n0,1,2,3\n1,1,2\n2,1,x,3\n", "row 2: 3 cells where the header names 4"),
        (
            f"{HEADER}\n0,1,2,3\n1,1,2\n2,1,2,3\n3,1,x,3\n",
            "row 2: 3 cells where the header names 4",
        ),
        (f"{HEADER}\n0,1,2,3\n1,1\n2,1,2\n", "row 2: 2 cells where the header names 4"),
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


@pytest.mark.parametrize(
    ("earlier", "later", "do"),
    [
        *(((1 << bits) - 4_000_000, 5_999_999, f"clock of {bits} bits ran over: add {1 << bits} to")
          for bits in (30, 31, 32)),
        *((first, last, "sort or cut the recording there") for first, last in (
            ((1 << 30) - 4_000_000, 6_000_000), (100, -(1 << 33)), (1 << 33, 5), (5000, 4000))),
    ],
)  # fmt: skip
def test_a_clock_that_ran_over_is_told_from_time_that_goes_backwards(csv_of, earlier, later, do):
    with pytest.raises(BadRecording, match=f"row 2: time goes backwards.*{do}"):
        read_recording(csv_of(f"{HEADER}\n{earlier},1,2,3\n{later},1,2,3\n"))


@pytest.mark.parametrize(
    ("rates", "complaint"),
    [
        ([1.0, None, math.nan], "row 2: gx is None"),
        ([1.0, math.inf, 2.0], "row 2: gx is inf"),
        ([1.0, math.nan, 2.0], "row 2: gx is nan"),
        ([1.5, 2.0, 3.0], "column gx holds double, not integers"),
    ],
)
def test_rates_that_are_floats_are_refused_by_the_first_that_is_no_number(
    tmp_path, rates, complaint
):
    columns = {"t_us": [1, 2, 3], "gx": pa.array(rates, pa.float64()), "gy": [1] * 3, "gz": [1] * 3}
    table = pa.table(columns).replace_schema_metadata({"zerorate": _SCALES % "100"})
    pq.write_table(table, tmp_path / "run.parquet")
    with pytest.raises(BadRecording, match=complaint):
        read_recording(tmp_path / "run.parquet")


@pytest.mark.parametrize(
    ("scales", "complaint"),
    [
        ("{", "bad.json: the scales are not JSON .line 1"),
        ("[]", "no JSON object"),
        ({}, "lack sensor, odr_hz, gyro_lsb_per_dps; add"),
        ({"sensor": "X", "odr_hz": 0, "gyro_lsb_per_dps": 1}, "odr_hz is 0"),
        ({"sensor": "X", "odr_hz": "fast", "gyro_lsb_per_dps": 1}, "odr_hz is 'fast', no number"),
        (_SCALES % "NaN", "odr_hz is nan"),
        (_SCALES % ("9" * 400), r"odr_hz is 9{40}\.\.\.; write a number from"),
        (_SCALES % ("9" * 5000), "a number of thousands of digits"),
        ("[" * 100_000, "nested too deep"),
        (_SCALES.replace("X", "\\ud800") % 1, "the scales are not text"),
        ({"sensor": 3, "odr_hz": 1, "gyro_lsb_per_dps": 1}, "the scales lack sensor"),
    ],
)
def test_bad_scales_are_refused_in_one_line(csv_of, scales, complaint):
    path = csv_of(f"{HEADER}\n0,1,2,3\n", scales)
    with pytest.raises(BadRecording, match=complaint) as error:
        read_recording(path)
    assert len(str(error.value)) < 400


def test_a_csv_without_scales_says_what_to_write(csv_of):
    path = csv_of("t_us,gx,gy,gz,ax,ay,az,temp\n0,1,2,3,4,5,6,7\n")
    path.with_name("bad.json").unlink()
    with pytest.raises(BadRecording, match="there is no bad.json beside it; write there") as raised:
        read_recording(path)
    path.with_name("bad.json").write_text("{" + str(raised.value).partition("{")[2])
    assert read_recording(path).scales.temp_offset_degc == 36.53


@pytest.mark.parametrize(
    ("name", "said"),
    [("run.csv.gz", "the gzip data is cut off"), ("run.parquet", "no Parquet file, or cut off")],
)
def test_a_truncated_file_is_refused(tmp_path, name, said):
    write_recording(a_recording(5000), tmp_path / name)
    whole = (tmp_path / name).read_bytes()
    for length in (0, 100, len(whole) // 2, len(whole) - 9):
        (tmp_path / name).write_bytes(whole[:length])
        with pytest.raises(BadRecording, match=said if length else "empty file"):
            read_recording(tmp_path / name)


def test_damage_within_a_parquet_is_refused(tmp_path):
    write_recording(a_recording(5000), tmp_path / "run.parquet")
    whole = bytearray((tmp_path / "run.parquet").read_bytes())
    whole[len(whole) // 4] ^= 1  # one bit
    (tmp_path / "run.parquet").write_bytes(whole)
    file = open_file(tmp_path / "run.parquet")
    with pytest.raises(BadRecording, match="the Parquet data is damaged; copy"):
        list(batches(file, tmp_path / "run.parquet", 1000))


def test_pages_that_take_too_much_memory_are_refused(tmp_path, monkeypatch):
    def beyond(*_, **__):
        raise MemoryError

    (tmp_path / "x.parquet").write_bytes(b"PAR1")
    monkeypatch.setattr(pq, "ParquetFile", beyond)
    with pytest.raises(BadRecording, match="a page of it takes more than"):
        open_file(tmp_path / "x.parquet")
    file = SimpleNamespace(iter_batches=lambda **_: map(beyond, [1]))
    with pytest.raises(BadRecording, match="a page of it takes more than"):
        list(batches(file, tmp_path / "x.parquet", 1))


def test_a_recording_is_held_in_400_megabytes_at_most(tmp_path):
    parts = [{"gx": np.broadcast_to(np.int8(0), n)} for n in (399_999_999, 1, 1)]
    assert whole(parts[:2], [], tmp_path) == {}
    with pytest.raises(BadRecording, match="more than 400 MB; read it in batches"):
        whole(parts, [], tmp_path)


def test_a_parquet_without_scales_is_refused(tmp_path):
    pq.write_table(pa.table({"t_us": [0], "gx": [1], "gy": [1], "gz": [1]}), tmp_path / "x.parquet")
    with pytest.raises(BadRecording, match="no scales .schema metadata"):
        read_recording(tmp_path / "x.parquet")


def test_an_extra_channel_of_fractions_is_told_to_be_integers_gaps_or_not(parquet_of):
    columns = {"t_us": [0, 1], "gx": [1, 1], "gy": [1, 1], "gz": [1, 1]}
    path = parquet_of({**columns, "vdd_mv": [4.5, float("nan")]})
    with pytest.raises(BadRecording, match="column vdd_mv holds double, not integers"):
        read_recording(path, keep_gaps=True)


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


@pytest.mark.parametrize(
    "encoding", ["utf-8", "latin-1", "utf-16", "utf-16-le", "utf-16-be", "utf-32"]
)
def test_text_of_any_encoding_is_read_with_a_mark_and_without(tmp_path, encoding):
    (tmp_path / "x.csv").write_bytes("t_us,gx,gy,gz,µ\n1,2,3,4,5\n".encode(encoding))
    (tmp_path / "x.json").write_text('{"sensor": "X", "odr_hz": 1, "gyro_lsb_per_dps": 1}')
    assert read_recording(tmp_path / "x.csv").columns["µ"].tolist() == [5]


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


def test_a_row_is_of_one_mebibyte_at_most(csv_of):
    with pytest.raises(BadRecording, match="a row is longer than 1 MiB"):
        read_recording(csv_of(f"{HEADER}\n1,2,3,4\n2,{'7' * (1 << 21)},3,4\n"))
    assert len(read_recording(csv_of(f"{HEADER}\n1,{'0' * (1 << 19)}2,3,4\n"))) == 1
    with pytest.raises(BadRecording, match="row 2: gx is 'a{40}', no integer"):
        read_recording(csv_of(f"{HEADER}\n1,2,3,4\n2,{'a' * 250_000},3,4\n"))


@pytest.mark.parametrize(("kind", "name", "value", "bits"), [
    ("uint64", "t_us", 2**63 - 1, None), ("int64", "t_us", 1, None),
    ("uint32", "gx", 2**31 - 1, None), ("int16", "gx", -(2**15), None),
    ("int64", "load", -(2**31), None), ("int64", "load", 2**31 - 1, None),
    ("uint64", "t_us", 2**63, 64), ("uint32", "gx", 2**31, 32),
    ("uint32", "load", 2**32 - 1, 32), ("int64", "load", -(2**31) - 1, 32),
])  # fmt: skip
def test_numbers_that_do_not_fit_are_refused_instead_of_wrapped(
    parquet_of, kind, name, value, bits
):
    columns = {n: pa.array([1, 2], pa.int64()) for n in ("t_us", "gx", "gy", "gz", "load")}
    path = parquet_of({**columns, name: pa.array([1, value], getattr(pa, kind)())})
    if bits is None:
        assert read_recording(path).columns[name].tolist() == [1, value]
    else:
        with pytest.raises(BadRecording, match=f"row 2: {name} is {value}, more than {bits} bits"):
            read_recording(path)
