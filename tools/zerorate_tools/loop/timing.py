"""Sample-timing error: the gyroscope's readings late beside a reference.

A reading that is late by d misses d times the change of rate a second. Within a tick that is told
from a scale factor, because rate and its change are uncorrelated; no bias follows it, so it is
said and not corrected.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.stats import t as student

LEVEL = 1e-4
_RUN_S = 30.0
#: Below this there is nothing to fix: a tenth of a millisecond moves a hand's motion by 0.03 dps.
_LEAST_S = 1e-4


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


def products(miss_dps: np.ndarray, change_dps2: np.ndarray) -> np.ndarray:
    """(n, 2) from which a delay is estimated: the error (n, 3) about its mean with the rate's
    change a second (n, 3), and that squared."""
    miss = miss_dps - (miss_dps.mean(axis=0) if len(miss_dps) else 0.0)
    return np.column_stack([(miss * change_dps2).sum(axis=1), (change_dps2**2).sum(axis=1)])


@dataclass(frozen=True)
class Timing:
    """Seconds by which readings are late (before the reference's own delay), its deviation, how
    likely by chance, and each session's own."""

    delay_s: float
    deviation_s: float
    p_value: float
    sessions_s: tuple[float, ...]

    @property
    def found(self) -> bool:
        """Whether it is significant, alike in every session, and large enough to matter."""
        same = len({np.sign(d) for d in self.sessions_s}) == 1
        return self.p_value < LEVEL and same and abs(self.delay_s) > _LEAST_S


def timing_of(sessions_products: list[tuple[np.ndarray, float]]) -> Timing | None:
    """The delay of readings. sessions_products: (m, 2) a tick and the tick's seconds, a session
    each. The error is that of runs of half a minute, which are taken as independent. None without
    motion."""
    runs, own = [], []
    for products, tick_s in sessions_products:
        per = max(1, round(_RUN_S / tick_s))
        n = len(products) // per * per
        runs.append(products[:n].reshape(-1, per, 2).sum(axis=1))
        own.append(products.sum(axis=0))
    total = np.vstack(own)
    rows = np.vstack(runs)
    rows = rows[rows[:, 1] > 1e-3 * max(rows[:, 1].max(initial=0.0), 1e-12)]
    if len(rows) < 8 or not (total[:, 1] > 0).all():
        return None
    delay = -rows[:, 0].sum() / rows[:, 1].sum()
    left = rows[:, 0] + delay * rows[:, 1]
    deviation = float(np.sqrt((left**2).sum() * len(rows) / (len(rows) - 1)) / rows[:, 1].sum())
    p = 2 * float(student.sf(abs(delay) / max(deviation, 1e-15), len(rows) - 1))
    return Timing(float(delay), deviation, p, tuple(float(-a / b) for a, b in total))
