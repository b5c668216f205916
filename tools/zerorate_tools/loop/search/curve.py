"""The curve over temperature of one recording: smooth, with a bend in every free slot, or a kink.

How smooth it is, the recording says (`fit/smooth.py`). It has a slope of its own, in the place of
the firmware's curve, which is made of bins. Both follow a walk of the noise alike, so pieces left
out decide between them, by the firmware's own kernels.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...model.model import MOST_SLOTS
from ...model.term import Term, Terms
from ..fit.common_cause import RARE
from ..fit.line import less_slope
from ..fit.regression import Regression
from ..fit.single import LEAST_OF_A_PIECE, PIECES, PiecesByLine
from ..fit.smooth import curve_of
from ..read.sessions import Session
from .catalogue import Candidate, beyond, ranges, varies
from .decide import Decision, family_p
from .examine import cancels
from .hysteresis import MEMORIES, is_like_hysteresis
from .refine import refined
from .selection import Found, fits_in_slots

KIND, _KINK = "temperature-curve", "temperature-kink"
#: Powers, of which the curve takes the place; and all forms of a curve.
_POWERS = ("temperature-quadratic", "temperature-cubic")
FORMS = (*_POWERS, _KINK)


def shows_a_curve(session: Session) -> bool:
    """Whether there are enough rests to tell by pieces left out."""
    return bool(session.available.sum() >= PIECES * LEAST_OF_A_PIECE)


def powers(pool: Iterable[Candidate]) -> tuple[Term, ...]:
    """A parabola and a cubic, of a pool: beside the one the other is the same about any centre."""
    first = {t.power: t for c in pool if c.kind in _POWERS for t in c.terms}
    return tuple(first.values())


def smooth_curve(sessions: list[Session], line: Terms, taken: int) -> list[Candidate]:
    """One with a bend in every slot that is not taken; none without temperature, or slots.

    line: over temperature, or nothing.
    """
    if not line:
        return []
    lo, hi, _ = ranges(sessions)["temp"]
    ends = beyond(lo, hi, "temp")
    slope = replace(line[0], lo=ends[0], hi=ends[1])
    bends = max(MOST_SLOTS - 1 - taken, 0)
    at = np.linspace(lo, hi, bends + 2)[1:-1] - slope.centre
    terms = slope, *(replace(slope, knot=float(knot)) for knot in at)
    return [Candidate(KIND, terms, "catalogue")] if curve_of(terms) else []


@dataclass
class ByPieces:
    """What pieces of one recording tell where the likelihood cannot: its noise walks, too.

    line: over temperature; pool: candidates; judged: by the firmware's kernels; taken: slots that
    motion needs.
    """

    regression: Regression
    line: Terms
    pool: Sequence[Candidate]
    judged: PiecesByLine
    taken: int

    def look(self, found: list[Found]) -> list[Found]:
        """What was found, with a curve and with what remembers temperature, each if pieces speak
        for it: first what gains more. The curve gets every slot that is free in the end."""
        out, ways = list(found), [self._curve, self._memory]
        while ways:
            told = [(f, way) for way in ways for f in way(out, len(ways) - 1)]
            if not told:
                break
            best, way = max(told, key=lambda pair: _gained(pair[0]))
            out.append(best)
            ways.remove(way)
        smooth = [f for f in out if f.candidate.kind == KIND]
        others = [f for f in out if f not in smooth]
        return [*others, *(self._curve(others)[:1] if smooth else [])]

    def _curve(self, found: list[Found], kept: int = 0) -> list[Found]:
        """The smooth curve and the best kink, if likely; where temperature hardly varies there is
        no bend to be likely, but a better line than the firmware's. kept: slots left free."""
        if not self.line:
            return []
        beside, sessions = _terms(found), self.regression.sessions
        smooth = smooth_curve(sessions, self.line, self.taken + len(beside) + kept)
        every = [*smooth, *self._kink(beside)]
        told = [self._judged(c, beside, c.terms[1:] or c.terms, 1) for c in every]
        most = RARE if varies("temp", sessions) else 1.0
        told = [f for f in told if f.decision.accepted and f.decision.p_value <= most]
        return sorted(told, key=_gained, reverse=True)

    def _memory(self, found: list[Found], kept: int = 0) -> list[Found]:
        """The lag, rate or start that predicts best, if it is likely and one course of temperature
        tells it from a hysteresis."""
        own, beside = [c for c in self.pool if c.kind in MEMORIES], _terms(found)
        straight, sessions = less_slope(self.line, beside), self.regression.sessions
        best = self._best(own, straight, beside)
        if best is None or not fits_in_slots([*beside, *best.terms], self.taken):
            return []
        best = refined(self.regression, [*straight, *beside], best)
        told = self._judged(best, beside, best.terms, len(own))
        if not told.decision.accepted or told.decision.p_value > RARE:
            return []
        alike = is_like_hysteresis(straight, beside, best, self.pool, sessions)
        return [] if alike or cancels(sessions, [*straight, *beside], best.terms) else [told]

    def _kink(self, beside: Terms) -> list[Candidate]:
        """The best by least squares, refined by the likelihood. Its slope is followed beyond the
        last temperature no further than it was seen."""
        sessions = self.regression.sessions
        best = self._best([c for c in self.pool if c.kind == _KINK], self.line, beside)
        if best is None:
            return []
        best = refined(self.regression, [*self.line, *beside], best)
        [term], (_, last, _) = best.terms, ranges(sessions)["temp"]
        seen = last - term.centre - (term.knot or 0.0)
        return [replace(best, terms=(replace(term, hi=min(term.hi, last + seen)),))]

    def _best(self, some: Sequence[Candidate], straight: Terms, beside: Terms) -> Candidate | None:
        [session] = self.regression.sessions
        by_line = PiecesByLine(session)
        gains = [float(by_line(straight, beside, c.terms).sum()) for c in some]
        return some[int(np.argmax(gains))] if gains else None

    def _judged(self, c: Candidate, beside: Terms, bends: Terms, tried: int) -> Found:
        straight = less_slope(self.line, beside)
        ratio = float(self.regression.gains([*straight, *beside], [tuple(bends)]).sum())
        p = family_p(ratio, 3 * len(bends), tried)
        likely = Decision(True, p, ratio)
        return Found(c, likely.on_pieces(self.judged.by_passes(), straight, beside, c.terms))


def _terms(found: list[Found]) -> list[Term]:
    return [t for f in found for t in f.candidate.terms]


def _gained(found: Found) -> float:
    return float(found.decision.session_gains.sum())
