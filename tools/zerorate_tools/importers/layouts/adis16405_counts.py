"""ADIS16405 counts in Parquet (SMAC-Group/imudata): 0.05 dps and 3.33 mg a count, no time stamp."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ..foreign import Foreign
from ..table import read_table

_COLUMNS = [f"{letter}{axis}_lsb" for letter in "ga" for axis in "xyz"]


def recognises(path: Path) -> bool:
    """By its column names."""
    if not path.name.endswith(".parquet"):
        return False
    import pyarrow.parquet as pq

    try:
        return pq.read_schema(path).names == _COLUMNS
    except (OSError, ValueError):
        return False


def read(path: Path) -> Foreign:
    """The counts as they are."""
    table = read_table(path)
    return Foreign(
        gyro=np.stack([table[name] for name in _COLUMNS[:3]], axis=1),
        accel=np.stack([table[name] for name in _COLUMNS[3:]], axis=1),
        raw="ga",
        sensor="ADIS16405",
        lsb={"gyro_lsb_per_dps": 20.0, "accel_lsb_per_g": 1000 / 3.33},
        hint_hz="give --hz, samples a second (--hz 100 for the recordings of imudata)",
    )
