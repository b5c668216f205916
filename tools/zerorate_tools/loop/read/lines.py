"""Periodic interference: lines in the spectrum of the rate at rest (heater PWM, mains, motors).

A line is judged beside its own neighbourhood, never beside white noise: on coloured noise the usual
false-alarm probabilities of a periodogram are wrong nine times in ten. It must stand out in every
session. Its phase is free at each power-on, so it is said and not corrected.
"""

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import median_filter
from scipy.optimize import nnls
from scipy.stats import gamma

LEVEL = 1e-6
MOST = 3
_NEAR = 24  # bins to either side that are the neighbourhood
#: Bins, from and to, of the nearest of it, beside which a slow hump is no line either.
_NEXT = (2, 8)
_HUMP = 0.8  # share of the nearest, whose few bins are known badly, that counts
#: Power of a line to its neighbourhood's: in every session on its best axis, and on average where
#: a session gives one periodogram, whose continuum is known badly at its slow end.
_EACH_RATIO, _SINGLE_RATIO = 2.0, 12.0
_EDGE_HZ = 0.96  # of half the rate: above, a padded spectrum's bins are not independent
SEGMENT = 2048
_MOST_SEGMENTS = 1500


@dataclass(frozen=True)
class Line:
    """hz; amplitude_dps (3,) an axis; p_value over all frequencies; in_holdout: seen there too."""

    hz: float
    amplitude_dps: np.ndarray
    p_value: float
    in_holdout: bool = False


@dataclass(frozen=True)
class Spectrum:
    """Power (K, 3), dps^2 an axis as a line's half squared amplitude, at K frequencies step_hz
    apart from 0; averages: independent periodograms in it."""

    power: np.ndarray
    step_hz: float
    averages: float


def spectrum(rate_dps: np.ndarray, step_s: float, length: int) -> Spectrum:
    """Of (m, 3) equally spaced rates, NaN where not at rest, padded to a length for all sessions.

    Straight lines bridge what is not at rest; where that is more than a tenth, there is none.
    """
    there = np.isfinite(rate_dps).all(axis=1)
    at = np.arange(len(rate_dps))
    filled = np.column_stack([np.interp(at, at[there], column[there]) for column in rate_dps.T])
    window = np.hanning(len(filled))[:, None]
    filled = filled - filled.mean(axis=0)
    bins = np.abs(np.fft.rfft(filled * window, length, axis=0)) / window.sum()
    return Spectrum(2 * bins**2, 1.0 / (length * step_s), 1.0)


def beside_neighbours(s: Spectrum, wide: float) -> np.ndarray:
    """(K, 3) power in units of its neighbourhood's, near or nearest; wide: bins of one line."""
    size = 2 * round(_NEAR * wide) + 1
    shape = np.column_stack([_continuum(column) for column in s.power.T])
    flat = s.power / shape
    bias = gamma.median(s.averages) / s.averages
    usual = median_filter(flat, size=(size, 1), mode="nearest")
    # bins whose neighbourhood would reach below 0 Hz: noise has its humps there
    slow = size // 2 + 1
    nearest = median_filter(flat[: 2 * slow], footprint=_ring(wide), mode="mirror")[:slow]
    usual[:slow] = np.maximum(usual[:slow], _HUMP * nearest)
    return flat / np.maximum(usual / bias, 1e-300)


def _ring(wide: float) -> np.ndarray:
    """(bins, 1) bool: the nearest neighbours without the line itself."""
    inner, outer = (round(n * wide) for n in _NEXT)
    away = np.abs(np.arange(-outer, outer + 1))
    return (away > inner)[:, None]


def _continuum(power: np.ndarray) -> np.ndarray:
    """(K,) white + flicker + random walk that a spectrum rides on: a slope is no line."""
    k = np.maximum(np.arange(len(power)), 1.0)
    basis = np.column_stack([np.ones(len(k)), len(k) / k, (len(k) / k) ** 2])
    fit = np.full(len(power), np.median(power) + 1e-300)
    clipped = power
    for _ in range(6):
        fit = basis @ nnls(basis[1:] / fit[1:, None], clipped[1:] / fit[1:])[0] + 1e-300
        clipped = np.minimum(power, 4.0 * fit)
    return fit


