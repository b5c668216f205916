"""Steps before effects: each session's own are found, timed, sized and taken out of it.

Each stretch between two steps has an offset of its own in every fit from then on.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from scipy.stats import chi2
from zerorate.settings import DEFAULTS

from ...model.term import Term, Terms
from ..fit.common_cause import RARE
from ..fit.regression import OUTLIER, Regression
from ..read.sessions import Session
from .steps import MOST_PER_SESSION, NEAR, Step, standing, steps_and_lags


def remove_steps(sessions: Sequence[Session]) -> list[Session]:
    """Return the sessions without their steps, which they name."""
    return [_less(s, _steps(s, len(sessions))) for s in sessions]


def _steps(session: Session, recordings: int) -> list[Step]:
    """Those of one session of so many in their order; one in the middle of a block, which two
    blocks in turn show, is one."""
    out: list[Step] = []
    beside = bend_of(session)
    regression = Regression([session])
    hold_disturbed(regression, beside, recordings)
    every, late = steps_and_lags(regression, beside, recordings)
    regression.set_events([])
    every = [s for s in every if not _is_thermometers(regression, beside, late, s)]
    for step in sorted(every, key=lambda s: s.block):
        if out and step.block - out[-1].block == 1 and step.size_dps @ out[-1].size_dps > 0:
            deviation = np.hypot(step.deviation_dps, out[-1].deviation_dps)
            size = out[-1].size_dps + step.size_dps
            step = replace(out.pop(), size_dps=size, deviation_dps=deviation)
        out.append(step)
    return out


def _is_thermometers(
    regression: Regression, beside: Terms, late: Mapping[Term, float], step: Step
) -> bool:
    """Whether a jump of the temperature by one reading at most explains the step: nobody knows when
    the temperature moved between two readings. late: the shrunk lags, beside the terms."""
    [session] = regression.sessions
    if not bend_of(session) or not session.temp_step_degc:
        return False
    every = [*beside, *late]
    with regression.shrinking(late):
        fitted = regression.fit(every).coefficients
    degc = session.block_mean(session.sources["temp"])[min(step.block, session.blocks - 1)]
    jump = np.array([_slope(t, degc, session.block_s) for t in every])
    along, most = jump @ fitted, session.temp_step_degc
    weighed = step.weight * along
    off_degc = np.clip(weighed @ step.size_dps / (weighed @ along), -most, most)
    off_slope = step.weight @ (step.size_dps - off_degc * along) ** 2
    return bool(off_slope < chi2.isf(RARE, 2))


def _slope(term: Term, degc: float, block_s: float) -> float:
    """A term's change in the mean of a block, per degC of a jump before it; a lag forgets it."""
    if term.source != "temp":
        return 0.0
    kept = 1.0
    if term.lag_s:
        unit_s = 1.0 if term.lag_mode == "rate" else term.lag_s
        kept = -np.expm1(-block_s / term.lag_s) * unit_s / block_s
    return float(kept * term.power * (degc - term.centre) ** (term.power - 1))


def bend_of(session: Session) -> list[Term]:
    """Line and bend over temperature, beside which steps are looked for."""
    temp = session.sources.get("temp")
    if temp is None or np.ptp(temp) == 0:
        return []
    return [Term("temp", centre=float(temp.mean()), power=k) for k in (1, 2)]


def _less(session: Session, steps: list[Step]) -> Session:
    """The session with the steps taken out of its rates."""
    if not steps:
        return session
    time_s = session.time_s()[:, None]
    levels = [np.where(time_s > s.at_s, s.size_dps, 0.0) for s in steps]
    for k, step in enumerate(steps):
        others = sum(levels[:k] + levels[k + 1 :], np.zeros_like(levels[k]))
        steps[k] = _timed(session, step, others)
        levels[k] = np.where(time_s > steps[k].at_s, step.size_dps, 0.0)
    ticks = sum(levels[1:], levels[0])
    rate = session.rate_dps - np.column_stack([session.block_mean(ticks[:, a]) for a in range(3)])
    at_rest = None if session.ticks_dps is None else session.ticks_dps - ticks
    return replace(session, rate_dps=rate, ticks_dps=at_rest, steps=tuple(steps), level_dps=ticks)


