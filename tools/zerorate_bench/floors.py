"""Floors of the simulated day: what is left where somebody knows what no device knows."""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from zerorate_tools.simulate import simulate_sessions

Array = NDArray[np.float64]
#: Standard deviation of a second's walk, dps: of 0.1 to 1 mdps the best on the day.
_WALK_DPS_TOLD = 0.0004
_DEGREE = 3
_BANDS = 60


def told_everything(scenario: str | dict[str, Any], seed: int) -> Array:
    """(n, 3) error of the Kalman filter, dps, over a scenario's last session, each sample."""
    rate_dps, wander, still, hz = _day(scenario, seed)
    found, left = _seconds(rate_dps, hz), _seconds(wander, hz)
    rests = _seconds(still[:, None].astype(float), hz)[:, 0] == 1
    followed = _followed(found, rests, (found - left)[rests].std(axis=0))
    return np.repeat(followed, hz, axis=0) - wander[: len(followed) * hz]


def told_the_future(scenario: str | dict[str, Any], seed: int) -> float:
    """RMS that the Wiener smoother leaves, dps, over the last session of a scenario.

    Wiener, Extrapolation, Interpolation, and Smoothing of Stationary Time Series (1949), ch. III:
    at each frequency the product of both powers over their sum.
    """
    rate_dps, wander, still, _ = _day(scenario, seed)
    noise_power = np.var((rate_dps - wander)[still], axis=0)
    left = []
    for axis in range(3):
        power = _smooth(np.abs(np.fft.rfft(wander[:, axis])) ** 2 / len(wander))
        left.append(np.mean(power * noise_power[axis] / (power + noise_power[axis])))
    return float(np.sqrt(np.mean(left)))


def _day(scenario: str | dict[str, Any], seed: int) -> tuple[Array, Array, NDArray[np.bool_], int]:
    """Readings and the bias's wander, both off the curve, dps; the true rests; samples a second."""
    recording, truth = list(simulate_sessions(scenario, seed=seed))[-1]
    scales = recording.scales
    true_dps = truth.bias_lsb / scales.gyro_lsb_per_dps
    curve = np.column_stack([_curve(truth.temp_degc, true_dps[:, axis]) for axis in range(3)])
    return recording.gyro_dps() - curve, true_dps - curve, truth.still, round(scales.odr_hz)


def _smooth(power: Array) -> Array:
    """A periodogram's mean in bands that grow: a single line of it is chance, not spectrum."""
    edges = np.unique(np.geomspace(1, len(power), _BANDS).astype(int))
    sums = np.add.reduceat(power, edges[:-1])
    return np.concatenate([power[:1], np.repeat(sums / np.diff(edges), np.diff(edges))])


def _curve(temp_degc: Array, bias_dps: Array) -> Array:
    return np.asarray(np.polyval(np.polyfit(temp_degc[::50], bias_dps[::50], _DEGREE), temp_degc))


def _seconds(values: Array, hz: int) -> Array:
    n = len(values) // hz
    return values[: n * hz].reshape(n, hz, -1).mean(axis=1)


def _followed(found: Array, still: NDArray[np.bool_], noise: Array) -> Array:
    level, variance, out = np.zeros(3), np.ones(3), np.empty_like(found)
    for i in range(len(found)):
        variance = variance + _WALK_DPS_TOLD**2
        if still[i]:
            gain = variance / (variance + noise**2)
            level, variance = level + gain * (found[i] - level), (1 - gain) * variance
        out[i] = level
    return out
