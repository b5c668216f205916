"""Steps in the bias: listed with time and size, taken as nuisances, never corrected.

A step is the same moment on all axes and more than the noise's own colour makes. All places of a
session are looked at together at the colour that fits best, one step after the other; each must
stand beside all others.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.stats import chi2

from ...model.term import Term, Terms
from ..fit.noise import NATS
from ..fit.regression import Events, Regression, predicted
from ..fit.resampling import NullRatios
from ..fit.shrunk import shrink
from ..read.sessions import Session
from .catalogue import SMALLEST, Candidate, candidates, lags, late
from .decide import LEVEL
from .refine import refined
from .step_places import LONGEST, Ratios, best_place, beyond_ramps, heavisides, tried

MOST_PER_SESSION = 4
#: Blocks by which the place of a step may be off, or move when other terms stand beside it; and
#: between two that undo each other up to which they are a disturbance.
NEAR = 2
#: The likelihood ratio of a form over channels beside which steps must stand.
_A_FORM = 45.0


@dataclass(eq=False)  # two in one block are two, and arrays do not say whether they are equal
class Step:
    """A step: session index, first block that is all after it, sizes in dps per axis with their
    standard deviations, and how sure. share: of the block before that one, what is after it; at_s:
    seconds since the session's start; said: what else was seen.
    """

    session: int
    block: int
    size_dps: np.ndarray
    ratio: float
    p_value: float
    deviation_dps: np.ndarray = field(default_factory=lambda: np.zeros(3))
    at_s: float = 0.0
    said: str = ""
    share: float = 0.0

    @property
    def weight(self) -> np.ndarray:
        """(3,) how sure each size is: one over its variance."""
        return 1.0 / np.maximum(self.deviation_dps, 1e-12) ** 2

    def times_in(self, dps: np.ndarray) -> np.ndarray:
        """(...,) how many times the step is in (..., 3) dps."""
        along = self.size_dps * self.weight
        return dps @ along / (self.size_dps @ along)


def steps_and_lags(
    regression: Regression, terms: Terms, recordings: int = 1
) -> tuple[list[Step], dict[Term, float]]:
    """Every step beside the terms, strongest first, which stay in the regression as nuisances; and
    the shrinkage of the lags of temperature beside which they stand (`Regression.shrinking`).

    A kink or a loop that the terms lack is made of steps, too, a part that is late behind its
    thermometer makes one at every corner, and a channel that jumps makes the bias jump: what
    follows a channel is taken beside the terms first, wherever it explains more than the steps do,
    or much beside them. What follows time alone is not: a step is one.
    recordings: of one device, each searched by itself, which share the level.
    """
    beside, sessions = list(terms), regression.sessions
    forms = [c for c in candidates(sessions) if not c.follows_time] + late(sessions)
    lagging = dict[Term, float]()
    while True:
        regression.set_events([])
        steps = sorted(_all(regression, beside, recordings), key=lambda s: -s.ratio)
        if not steps:
            break
        form, gain = _best_form(regression, beside, forms)
        if gain < steps[0].ratio:
            _set(regression, steps, None)
            form, gain = _best_form(regression, beside, forms)
        if form is None or gain < _A_FORM:
            break
        beside += refined(regression, beside, form).terms
    if steps and lags(sessions):
        lagging = _shrunk_lags(regression, terms)
        with regression.shrinking(lagging):
            stand = _all(regression, [*beside, *lagging], recordings)
        steps = [s for s in steps if any(_is_same(s, other) for other in stand)]
    _set(regression, steps, None)
    steps = _sized(regression, beside, steps, [])
    fitted, own = regression.fit(beside).coefficients[len(terms) :], beside[len(terms) :]
    return [s for s in steps if not _is_timing(regression, own, fitted, s)], lagging


def _is_same(a: Step, b: Step) -> bool:
    """Whether two are the same one, found beside other terms."""
    return a.session == b.session and abs(a.block - b.block) <= NEAR


def _shrunk_lags(regression: Regression, terms: Terms) -> dict[Term, float]:
    """All lags of temperature together, shrunk as they are likeliest beside the terms alone,
    because a form or a step takes the place of several."""
    regression.set_events([])
    late = lags(regression.sessions)
    own = slice(len(terms), len(terms) + len(late))
    products = regression.cross_products([*terms, *late])
    squares = np.einsum("sgjj->j", products.zz)[own]
    alike = products.mapped(own.start, np.diag(squares**-0.5))
    said = shrink(alike, regression.scale, [*terms, *late[:1] * len(late)], own)
    return dict(zip(late, (said.precision[0, own] * squares).tolist()))


def _is_timing(regression: Regression, forms: Terms, fitted: np.ndarray, step: Step) -> bool:
    """Whether the forms taken beside a step change by more than its size from the block before it
    to that after it: a reading that is late by seconds makes such a step."""
    session = regression.sessions[step.session]
    times = step.times_in(predicted(forms, fitted, session))
    following = min(step.block + 1, session.blocks - 1)
    return bool(abs(times[following] - times[step.block - 1]) > 1.0)


def _best_form(
    regression: Regression, terms: Terms, forms: Sequence[Candidate]
) -> tuple[Candidate | None, float]:
    """The form that explains most beside the terms, and its likelihood ratio; one of several terms
    pays for the coefficients that a step does not have, a curve for its form (Akaike)."""
    if not forms:
        return None, 0.0
    gains = regression.gains(terms, [f.terms for f in forms]).sum(axis=1)
    gains = gains - [(2.0 if f.is_free else 6.0) * (len(f.terms) - 1) for f in forms]
    return forms[int(gains.argmax())], float(gains.max())


def column(regression: Regression, step: Step) -> list[np.ndarray]:
    """(n,) 0 before and 1 after it in its session, 0 in the others."""
    out = [np.zeros(s.blocks) for s in regression.sessions]
    at = np.array([step.block - step.share])
    out[step.session] = heavisides(regression.sessions[step.session], at)[:, 0]
    return out


def _all(regression: Regression, terms: Terms, recordings: int = 1) -> list[Step]:
    """Abrupt steps that stand beside each other; the regression is left as it was."""
    kept = regression.events()
    steps = standing(regression, terms, recordings, kept)
    seen = [s for s in steps if not _is_unseen(regression.sessions[s.session], s.block)]
    abrupt = [s for s in seen if _is_no_ramp(regression, terms, steps, s, kept)]
    _set(regression, [], kept)
    return abrupt


def standing(regression: Regression, terms: Terms, recordings: int, kept: Events) -> list[Step]:
    """Steps that stand beside each other, abrupt or not; the regression is left with them."""
    most = MOST_PER_SESSION * len(regression.sessions)
    steps: list[Step] = []
    while len(steps) < most:
        step, _ = _best(regression, terms)
        if step is None:
            break
        step.ratio = _gain(regression, terms, steps, step, kept)
        if chi2.sf(step.ratio, 3) * _tried(regression) * recordings > _level(len(steps)):
            break
        steps.append(step)
        _set(regression, steps, kept)
    while steps and not _stand(regression, terms, steps, kept, recordings):
        steps.remove(min(steps, key=lambda s: s.ratio))
        _set(regression, steps, kept)
    return _sized(regression, terms, steps, kept)


def _set(regression: Regression, steps: list[Step], kept: Events | None) -> None:
    regression.set_events([column(regression, s) for s in steps], kept)


def _gain(
    regression: Regression, terms: Terms, others: list[Step], step: Step, kept: Events
) -> float:
    """The likelihood ratio of a step beside others, the noise's colour refitted with it: without
    it, noise that walks takes most of it for its own."""
    _set(regression, [*others, step], kept)
    total = regression.fit(terms).total
    _set(regression, others, kept)
    return float(2.0 * (total - regression.fit(terms).total))


def _stand(
    regression: Regression, terms: Terms, steps: list[Step], kept: Events, recordings: int
) -> bool:
    """Whether each is beyond what the places away from all of them show; ratios are renewed."""
    away = _away(steps, _best(regression, terms)[1])
    for step in steps:
        others = [s for s in steps if s is not step]
        step.ratio = _gain(regression, terms, others, step, kept)
        p_value = _survival(step.ratio, away) * _tried(regression) * recordings
        step.p_value = min(1.0, p_value)
    _set(regression, steps, kept)
    return all(p < _level(k) for k, p in enumerate(sorted(s.p_value for s in steps)))


def _level(steps: int) -> float:
    """The level of one more step beside so many: recordings with several are the rarer."""
    return LEVEL["generic" if steps else "step"]


def _tried(regression: Regression) -> int:
    return sum(map(tried, regression.sessions))


def _best(regression: Regression, terms: Terms) -> tuple[Step | None, Ratios]:
    """The step that explains most, and (session, places, ratios) of every session."""
    place, every = best_place(regression, terms)
    if place is None:
        return None, every
    block = int(np.ceil(place.at))
    return Step(place.session, block, np.zeros(3), place.ratio, 1.0, share=block - place.at), every


def _away(steps: list[Step], every: Ratios) -> np.ndarray:
    """Ratios at the places away from every step."""
    out = []
    for s, at, ratios in every:
        near = [np.abs(at - step.block) <= 2 * LONGEST for step in steps if step.session == s]
        out.append(ratios[~np.any(near, axis=0)] if near else ratios)
    return np.concatenate(out) if out else np.zeros(0)


def _survival(ratio: float, away: np.ndarray, axes: int = 3) -> float:
    """Chance of a ratio at one place, by those away from all steps.

    On real noise they have a higher mean and a longer tail than chi-squared: a gamma distribution
    of mean and variance takes its place where that is longer. Neighbours are much alike, so that
    what theory knows counts for as much as all of them.
    """
    if len(away) < LONGEST:
        return float(chi2.sf(ratio, axes))
    mean, variance = np.mean([(axes, 2 * axes), (away.mean(), away.var())], axis=0)
    by_theory, by_places = chi2.sf(ratio, axes), NullRatios.of(mean, variance, axes).survival(ratio)
    return max(float(by_theory), by_places)


def _sized(regression: Regression, terms: Terms, steps: list[Step], kept: Events) -> list[Step]:
    """The steps with their sizes, fitted together, and standard deviations."""
    before = regression.events()
    regression.set_events([column(regression, s) for s in steps], kept)
    base, own = regression.fit(terms).base, slice(-len(steps), None)
    values = base.fitted[:, own]
    spread = [np.diag(i)[own] * v for i, v in zip(base.unscaled, base.variance)]
    back = np.linalg.inv(regression.axes)
    sizes, variances = (back @ values).T, ((back**2) @ np.array(spread)).T
    for step, size, variance in zip(steps, sizes, variances):
        step.size_dps, step.deviation_dps = size, np.sqrt(np.maximum(variance, 0.0))
        session = regression.sessions[step.session]
        step.at_s = (step.block - step.share) * session.block_s
    regression.set_events([], before)
    return steps


def _is_no_ramp(
    regression: Regression, terms: Terms, steps: list[Step], step: Step, kept: Events
) -> bool:
    """Whether no ramp explains clearly more than the step, where those near it are taken out: a
    slow loop looks like a ramp or like a few small steps."""
    far = [s for s in steps if s.session != step.session or abs(s.block - step.block) > LONGEST]
    _set(regression, far, kept)
    beyond = beyond_ramps(regression, terms, step.session, step.block - step.share)
    return beyond > -2 * NATS


def _is_unseen(session: Session, block: int) -> bool:
    """Whether the device did not rest around the place for so long, and at such temperatures, that
    the bias may have drifted there: along a slow loop, for one."""
    there = np.flatnonzero(session.available)
    at = int(np.searchsorted(there, block))
    if not 0 < at < len(there):
        return False
    first, last = int(there[at - 1]), int(there[at])
    if last - first <= NEAR:
        return False
    temp = session.sources.get("temp")
    return temp is None or np.ptp(session.block_mean(temp)[first : last + 1]) > SMALLEST["temp"]