def _timed(session: Session, step: Step, others: np.ndarray) -> Step:
    """The step at the second where its ticks part best, with what the accelerometer saw there.
    others: (ticks, 3) dps that the other steps add."""
    if session.ticks_dps is None:
        return step
    along = step.times_in(session.ticks_dps - others)
    at = _parting(along, step.block, session.ticks_per_block)
    there = np.flatnonzero(np.isfinite(along))
    place = int(np.searchsorted(there, at))
    last, following = (int(there[np.clip(k, 0, len(there) - 1)]) for k in (place - 1, place))
    moment, said = _by_accelerometer(session, at, following)
    at_s = ((last + 1 + following) / 2 if moment is None else moment) * session.tick_s
    return replace(step, at_s=float(at_s), said=said)


def _parting(along: np.ndarray, block: int, per: int) -> int:
    """The tick near a block at which a step of one, beside a line, leaves least of the ticks there:
    what temperature makes of them moves no step."""
    there = np.flatnonzero(np.isfinite(along))
    places = np.arange(max((block - NEAR) * per + 1, 1), min((block + NEAR) * per, len(along)))
    first, last = np.searchsorted(there, [(block - NEAR) * per, (block + NEAR) * per])
    near = there[max(first - NEAR * per, 0) : last + NEAR * per]
    line = np.linalg.qr(np.column_stack([np.ones(len(near)), near - near.mean()]))[0]
    left = along[near][:, None] - (near[:, None] >= places)
    left -= line @ (line.T @ left)
    return int(places[(left**2).sum(axis=0).argmin()])


def _by_accelerometer(session: Session, first: int, last: int) -> tuple[int | None, str]:
    """(tick, words) of the largest jump or click of the accelerometer between two ticks."""
    if "acc_x" not in session.sources:
        return None, ""
    acc = np.column_stack([session.sources[f"acc_{a}"] for a in "xyz"])
    change = np.r_[0.0, np.linalg.norm(np.diff(acc, axis=0), axis=1)]
    shaken = np.sqrt(np.maximum(session.sources.get("vib", np.zeros(len(acc))), 0.0))
    seen = np.maximum(change, shaken - np.median(shaken))
    around = session.ticks_per_block // 2
    a, b = max(0, first - around), min(len(seen), last + around)
    at = a + int(seen[a:b].argmax())
    if seen[at] < max(DEFAULTS["still_g"], OUTLIER * np.median(seen)):
        return None, ""
    said = f"the accelerometer saw {seen[at]:.2g} g at that moment: mechanical stress or a knock"
    return at, said


def hold_disturbed(regression: Regression, terms: Terms, recordings: int = 1) -> None:
    """Hold every disturbance's blocks on a line between their neighbours."""
    kept = regression.events()
    for _ in range(MOST_PER_SESSION):
        steps = sorted(standing(regression, terms, recordings, kept), key=lambda s: s.block)
        regression.set_events([], kept)
        disturbed = [(a, b) for a, b in pairwise(steps) if _undoes(a, b)]
        if not disturbed:
            break
        for a, b in disturbed:
            _hold(regression, a, b)
        regression.prepare()


def _undoes(a: Step, b: Step) -> bool:
    apart = (b.block - b.share) - (a.block - a.share)
    undone = a.size_dps @ b.size_dps < 0
    return bool(a.session == b.session and apart <= NEAR and undone)


def _hold(regression: Regression, a: Step, b: Step) -> None:
    """The blocks from one step to another."""
    rate = regression.rate[a.session].copy()
    at = np.arange(a.block - int(np.ceil(a.share)), b.block)
    there = regression.sessions[a.session].available.copy()
    there[at] = False
    for axis in range(3):
        rate[at, axis] = np.interp(at, np.flatnonzero(there), rate[there, axis])
    regression.rate[a.session] = rate
