"""Samples at which a gyroscope is at the end of its own range, wherever that lies in a recording.

A recording in physical units has no 16-bit rail: where the sensor stopped, its rate is flat.
"""

import numpy as np
from scipy.ndimage import binary_opening, median_filter

#: Steps in a row without the sensor's noise, each of this share of its usual step. Of white noise
#: one of seven steps is so small, so five in a row stand by chance in one of 17,000 places; they
#: count only near the largest rate, where there are few.
_STEPS, _SHARE = 5, 0.25
_NEAR_LARGEST = 0.8
#: Usual steps that a range has at least: noise about a bias has no end of a range.
_RANGE_STEPS = 50.0
#: Samples over which a usual step is measured; the quietest tenth counts.
_SPAN, _QUIETEST = 21, 0.1


def saturated(rate: np.ndarray) -> np.ndarray:
    """(n,) bool: a rate, of (n, 3) in any unit, is at a level that the sensor does not exceed.

    Nothing is found where the noise is below the resolution.
    """
    out = np.zeros(len(rate), bool)
    if len(rate) <= _SPAN:
        return out
    steps = np.abs(np.diff(rate, axis=0))
    usual = float(np.median(np.quantile(median_filter(steps, (_SPAN, 1)), _QUIETEST, axis=0)))
    flat = binary_opening(steps < _SHARE * usual, np.ones((_STEPS, 1), bool))
    flat = np.vstack([flat[:1], flat])
    for values, still in zip(rate.T, flat.T):
        least = max(_NEAR_LARGEST * np.abs(values).max(), _RANGE_STEPS * usual)
        for side in (1, -1):
            level = (side * values)[still & (side * values > least)]
            if len(level):
                out |= side * values >= level.min() - usual
    return out
