"""What Bayes' rule says of its own error from the rests so far, told the shapes of all spectra.

A Gaussian process: bias is a parabola over temperature, a walk and flicker noise, and a segment's
mean has white noise beside. Told are the rests, the die's temperature and the white noise; how
large flicker noise and walk are, it finds. Rasmussen and Williams, Gaussian Processes for Machine
Learning (2006), 2.2, 2.7, 5.2; flicker noise is the simulated device's (`simulate.noise.flicker`).
"""

from itertools import product
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cholesky, solve_triangular
from scipy.special import exprel, softmax
from zerorate_tools.loop.read.still import runs
from zerorate_tools.simulate import simulate_sessions
from zerorate_tools.simulate.noise import octaves_s

Array = NDArray[np.float64]
_SEGMENT_S = 2.5
#: Flicker noise tried, dps; believed log-normal at first, 1.7 mdps to within a factor of 2.5.
_FLICKER_DPS = np.array([0.0, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0]) / 1000
_MEDIAN_DPS, _FACTOR, _NEARLY_NONE_DPS = 0.0017, 2.5, 0.00025
#: A second's walk tried, dps -> how far each is believed at first.
_WALK_DPS = {0.0: 0.4, 0.0001: 0.3, 0.0003: 0.2, 0.0013: 0.1}
#: Standard deviations of the parabola over temperature: dps, dps/degC, dps/degC^2.
_PARABOLA_DPS = np.array([6.3, 0.03, 0.001])
#: Standard deviation of a second's walk, dps: of 0.1 to 1 mdps the best on the day.
_WALK_DPS_TOLD = 0.0004
_DEGREE = 3
_BANDS = 60


class Spans(NamedTuple):
    """Stretches of time, s, and their mean temperature; a moment's start is its end."""

    start_s: Array
    end_s: Array
    temp_degc: Array


class Segments(NamedTuple):
    """Segments of rests: their spans, mean rates (n, 3) and white noise's variances, dps^2."""

    spans: Spans
    rate_dps: Array
    white: Array


def segments(
    rate_dps: Array, temp_degc: Array, still: NDArray[np.bool_], hz: float, noise_dps: float
) -> Segments:
    """Every rest cut into segments of 2.5 s, the last one no shorter than a quarter of that."""
    size = round(_SEGMENT_S * hz)
    starts = [(i, end) for start, end in runs(still) for i in range(start, end - size // 4, size)]
    cuts = [(i, min(i + size, end)) for i, end in starts]
    first, last = np.array(cuts).T
    spans = Spans(first / hz, last / hz, np.array([temp_degc[i:j].mean() for i, j in cuts]))
    rate = np.array([rate_dps[i:j].mean(axis=0) for i, j in cuts])
    return Segments(spans, rate, noise_dps**2 / (last - first))


def believed(rests: Segments, at_s: Array, temp_degc: Array, dt_s: float) -> tuple[Array, Array]:
    """The bias and its one sigma, dps, each (moments, 3), at moments after the first segment.

    Each from the segments that ended by then. dt_s: of a sample, where flicker noise begins.
    """
    spans, moments = rests.spans, Spans(at_s, at_s, temp_degc)
    among, across = _covariances(spans, spans, dt_s), _covariances(spans, moments, dt_s)
    flicker_own = np.full(len(at_s), len(octaves_s(dt_s)) / 2)
    own = np.stack([flicker_own, at_s, _parabola(temp_degc, temp_degc)])
    ended = np.searchsorted(spans.end_s, at_s + dt_s / 2)
    tried = list(product(_FLICKER_DPS, _WALK_DPS))
    found = []
    for flicker, walk in tried:
        size = np.array([flicker**2, walk**2, 1.0])
        whole = np.tensordot(size, among, 1) + np.diag(rests.white)
        found.append(_given(whole, np.tensordot(size, across, 1), size @ own, rests, ended))
    return _mixed([_belief(*one) for one in tried], found)


def _mixed(beliefs: list[float], found: list[tuple[Array, Array, Array]]) -> tuple[Array, Array]:
    likely, mean, variance = (np.stack(one) for one in zip(*found))
    weight = softmax(likely + np.array(beliefs)[:, None, None], axis=0)
    bias = (weight * mean).sum(axis=0)
    spread = variance[..., None] + (mean - bias) ** 2
    return bias, np.sqrt((weight * spread).sum(axis=0))


def _given(
    among: Array, across: Array, own: Array, rests: Segments, ended: NDArray[np.intp]
) -> tuple[Array, Array, Array]:
    """Log likelihood, mean (moments, 3) and variance (moments,), each from what had ended."""
    root = cholesky(among, lower=True)
    news = solve_triangular(root, rests.rate_dps, lower=True)
    likely = np.cumsum(-0.5 * news**2 - np.log(np.diag(root))[:, None], axis=0)[ended - 1]
    gains = solve_triangular(root, across, lower=True)
    gains *= np.arange(len(root))[:, None] < ended
    return likely, gains.T @ news, own - (gains**2).sum(axis=0)


def _belief(flicker_dps: float, walk_dps: float) -> float:
    """Logarithm of how far both are believed before any rest."""
    off = np.log(max(flicker_dps, _NEARLY_NONE_DPS) / _MEDIAN_DPS) / np.log(_FACTOR)
    return float(np.log(_WALK_DPS[walk_dps]) - 0.5 * off**2)


def _covariances(a: Spans, b: Spans, dt_s: float) -> Array:
    """(3, a, b): of means under flicker noise of 1 dps, a walk of 1 dps/sqrt(s), the parabola."""
    walk = np.minimum.outer((a.start_s + a.end_s) / 2, (b.start_s + b.end_s) / 2)
    return np.stack([_flicker(a, b, dt_s), walk, _parabola(a.temp_degc[:, None], b.temp_degc)])


def _parabola(a_degc: Array, b_degc: Array) -> Array:
    return np.asarray(np.polyval(_PARABOLA_DPS[::-1] ** 2, a_degc * b_degc))


def _flicker(a: Spans, b: Spans, dt_s: float) -> Array:
    gap = np.maximum(np.subtract.outer(a.start_s, b.end_s), -np.subtract.outer(a.end_s, b.start_s))
    total = np.zeros(gap.shape)
    for tau_s in octaves_s(dt_s):
        long, other = (a.end_s - a.start_s) / tau_s, (b.end_s - b.start_s) / tau_s
        one = np.multiply.outer(exprel(-long), exprel(-other)) * np.exp(-np.maximum(gap, 0) / tau_s)
        if a is b:
            np.fill_diagonal(one, 2 * (1 - exprel(-long)) / long)
        total += one / 2
    return total


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
