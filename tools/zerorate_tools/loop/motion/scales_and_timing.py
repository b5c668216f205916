"""What motion shows: scale factor and cross-axis, and readings that come late."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import t as student

from ...model import Slot
from ...model.model import RATES
from ...model.term import Term
from ..read.sessions import Session
from ..read.ticks import AnyPath
from .by_windows import GIVEN, RateScale, by_windows
from .columns import LONGEST_S
from .moving import moving_of

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


@dataclass(frozen=True)
class InMotion:
    """Each None where the recordings do not show it, whether or not it was found."""

    rate_scale: RateScale | None = None
    timing: Timing | None = None

    @property
    def found(self) -> bool:
        """Whether anything was."""
        return self.scales is not None or (self.timing is not None and self.timing.found)

    @property
    def scales(self) -> RateScale | None:
        """The scale factor or cross-axis that was found."""
        return self.rate_scale if self.rate_scale is not None and self.rate_scale.found else None


def in_motion(
    train: list[Session],
    holdout: list[Session],
    logs: Mapping[str, AnyPath] | None = None,
    beside: Sequence[Session] = (),
) -> InMotion:
    """What the training sessions' motion shows. logs: the recordings, of whose samples windows in
    motion are made; without them nothing is looked for; beside: sessions that hardly rest. Raises
    CannotClose."""
    if logs is None:
        return InMotion()
    moving = [list(filter(may_show_motion, some)) for some in ([*train, *beside], holdout)]
    parts = [[moving_of(logs[s.name]) for s in some] for some in moving]
    turning = by_windows(*([m for m in part if m is not None] for part in parts))
    delays = [(s.delay, s.tick_s) for s in train if s.delay is not None]
    return InMotion(turning, timing_of(delays) if len(delays) == len(train) else None)


def may_show_motion(session: Session) -> bool:
    """Whether it moves for longer than the longest window."""
    return session.moving_s > LONGEST_S


def without_scales(session: Session, motion: InMotion) -> Session:
    """The session with what turning adds taken out of its blocks, where the rate is known."""
    return replace(session, rate_dps=session.rate_dps - rates_of_turning(session, motion))


def rates_of_turning(session: Session, motion: InMotion) -> np.ndarray:
    """(n, 3) dps that turning adds to each block's error, where the rate is known; else 0."""
    scales = motion.scales
    if scales is None or scales.reference != GIVEN or "rate_x" not in session.sources:
        return np.zeros((session.blocks, 3))
    rate = np.column_stack([session.block_mean(session.sources[n]) for n in RATES])
    return rate @ scales.deployed.T


def slots_of(motion: InMotion) -> list[Slot]:
    """Three slots, one a rate, each with what that rate adds to every axis."""
    t = motion.scales
    if t is None:
        return []
    terms = [Term(n, -float(f), float(f)) for n, f in zip(RATES, t.fastest_dps)]
    columns = [(float(x), float(y), float(z)) for x, y, z in t.deployed.T]
    return [Slot(term, column, t.kind) for term, column in zip(terms, columns)]


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
    if len(rows) < 8 or not total[:, 1].all():
        return None
    delay = -rows[:, 0].sum() / rows[:, 1].sum()
    left = rows[:, 0] + delay * rows[:, 1]
    deviation = float(np.sqrt((left**2).sum() * len(rows) / (len(rows) - 1)) / rows[:, 1].sum())
    p = 2 * float(student.sf(abs(delay) / max(deviation, 1e-15), len(rows) - 1))
    return Timing(float(delay), deviation, p, tuple(float(-a / b) for a, b in total))
