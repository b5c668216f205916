"""A CSV with its scales beside it, as one test wants it."""

import json

import pyarrow as pa
import pyarrow.parquet as pq
import pytest


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