def find(
    train: list[Spectrum], holdout: list[Spectrum], wide: float, slowest_hz: float
) -> list[Line]:
    """Lines in all training sessions, the strongest first. wide: bins that one line covers."""
    ratios = [beside_neighbours(s, wide) for s in train]
    total = sum(s.averages for s in train) * 3
    joint = sum(r.sum(axis=1) * s.averages for r, s in zip(ratios, train))
    each = np.min([r.max(axis=1) for r in ratios], axis=0)
    hz = np.arange(len(joint)) * train[0].step_hz
    tried = max(len(joint) / wide, 1.0)
    p = np.minimum(gamma.sf(joint, total) * tried, 1.0)
    p[(hz < slowest_hz) | (each < _EACH_RATIO)] = 1.0
    if total <= 3 * len(train):
        p[joint < _SINGLE_RATIO * total] = 1.0
    p[hz > _EDGE_HZ * hz[-1]] = 1.0
    out: list[Line] = []
    while len(out) < MOST and p.min() < LEVEL:
        at = int(np.where(p < LEVEL, joint, 0.0).argmax())
        out.append(_line(at, hz[at], float(p[at]), train, holdout, wide))
        p[_hump(p, at, round(3 * wide))] = 1.0
    return out


def _hump(p: np.ndarray, at: int, reach: int) -> slice:
    """Slice around a line: what stands out beside it without a gap is the same hump."""
    low = high = at
    while low > 0 and (p[max(0, low - reach) : low] < LEVEL).any():
        low -= 1
    while (p[high + 1 : high + 1 + reach] < LEVEL).any():
        high += 1
    return slice(max(0, low - reach), high + reach + 1)


def _line(
    at: int, hz: float, p: float, train: list[Spectrum], holdout: list[Spectrum], wide: float
) -> Line:
    power = np.mean([s.power[at] for s in train], axis=0)
    seen = [beside_neighbours(s, wide)[at].max() > _EACH_RATIO for s in holdout]
    return Line(float(hz), np.sqrt(2 * power), p, bool(seen) and all(seen))


class Segments:
    """Power of segments of samples; which of them were at rest is known when all is read."""

    def __init__(self) -> None:
        self.power: list[np.ndarray] = []
        self.ticks: list[tuple[int, int]] = []
        self._kept = np.zeros((0, 3))
        self._kept_tick = np.zeros(0, np.int64)
        self._window = np.hanning(SEGMENT)[:, None]

    def add(self, tick: np.ndarray, rate_dps: np.ndarray) -> None:
        """Samples (n, 3) in time order with the tick of each."""
        rate = np.vstack([self._kept, rate_dps])
        tick = np.concatenate([self._kept_tick, tick])
        whole = len(rate) // SEGMENT
        for i in range(whole if len(self.power) < _MOST_SEGMENTS else 0):
            part = slice(i * SEGMENT, (i + 1) * SEGMENT)
            centred = rate[part] - rate[part].mean(axis=0)
            bins = np.abs(np.fft.rfft(centred * self._window, axis=0)) / self._window.sum()
            self.power.append((2 * bins**2).astype(np.float32))
            self.ticks.append((int(tick[part][0]), int(tick[part][-1])))
        self._kept, self._kept_tick = rate[whole * SEGMENT :], tick[whole * SEGMENT :]

    def at_rest(self, still: np.ndarray, odr_hz: float) -> Spectrum | None:
        """Mean over the segments all of whose ticks were still; None with fewer than four."""
        use = [
            power
            for power, (first, last) in zip(self.power, self.ticks)
            if still[first : last + 1].all() and (last - first + 2) > 0.9 * SEGMENT / odr_hz
        ]
        if len(use) < 4:
            return None
        mean = np.mean(use, axis=0, dtype=float)
        return Spectrum(mean, odr_hz / SEGMENT, float(len(use)))
