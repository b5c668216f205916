"""One candidate, examined beside what was found: whatever speaks against taking it."""

from collections.abc import Collection, Sequence
from dataclasses import replace

import numpy as np
from scipy.linalg import null_space

from ...model.term import Term, Terms
from ..fit.line import less_slope, ordinary
from ..fit.regression import Regression, predicted
from ..fit.single import PiecesByLine
from ..read.sessions import Session
from .catalogue import Candidate
from .decide import LEVEL, Decision, decide, family_p
from .hysteresis import KIND, is_like_hysteresis, may_show
from .multiple_testing import MultipleTesting
from .refine import drawn, refined
from .selection import Found

#: Of the error without it that an effect may be. Lags of real parts are 0.6 times; what tells a
#: start's decay from a warm-up by cancelling both is 6 times and more.
_MOST_TIMES = 2.0


class Examiner:
    """Of all candidates of one search.

    testing: what each must reach; judged: what judges effects of a session that stands alone by
    pieces of it left out.
    """

    def __init__(self, testing: MultipleTesting, judged: PiecesByLine | None) -> None:
        self.testing, self.judged = testing, judged
        self.regression, self.pool = testing.regression, testing.pool
        self.singles = [c.terms[0] for c in self.pool if len(c.terms) == 1]

    def examine(
        self, candidate: Candidate, straight: Terms, found: Terms, nuisances: Terms
    ) -> Found | tuple[str, str]:
        """The effect where its parameters fit best; or its label, and why it is refused.

        straight, found: the line and the effects, which are deployed beside it; nuisances: these,
        and the bend beside which it is tested.
        """
        best = refined(self.regression, [*straight, *found], candidate)
        told = drawn(self.regression, [*straight, *found], best)
        decision = self._decision(best, told, straight, found, nuisances)
        return Found(told, decision) if decision.accepted else (best.label, decision.reason)

    def accepts(self, told: Candidate, straight: Terms, found: Terms, nuisances: Terms) -> bool:
        """Whether an effect passes whose parameters are refined, its curve drawn, already."""
        return self._decision(told, told, straight, found, nuisances).accepted

    def is_idle(self, c: Candidate, rest: Terms) -> bool:
        """Whether the rest of the terms explain what an effect was taken for."""
        return float(self.regression.gains(rest, [c.terms]).sum()) < self.testing.least_ratio(c)

    def _decision(
        self, best: Candidate, told: Candidate, straight: Terms, found: Terms, nuisances: Terms
    ) -> Decision:
        """By the likelihood, and by pieces left out. told: the candidate with its curve drawn."""
        decision = self._by_likelihood(best, nuisances)
        if decision.accepted and self.judged:
            return self._by_pieces(decision, self.judged, told, straight, found)
        return decision

    def _by_likelihood(self, best: Candidate, nuisances: Terms) -> Decision:
        r, tried = self.regression, self.testing.tried(best)
        ratio = float(r.gains(nuisances, [best.terms]).sum())
        decision = decide(r, nuisances, best, ratio, tried, self.singles)
        if decision.accepted and is_rounding(r, nuisances, best, tried):
            reason = "the thermometer's coarse readings explain as much"
            return replace(decision, accepted=False, reason=reason)
        return decision

    def _by_pieces(
        self,
        decision: Decision,
        judged: PiecesByLine,
        best: Candidate,
        straight: Terms,
        found: Terms,
    ) -> Decision:
        sessions, beside = self.regression.sessions, (straight, found)
        reason = ""
        if cancels(sessions, [*less_slope(straight, best.terms), *found], best.terms):
            reason = "it would only cancel another"
        elif best.kind == KIND and not may_show(sessions):
            reason = "the temperature never turned back"
        elif is_like_hysteresis(*beside, best, self.pool, sessions):
            reason = "a hysteresis predicts as well"
        if reason:
            return replace(decision, accepted=False, reason=reason)
        return decision.on_pieces(judged, *beside, best.terms)


def is_rounding(r: Regression, nuisances: Terms, candidate: Candidate, tried: float) -> bool:
    """Whether an effect of temperature or time may be what a coarse thermometer makes of the slope:
    temperatures that are off by one reading at most explain it on the axis that the slope moves,
    and nothing is left on the others.

    Readings that are off flatten a slope, and what has the course of temperature takes the rest.
    """
    terms = candidate.terms
    line = [t for t in nuisances[:1] if t == Term("temp", centre=t.centre)]
    steps = [s.temp_step_degc for s in r.sessions]
    if not any(steps) or not line or {*candidate.sources} - {"temp", "time"}:
        return False
    with r.in_sensor_axes():
        fitted = r.fit([*nuisances, *terms]).coefficients
    own = np.vstack([fitted[:1], fitted[len(nuisances) :]])
    added, degc = (
        np.vstack([s.less_offsets(of(s), s.available)[s.available] for s in r.sessions])
        for of in (
            lambda s: predicted([*line, *terms], own, s),
            lambda s: s.block_mean(s.source("temp"))[:, None],
        )
    )
    slope = (degc.T @ added / (degc.T @ degc))[0]
    off_degc = (added - degc * slope) @ slope / (slope @ slope)
    if np.abs(off_degc).max() > max(steps):
        return False
    with r.along(np.vstack([slope, null_space(slope[None]).T])):
        ratio = float(r.gains(nuisances, [terms])[0, 1:].sum())
    return family_p(ratio, 2 * len(terms), tried) > LEVEL[candidate.family]


def cancels(sessions: Sequence[Session], beside: Terms, terms: Terms) -> bool:
    """Whether terms are far larger than the error that they explain: then they only stand against
    others, as a start's decay against a warm-up, and not at another power-on."""
    without = _squares(sessions, beside, ordinary(beside, sessions) if beside else (), True)
    fitted = ordinary([*beside, *terms], sessions)[len(beside) :]
    return _squares(sessions, terms, fitted, False) > _MOST_TIMES**2 * without


def _squares(
    sessions: Sequence[Session], terms: Terms, coefficients: Collection[np.ndarray], left: bool
) -> float:
    """Of what terms add to the bias, or leave of it, offsets aside, in all."""
    total = 0.0
    for s in sessions:
        added = predicted(terms, coefficients, s)
        values = s.rate_dps - added if left else added
        total += float((s.less_offsets(values, s.available)[s.available] ** 2).sum())
    return total
