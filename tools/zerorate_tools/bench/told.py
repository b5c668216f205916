"""The day by a Kalman filter that is told what nobody knows: what no estimator is below.

It is told the true rests, the true curve over temperature and the walk that suits this very day
best. What is left is white noise at rest, and the wander of the bias while it moves.
"""

import numpy as np
from numpy.typing import NDArray

from ..simulate import simulate_sessions

Array = NDArray[np.float64]
#: Standard deviation of a second's walk, dps: of 0.1 to 1 mdps the best on the day.
_WALK_DPS = 0.0004
_DEGREE = 3


def told_everything(name: str, seed: int) -> Array:
    """(seconds, 3) error of its bias, dps, over the last session of a bundled scenario."""
    recording, truth = list(simulate_sessions(name, seed=seed))[-1]
    scales = recording.scales
    hz, true_dps = round(scales.odr_hz), truth.bias_lsb / scales.gyro_lsb_per_dps
    curve = np.column_stack([_curve(truth.temp_degc, true_dps[:, axis]) for axis in range(3)])
    found = _seconds(recording.gyro_dps() - curve, hz)
    left = _seconds(true_dps - curve, hz)
    still = _seconds(truth.still[:, None].astype(float), hz)[:, 0] == 1
    return _followed(found, still, (found - left)[still].std(axis=0)) - left


def _curve(temp_degc: Array, bias_dps: Array) -> Array:
    return np.asarray(np.polyval(np.polyfit(temp_degc[::50], bias_dps[::50], _DEGREE), temp_degc))


def _seconds(values: Array, hz: int) -> Array:
    n = len(values) // hz
    return values[: n * hz].reshape(n, hz, -1).mean(axis=1)


def _followed(found: Array, still: NDArray[np.bool_], noise: Array) -> Array:
    level, variance, out = np.zeros(3), np.ones(3), np.empty_like(found)
    for i in range(len(found)):
        variance = variance + _WALK_DPS**2
        if still[i]:
            gain = variance / (variance + noise**2)
            level, variance = level + gain * (found[i] - level), (1 - gain) * variance
        out[i] = level
    return out
