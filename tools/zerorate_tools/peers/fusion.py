"""PyPI `imufusion`: the offset that its stationary detector learns, as it comes."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .given import Given


def fusion(sessions: Sequence[Given]) -> list[NDArray[np.float64]]:
    """Each session's bias (n, 3), dps; nothing outlives a power-on."""
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
