"""A CSV with its scales beside it, as one test wants it."""

import json

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
