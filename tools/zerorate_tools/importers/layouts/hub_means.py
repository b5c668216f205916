"""LSM6DS3TR-C in three hubs: each row the mean of 1000 readings, printed to 0.01 dps, 0.1 degC.

1000 LSB/dps and 100 LSB/degC hold what was printed exactly: only the authors' rounding remains.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ..foreign import Foreign
from ..table import first_line, read_table


def recognises(path: Path) -> bool:
    """By its header."""
    if not path.name.endswith((".csv", ".csv.gz")):
        return False
    names = [name.strip() for name in first_line(path).split(",")]
    return names[-4:] == ["temp", "xaxis", "yaxis", "zaxis"]


def read(path: Path) -> Foreign:
    """RB has time and heater power (dc, %); RX and TH have neither."""
    table = read_table(path)
    heater = {"heater_pct": table["dc"]} if "dc" in table else {}
    return Foreign(
        time_s=table.get("time"),
        gyro=np.stack([table[f"{axis}axis"] for axis in "xyz"], axis=1),
        temp=table["temp"],
        extra=heater,
        sensor="LSM6DS3TR-C",
        lsb={
            "gyro_lsb_per_dps": 1000.0,
            "temp_lsb_per_degc": 100.0,
            "temp_offset_degc": 0.0,
        },
        notes=["rows are means, printed to 0.01 dps and 0.1 degC: 1000 LSB/dps holds them exactly"],
        hint_hz="give --hz, rows a second (the hubs wrote one row every 15 s: --hz 1/15)",
    )
