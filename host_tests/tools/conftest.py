"""Recordings as one test wants them, and what stands in the place of a function."""

import json
from pathlib import Path
from unittest.mock import Mock

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from zerorate_tools.recordings import Recording, Scales, write_recording


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


@pytest.fixture
def parquet_of(tmp_path):
    """parquet_of(columns) -> the path of a Parquet file of them, with scales."""

    def write(columns):
        scales = b'{"sensor": "X", "odr_hz": 1, "gyro_lsb_per_dps": 1}'
        table = pa.table(columns).replace_schema_metadata({b"zerorate": scales})
        pq.write_table(table, tmp_path / "x.parquet")
        return tmp_path / "x.parquet"

    return write


@pytest.fixture
def stands_in(monkeypatch):
    """stands_in(path of a name, what it returns or raises): the Mock in its place."""

    def put(path, result=None):
        raises = isinstance(result, Exception)
        mock = Mock(**{"side_effect" if raises else "return_value": result})
        monkeypatch.setattr(path, mock)
        return mock

    return put


@pytest.fixture
def own_folder(monkeypatch, tmp_path):
    """A folder to work in, with a recording of four samples and a program in it."""
    monkeypatch.chdir(tmp_path)
    columns = {name: np.arange(4) for name in ("t_us", "gx", "gy", "gz")}
    write_recording(Recording(columns, Scales("X", 10.0, 131.0), "run"), "run.parquet")
    Path("s.py").write_text("imu = 1")
