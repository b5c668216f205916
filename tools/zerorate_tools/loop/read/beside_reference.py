"""Runs of half a minute beside a given rate or attitude, from products summed a tick."""

import numpy as np

from .reference import Run

#: A run at least.
RUN_S = 30.0
_LEAST_DPS = 5.0
_PEAK = 2.0  # of a hand's motion, in its rms
#: Sums a tick: number, error (3), rate (3), rate x rate (9), error x rate (9), error^2 (3),
#: change x rate (9), change . error (1), change^2 (1).
WIDTH = 1 + 3 + 3 + 9 + 9 + 3 + 9 + 1 + 1


def products(error_dps: np.ndarray, rate_dps: np.ndarray, change_dps2: np.ndarray) -> np.ndarray:
    """(n, WIDTH) of samples (n, 3): what the gyroscope reads beyond the true rate, that rate, and
    its change a second."""
    outer = _outer(rate_dps, rate_dps)
    cross = _outer(error_dps, rate_dps)
    one = np.ones((len(rate_dps), 1))
    late = np.column_stack([(change_dps2 * error_dps).sum(axis=1), (change_dps2**2).sum(axis=1)])
    turned = _outer(change_dps2, rate_dps)
    return np.hstack([one, error_dps, rate_dps, outer, cross, error_dps**2, turned, late])


def _outer(left, right):
    return (left[:, :, None] * right[:, None, :]).reshape(-1, 9)


def runs_of(sums: np.ndarray, tick_s: float) -> list[Run]:
    """Runs of a session. sums: (m, WIDTH) a tick. A run's mean, its bias, is taken out."""
    per = max(1, round(RUN_S / tick_s))
    whole = sums[: len(sums) // per * per].reshape(-1, per, WIDTH).sum(axis=1)
    return [run for row in whole if (run := _run(row)) is not None]


def _run(row: np.ndarray) -> Run | None:
    n, error, rate = row[0], row[1:4], row[4:7]
    if n < 8:
        return None
    outer = row[7:16].reshape(3, 3) - np.outer(rate, rate) / n
    cross = row[16:25].reshape(3, 3) - np.outer(error, rate) / n
    square = float((row[25:28] - error**2 / n).sum())
    if np.trace(outer) / n < _LEAST_DPS**2:
        return None
    # a run's samples share their noise's slow part: it counts as one row, by its mean square
    # a late reading misses so much of the rate's change: the tenth parameter, in seconds
    normal = np.zeros((10, 10))
    normal[:9, :9] = np.kron(np.eye(3), outer)
    normal[9, :9] = normal[:9, 9] = -row[28:37]
    normal[9, 9] = row[38]
    right = np.r_[cross.ravel(), -row[37]]
    fastest = _PEAK * np.sqrt(np.diag(outer) / n)
    return Run(normal / n, right / n, square / n, 3.0, fastest)


def change_of(t_us: np.ndarray, reference_dps: np.ndarray) -> np.ndarray:
    """(n, 3) dps a second; NaN at the ends, beside a gap and where the reference is not known."""
    change = np.full(reference_dps.shape, np.nan)
    if len(t_us) < 3:
        return change
    span_s = (t_us[2:] - t_us[:-2]) * 1e-6
    with np.errstate(invalid="ignore", divide="ignore"):
        slope = (reference_dps[2:] - reference_dps[:-2]) / span_s[:, None]
    change[1:-1] = np.where((span_s < 1.5 * np.median(span_s))[:, None], slope, np.nan)
    return change


def delay_products(miss_dps: np.ndarray, change_dps2: np.ndarray) -> np.ndarray:
    """(n, 2) from which a delay is estimated: the error (n, 3) about its mean with the rate's
    change a second (n, 3), and that squared."""
    miss = miss_dps - (miss_dps.mean(axis=0) if len(miss_dps) else 0.0)
    return np.column_stack([(miss * change_dps2).sum(axis=1), (change_dps2**2).sum(axis=1)])
