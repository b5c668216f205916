"""Sample-timing error: the gyroscope's readings late beside a reference.

A reading that is late by d misses d times the change of rate a second. Within a tick that is told
from a scale factor, because rate and its change are uncorrelated; no bias follows it, so it is
said and not corrected.
"""

from dataclasses import dataclass

import numpy as np
from scipy.stats import t as student

LEVEL = 1e-4
_RUN_S = 30.0
#: Below this there is nothing to fix: a tenth of a millisecond moves a hand's motion by 0.03 dps.
_LEAST_S = 1e-4


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
