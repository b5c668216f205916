"""Whatever bytes a file holds, it ends in a recording or in one line: never in a traceback."""

import gzip
import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from zerorate_bench.foreign_logs import binary as foreign_files
from zerorate_tools.errors import ZerorateError
from zerorate_tools.importers import Options, import_recording
from zerorate_tools.recordings import (
    Scales,
    read_recording,
    recording_from_columns,
    write_recording,
)
from zerorate_tools.simulate import simulate

from .patience import PATIENT

NAMES = ("t_us", "gx", "gy", "gz")
CELLS = st.one_of(
    st.integers(-(10**12), 10**12).map(str),
    st.floats().map(str),
    st.sampled_from(["", " ", "nan", "-", "1e3", '"', "0x10", "1,2", "\t", "\x00", "é"]),
)


def reads_or_refuses(read, *arguments, **options):
    """Run it: what it raises must be one line of ours."""
    try:
        read(*arguments, **options)
    except ZerorateError as error:
        assert "\n" not in str(error)


@PATIENT
@given(st.lists(st.lists(CELLS, min_size=3, max_size=5), max_size=5))
def test_any_cells_in_a_csv(tmp_path, rows):
    text = "\n".join([",".join(NAMES), *(",".join(row) for row in rows)])
    (tmp_path / "x.csv").write_text(text)
    (tmp_path / "x.json").write_text('{"sensor": "X", "odr_hz": 1, "gyro_lsb_per_dps": 1}')
    reads_or_refuses(read_recording, tmp_path / "x.csv")
    reads_or_refuses(
        import_recording, tmp_path / "x.csv", tmp_path / "y.csv", units={"gyro": "dps"}
    )


@PATIENT
@given(st.binary(max_size=300), st.sampled_from(["x.csv", "x.csv.gz", "x.parquet"]))
def test_any_bytes_as_a_recording(tmp_path, content, name):
    (tmp_path / name).write_bytes(content)
    (tmp_path / "x.json").write_bytes(content[:50])
    reads_or_refuses(read_recording, tmp_path / name)


JSON = st.recursive(
    st.none() | st.booleans() | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner),
)


@PATIENT
@given(JSON | st.fixed_dictionaries({"sensor": JSON, "odr_hz": JSON, "gyro_lsb_per_dps": JSON}))
def test_any_json_as_scales(tmp_path, scales):
    (tmp_path / "x.csv").write_text(",".join(NAMES) + "\n1,2,3,4\n")
    (tmp_path / "x.json").write_text(json.dumps(scales))
    reads_or_refuses(read_recording, tmp_path / "x.csv")


LETTERS = st.text('0123456789.,;|\t\n #$*-+:eETZgxyzt_us"', max_size=400)


@PATIENT
@given(LETTERS, st.sampled_from(["utf-8", "utf-16", "latin-1"]), st.sampled_from([None, 10.0]))
def test_any_text_as_a_foreign_table(tmp_path, text, encoding, hz):
    head = "t_us,gx_dps,gy_dps,gz_dps\n1,2,3,4\n" if len(text) % 2 else ""
    (tmp_path / "x.csv").write_bytes((head + text).encode(encoding))
    out = tmp_path / "out.parquet"
    reads_or_refuses(import_recording, tmp_path / "x.csv", out, options=Options(hz=hz))


FOREIGN = ["x.csv", "x.tsv", "x.csv.gz", "x.parquet", "x"]


@PATIENT
@given(st.binary(min_size=1, max_size=300), st.sampled_from(FOREIGN))
def test_any_bytes_as_a_foreign_recording(tmp_path, content, name):
    (tmp_path / name).write_bytes(content)
    reads_or_refuses(
        import_recording, tmp_path / name, tmp_path / "out.csv", options=Options(hz=10)
    )


def whole_files(tmp_path):
    """One small sound file of each kind that is read byte by byte."""
    lines = "\n".join([foreign_files.vectornav_line((0.01, 0.02, 0.03))] * 9)
    (tmp_path / "vn.csv.gz").write_bytes(gzip.compress(lines.encode()))
    columns = dict.fromkeys(NAMES, np.arange(100))
    recording = recording_from_columns(columns, Scales("X", 1, 1))
    write_recording(recording, tmp_path / "own.parquet")
    return sorted(p for p in tmp_path.iterdir() if p.suffix != ".json")


@pytest.mark.parametrize("number", (0, 1))
def test_any_cut_and_any_flipped_bit(tmp_path, number):
    source = whole_files(tmp_path)[number]
    whole, rng = source.read_bytes(), np.random.default_rng(number)
    reads = read_recording if source.suffix == ".parquet" else import_recording
    more = () if source.suffix == ".parquet" else (tmp_path / "out.csv",)
    for _ in range(60):
        damaged = bytearray(whole)
        damaged[rng.integers(len(whole))] ^= 1 << rng.integers(8)
        source.write_bytes(damaged if rng.random() < 0.5 else whole[: rng.integers(len(whole))])
        reads_or_refuses(reads, source, *more)


@PATIENT
@given(
    st.dictionaries(
        st.sampled_from(["sensor", "bias", "noise", "session", "effect", "channels", "seed", "x"]),
        JSON,
    )
)
def test_any_description(tmp_path, entries):
    reads_or_refuses(simulate, {"every_session": {"s": 1.0}, **entries})
