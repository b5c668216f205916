"""The unit of rates by their steps: in the wrong one no gyroscope has them."""

import numpy as np

from .units import RATE_DPS

#: Of gyroscopes of 16 bits, by their ranges, and of ST's, by their data sheets: 125 to 4000 dps.
_LSB_PER_DPS = np.r_[32768 / 125, 1 / 0.004375][:, None] / 2.0 ** np.arange(6)
#: Logarithm of what printed digits and data sheets round; distances of levels that tell a step,
#: those of so few steps; and what is a digit of floating point.
_ONE_STEP, _LEVELS, _FEW_STEPS, _ROUNDED = 0.003, 16, 8, 1e-7


def unit_by_steps(rates: np.ndarray) -> str | None:
    """The unit in which rates have the steps of a gyroscope of 16 bits."""
    levels = np.unique(rates[np.isfinite(rates)])
    apart = np.diff(levels)
    apart = apart[apart > _ROUNDED * np.abs(levels).max(initial=0.0)]
    if len(apart) < _LEVELS:
        return None
    apart = apart[apart < _FEW_STEPS * apart.min()]
    counts = np.round(apart / apart.min())
    step = apart.sum() / counts.sum()
    if len(apart) < _LEVELS or (np.abs(apart - counts * step) > step / 20).any():
        return None
    off = {u: np.abs(np.log(step * one * _LSB_PER_DPS)).min() for u, one in RATE_DPS.items()}
    unit = min(off, key=off.__getitem__)
    return unit if off[unit] < _ONE_STEP else None
