"""The mean of the first ten seconds after power-on, as most small drivers take it."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .given import Given

SECONDS = 10.0


def first_seconds(sessions: Sequence[Given]) -> list[NDArray[np.float64]]:
    """Each session's bias (n, 3), dps; known from the first sample on, to its advantage."""
    return [np.broadcast_to(_mean(one), one.rate_dps.shape) for one in sessions]


def _mean(one: Given) -> NDArray[np.float64]:
    samples = max(1, round(SECONDS * one.odr_hz))
    return one.rate_dps[:samples].mean(axis=0)
