"""Samples on an even clock: those that were lost now and then, or taken by a loop that wavers."""

from collections.abc import Callable

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.signal import filtfilt

#: Times the usual between two samples from which on it is a gap, which no window spans.
GAP = 5
#: Samples over which time goes on, though up to four come at once as radios send them.
_BATCH = 12
#: Seconds after which a late stamp has passed, whoever made it, and a late sample has not.
_LAG_S = 1.0
#: Share of the time between samples within which they are even.
_EVEN = 0.01
#: Share of it that samples of one stamp are apart at least: no cubic goes through two at once.
_LEAST = 0.1

Put = Callable[[np.ndarray], np.ndarray]


def evenly(t_us: np.ndarray) -> tuple[np.ndarray, Put]:
    """Times (m,) of an even clock in us, none in gaps, and what puts samples (n, k) on it."""
    apart, some = np.diff(t_us).astype(float), min(_BATCH, len(t_us) // 2)
    short = apart <= GAP * np.median(t_us[some:] - t_us[:-some]) / some
    usual = float(apart[short].mean())
    stamped = np.append(0.0, np.cumsum(np.where(short, apart - usual, 0.0)))
    late = _taken_late(stamped, usual)
    if np.ptp(late) < _EVEN * usual:
        return t_us, lambda samples: samples
    apart_us = _LEAST * usual * np.arange(len(t_us))
    at_us = np.maximum.accumulate(t_us - stamped + late - apart_us) + apart_us
    clock = np.arange(at_us[0], at_us[-1], usual)
    after = np.searchsorted(at_us, clock, side="right").clip(1, len(at_us) - 1)
    clock, after = clock[short[after - 1]], after[short[after - 1]]
    before_us, after_us = at_us[after - 1], at_us[after]
    share = ((clock - before_us) / np.maximum(after_us - before_us, 1.0))[:, None]

    def put(samples: np.ndarray) -> np.ndarray:
        if np.isfinite(samples).all():  # a line would lessen a swing of a second by 0.5 % at 25 Hz
            return np.asarray(CubicSpline(at_us, samples)(clock))
        return samples[after - 1] + share * (samples[after] - samples[after - 1])

    return clock, put


def _taken_late(stamped: np.ndarray, usual: float) -> np.ndarray:
    """(n,) us by which samples were taken late, of what their stamps (n,) are.

    A sample that is lost, or taken late, moves all that follow; a stamp that is late moves itself.
    So lateness is a random walk, of variance q a sample, beside noise of variance r: a local level
    (Durbin and Koopman 2012, 2.2), whose smoother weighs stamps by a power of how far off they are.
    """
    n = min(max(1, round(_LAG_S * 1e6 / usual)), len(stamped) // 4)
    once, twice = (((stamped[k:] - stamped[:-k]) ** 2).mean() for k in (n, 2 * n))
    q, r = max((twice - once) / n, 0.0), max(once - 0.5 * twice, 0.0)
    ratio = max(q / max(r, 1e-9), len(stamped) ** -2.0)
    power = 1.0 / (1.0 + 0.5 * ratio + np.sqrt(ratio + 0.25 * ratio**2))
    return np.asarray(filtfilt([1.0 - power], [1.0, -power], stamped))
