"""PyPI `vqf`: the Kalman bias at rest and in motion, without a magnetometer."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .given import Given

_G = 9.80665
_ROWS = 200_000
RAISED = {"biasClip": 25.0, "biasSigmaInit": 8.0}


def vqf_default(sessions: Sequence[Given]) -> list[NDArray[np.float64]]:
    """Each session's bias (n, 3), dps, with the filter's own settings."""
    return [_biases(one, {}) for one in sessions]


def vqf_clip_raised(sessions: Sequence[Given]) -> list[NDArray[np.float64]]:
    """Each session's bias (n, 3), dps, with clip 25 dps and initial sigma 8 dps."""
    return [_biases(one, RAISED) for one in sessions]


def _biases(one: Given, settings: dict[str, float]) -> NDArray[np.float64]:
    from vqf import VQF

    if one.accel_g is None:
        return np.full(one.rate_dps.shape, np.nan)
    the_filter = VQF(1 / one.odr_hz, **settings)
    rates, forces = np.radians(one.rate_dps), one.accel_g * _G
    parts = []
    for start in range(0, len(rates), _ROWS):
        end = start + _ROWS
        state = the_filter.updateBatchFullState(
            np.ascontiguousarray(rates[start:end]), np.ascontiguousarray(forces[start:end])
        )
        parts.append(np.degrees(state["bias"]))
    return np.concatenate(parts)
