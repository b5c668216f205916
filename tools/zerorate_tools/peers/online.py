"""Ways that begin anew at each power-on: the first ten seconds, PyPI's `imufusion` and `vqf`.

Each returns the sessions' biases (n, 3) in dps as they come; nothing outlives a power-on.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .given import Given

SECONDS = 10.0
_G = 9.80665
_ROWS = 200_000
RAISED = {"biasClip": 25.0, "biasSigmaInit": 8.0}


def first_seconds(sessions: Sequence[Given]) -> list[NDArray[np.float64]]:
    """The mean of the first ten seconds, as most small drivers take it; known from the start on."""
    return [np.broadcast_to(_mean(one), one.rate_dps.shape) for one in sessions]


def _mean(one: Given) -> NDArray[np.float64]:
    samples = max(1, round(SECONDS * one.odr_hz))
    return one.rate_dps[:samples].mean(axis=0)


def fusion(sessions: Sequence[Given]) -> list[NDArray[np.float64]]:
    """The offset that the stationary detector of imufusion learns."""
    return [_offsets(one) for one in sessions]


def _offsets(one: Given) -> NDArray[np.float64]:
    import imufusion

    settings = imufusion.BiasSettings()
    settings.sample_rate = one.odr_hz
    bias = imufusion.Bias()
    bias.set_settings(settings)
    rates = one.rate_dps
    found = np.empty_like(rates)
    for i in range(len(rates)):
        found[i] = rates[i] - bias.update(rates[i])
    return found


def vqf_default(sessions: Sequence[Given]) -> list[NDArray[np.float64]]:
    """The Kalman bias of vqf, at rest and in motion, with the filter's own settings."""
    return [_biases(one, {}) for one in sessions]


def vqf_clip_raised(sessions: Sequence[Given]) -> list[NDArray[np.float64]]:
    """The same with clip 25 dps and initial sigma 8 dps."""
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
