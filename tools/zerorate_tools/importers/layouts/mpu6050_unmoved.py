"""MPU-6050 at +-250 dps and +-2 g printed as dps, g and degC (sunsided/sensor-fusion).

Six printed digits of integers over 131, 16384 and 340: the integers come back exactly.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ..foreign import Foreign
from ..table import first_line, read_table

_HEADER = "t_s,gx_dps,gy_dps,gz_dps,ax_g,ay_g,az_g,temp_C"


def recognises(path: Path) -> bool:
    """By its header."""
    return path.name.endswith((".csv", ".csv.gz")) and first_line(path).strip() == _HEADER


def read(path: Path) -> Foreign:
    """Stamps stay as they are: they come in bursts."""
    table = read_table(path)
    return Foreign(
        time_s=table["t_s"],
        gyro=np.stack([table[f"g{axis}_dps"] for axis in "xyz"], axis=1),
        accel=np.stack([table[f"a{axis}_g"] for axis in "xyz"], axis=1),
        temp=table["temp_C"],
        sensor="MPU-6050",
        odr_hz=100.0,
        lsb={
            "gyro_lsb_per_dps": 131.0,
            "accel_lsb_per_g": 16384.0,
            "temp_lsb_per_degc": 340.0,
            "temp_offset_degc": 36.53,
        },
        notes=["time stamps come in bursts and stay as recorded; 100 Hz is nominal"],
    )
