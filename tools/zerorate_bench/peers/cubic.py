"""Cubic fits over temperature, made offline from session 1 with the true rests given.

Written from the descriptions in flight stacks' documentation: PX4 filters by a median of 31,
takes 2000 steps of temperature and fits order 3; ArduPilot takes the means of 0.5 degC steps and
fits order 3 about 35 degC. Both hold the value at the ends of the fitted range.
"""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import NDArray
from scipy.ndimage import median_filter
from zerorate_tools.peers.given import Given

_ORDER = 3
_MEDIAN = 31
_STEPS = 2000
_STEP_DEGC = 0.5
_ABOUT_DEGC = 35.0


def px4_cubic(sessions: Sequence[Given]) -> list[NDArray[np.float64]]:
    """Each session's bias (n, 3), dps, by PX4's rules."""
    return _fitted_on_the_first(sessions, _px4_points)


def ardupilot_cubic(sessions: Sequence[Given]) -> list[NDArray[np.float64]]:
    """Each session's bias (n, 3), dps, by ArduPilot's rules."""
    return _fitted_on_the_first(sessions, _ardupilot_points)


Points = Callable[[NDArray, NDArray], tuple[NDArray, NDArray]]


def _fitted_on_the_first(sessions: Sequence[Given], points: Points) -> list[NDArray[np.float64]]:
    first = sessions[0]
    if first.temp_degc is None:
        return [np.full(one.rate_dps.shape, np.nan) for one in sessions]
    temp, rates = points(first.temp_degc[first.still], first.rate_dps[first.still])
    if len(temp) <= _ORDER:
        return [np.full(one.rate_dps.shape, np.nan) for one in sessions]
    curves = [Polynomial.fit(temp - _ABOUT_DEGC, axis, _ORDER) for axis in rates.T]
    low, high = temp.min(), temp.max()

    def of(one: Given) -> NDArray[np.float64]:
        held = np.clip(np.asarray(one.temp_degc), low, high) - _ABOUT_DEGC
        return np.stack([curve(held) for curve in curves], axis=1)

    return [of(one) for one in sessions]


def _px4_points(temp: NDArray, rates: NDArray) -> tuple[NDArray, NDArray]:
    filtered = median_filter(rates, size=(_MEDIAN, 1), mode="nearest")
    edges = np.linspace(temp.min(), temp.max(), _STEPS + 1)
    return _step_means(temp, filtered, np.clip(np.digitize(temp, edges) - 1, 0, _STEPS - 1))


def _ardupilot_points(temp: NDArray, rates: NDArray) -> tuple[NDArray, NDArray]:
    # a step is taken when the temperature reaches it, so only while it rises
    rising = temp >= np.maximum.accumulate(temp) - _STEP_DEGC
    steps = np.floor((temp - temp.min()) / _STEP_DEGC).astype(int)
    return _step_means(temp[rising], rates[rising], steps[rising])


def _step_means(temp: NDArray, rates: NDArray, steps: NDArray) -> tuple[NDArray, NDArray]:
    counts = np.bincount(steps)
    filled = counts > 0
    means = [np.bincount(steps, values)[filled] / counts[filled] for values in (temp, *rates.T)]
    return means[0], np.stack(means[1:], axis=1)
