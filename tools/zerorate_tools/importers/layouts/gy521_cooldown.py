"""A GY-521 board's cool-down, with two ambient thermometers, magnetometer and supply."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ..foreign import Foreign
from ..table import first_line, read_table

_EXTRA = {
    "vdd_mv": ("volt", 1),
    "aht_temp_mdegc": ("AHT_tmp[C]", 1000),
    "humidity_mpct": ("AHT_hum", 1000),
    "bmp_temp_mdegc": ("BMP_temp[C]", 1000),
    "pressure_pa": ("BMP_pres", 1),
    "mag_x_lsb": ("magx", 1),
    "mag_y_lsb": ("magy", 1),
    "mag_z_lsb": ("magz", 1),
}


def recognises(path: Path) -> bool:
    """By its header."""
    line = first_line(path) if path.name.endswith((".csv", ".csv.gz")) else ""
    return line.startswith("now[ms],AHT_tmp[C],AHT_hum,BMP_temp[C]")


def read(path: Path) -> Foreign:
    """gtemp is the die's; it moves in steps of 16/340 degC, so raw values are multiples of 16."""
    table = read_table(path)
    return Foreign(
        time_s=table["now[ms]"] * 1e-3,
        gyro=np.stack([table[f"g{axis}"] for axis in "xyz"], axis=1),
        accel=np.stack([table[f"a{axis}"] for axis in "xyz"], axis=1),
        temp=table["gtemp"],
        temp_step_lsb=16,
        extra={name: table[column] * factor for name, (column, factor) in _EXTRA.items()},
        sensor="MPU-6050",
        lsb={
            "gyro_lsb_per_dps": 131.0,
            "accel_lsb_per_g": 16384.0,
            "temp_lsb_per_degc": 340.0,
            "temp_offset_degc": 36.53,
        },
        notes=["acceleration was printed in mg: 16 LSB apart; rates come back exactly"],
    )
