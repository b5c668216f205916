"""A trial of BROAD (D. Laidig et al., CC BY 4.0): .mat with optical attitude and movement flag.

The rates are multiples of 0.001065297 rad/s: with that scale the integers come back exactly.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from ..foreign import Foreign
from ..matlab import load_matlab, variable_names
from ..units import RATE_DPS

_RAD_S_PER_LSB = 0.001065297
_G_MPS2 = 9.81
_QUATERNION_LSB = 2.0**-29


def recognises(path: Path) -> bool:
    """By its variables."""
    if path.suffix.lower() != ".mat":
        return False
    needed = {"imu_gyr", "imu_acc", "opt_quat", "movement", "sampling_rate"}
    return needed <= variable_names(path)


def read(path: Path) -> Foreign:
    """opt_q? are w x y z in 2**-29, all four 0 where the cameras saw nothing; moving is 0 or 1."""
    trial = load_matlab(path)
    seen = np.isfinite(trial["opt_quat"]).all(axis=1, keepdims=True)
    optical = np.where(seen, trial["opt_quat"], 0.0) / _QUATERNION_LSB
    extra = {f"opt_q{n}": optical[:, i] for i, n in enumerate("wxyz")}
    extra["moving"] = trial["movement"].ravel().astype(float)
    reference = {name: {"role": "reference", "lsb": _QUATERNION_LSB} for name in extra}
    reference["moving"] = {"role": "reference", "lsb": 1}
    return Foreign(
        gyro=trial["imu_gyr"] * RATE_DPS["rad/s"],
        accel=trial["imu_acc"] / _G_MPS2,
        extra=extra,
        sensor="aktos-t",
        odr_hz=float(trial["sampling_rate"].item()),
        lsb={
            "gyro_lsb_per_dps": math.radians(1) / _RAD_S_PER_LSB,
            "accel_lsb_per_g": 2048.0,
        },
        more={"channels": reference, "source": "BROAD, D. Laidig et al., CC BY 4.0"},
        notes=[
            f"optical attitude kept as opt_qw..opt_qz in 2**-29; {int((~seen).sum())} rows unseen"
        ],
    )
