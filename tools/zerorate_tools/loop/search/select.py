"""Find an effect, add it, look again: until nothing passes."""

from dataclasses import replace
from functools import cached_property

import numpy as np

from ...model.term import Term, Terms
from ..fit.common_cause import RARE, coherence, turned_axes
from ..fit.line import less_slope
from ..fit.regression import Regression
from ..fit.shrunk import evidence, has_play_operators
from ..fit.single import PiecesByLine
from ..read.sessions import Session
from . import curve, hysteresis
from .catalogue import Candidate, ranges
from .catalogue import candidates as all_candidates
from .examine import Examiner
from .multiple_testing import MultipleTesting, smallest_dps
from .naming import name_found
from .refine import drawn, refined
from .selection import Found, Selection, fits_in_slots

#: Beside which there is no bend.
_BENDS = ("temperature-quadratic", curve.KIND)


def straight_line(sessions: list[Session]) -> tuple[Term, ...]:
    """What the firmware's estimators take anyway: the line over temperature, never clamped."""
    span = ranges(sessions).get("temp")
    return (Term("temp", centre=span[2]),) if span and span[0] < span[1] else ()


class Search:
    """The state of one search over some sessions."""

    def __init__(
        self,
        sessions: list[Session],
        taken: int = 0,
        on_pieces: PiecesByLine | None = None,
        judged_again: bool = False,
    ):
        self.taken, self.judged_again = taken, judged_again
        self.regression = Regression(sessions)
        self.on_pieces = on_pieces
        self.line = straight_line(sessions)
        self.own_bend = tuple(replace(t, power=2) for t in self.line)
        self.found: list[Found] = []
        self.pool = all_candidates(sessions)
        self.refused: list[tuple[str, str]] = []
        self.dropped: set[str] = set()
        self.kept = 0
        self.forms: list[Candidate] = []

    @cached_property
    def testing(self) -> MultipleTesting:
        """What each candidate must reach, beside the bend that one recording may have shown."""
        return MultipleTesting(self.regression, self.pool, self.straight, self.bend)

    @cached_property
    def examiner(self) -> Examiner:
        """Whom every candidate has to pass."""
        return Examiner(self.testing, self.on_pieces)

    @property
    def straight(self) -> tuple[Term, ...]:
        """The line, unless a slope found has its place."""
        return less_slope(self.line, self.terms())

    @property
    def bend(self) -> tuple[Term, ...]:
        """The bend beside the line, unless a curve found has its place."""
        return less_slope(self.own_bend, self.terms())

    def terms(self, leave: int | None = None) -> list[Term]:
        return [t for i, f in enumerate(self.found) if i != leave for t in f.candidate.terms]

    def _beside_bend(self) -> list[Term]:
        return [*self.straight, *self.bend, *self.terms()]

    def run(self) -> Selection:
        if self.on_pieces:
            self._begin_with_one(self.on_pieces)
        while self._add_one():
            self._drop_idle()
        if self.on_pieces:
            self._by_pieces(self.on_pieces)
        else:
            self._widen_hysteresis()
        named = [c for c in self.pool if c.kind != curve.KIND]
        name_found(self.regression, self.straight, self.found, named, self.kept, self._passes)
        if (hysteresis.KIND, hysteresis.AS_WELL) in self.refused:
            for f in self.found:
                if f.candidate.kind in hysteresis.SIMPLER:
                    f.rivals[hysteresis.KIND] = 0.0
        r = self.regression
        smallest = self._smallest()
        return Selection(
            self.found,
            self.refused,
            r.outliers,
            r,
            self.line,
            self.own_bend,
            self.pool,
            smallest,
            bool(self.on_pieces),
            judged_again=self.judged_again,
        )

    def _smallest(self) -> dict[str, float]:
        r, needed, beside = self.regression, self.testing.needed, [*self.straight, *self.terms()]
        every = [*self.pool, *self.forms]
        bent = [c for c in every if c.kind != "temperature-quadratic"]
        quadratic = [c for c in every if c.kind == "temperature-quadratic"]
        with r.in_sensor_axes():
            smallest = smallest_dps(r, beside, quadratic, needed)
            return {**smallest, **smallest_dps(r, self._beside_bend(), bent, needed)}

    def _begin_with_one(self, judged: PiecesByLine) -> None:
        """The hysteresis that one course of temperature shows, else a curve as a candidate."""
        r, every = self.regression, self.pool
        if not self.judged_again:
            # what follows time alone must come again: only another power-on shows whether it does
            every = [c for c in every if not c.follows_time]
        self.pool = [c for c in every if c.kind not in curve.FORMS]
        if not curve.shows_a_curve(r.sessions[0]):
            self.refused.append((curve.KIND, "too few rests to tell by pieces left out"))
            return
        self.forms, bend = [c for c in every if c.kind in curve.FORMS], curve.powers(every)
        if self.judged_again:
            found, refused = hysteresis.of_a_pair(r, self.line, bend, every, self.taken)
        else:
            asked = self.line, bend, every, judged, self.taken
            found, refused = hysteresis.of_one_recording(r, *asked)
        if found:
            self.found, self.kept = [found], 1
        else:
            self.pool += curve.smooth_curve(r.sessions, self.line, self.taken)
        self.refused += [(hysteresis.KIND, refused)] if refused else []

    def _by_pieces(self, judged: PiecesByLine) -> None:
        """What pieces left out tell of temperature, in the place of a curve that was found."""
        enough = curve.shows_a_curve(self.regression.sessions[0])
        if enough and not has_play_operators(self.terms()):
            others = [f for f in self.found if f.candidate.kind != curve.KIND]
            own = [*self.pool, *self.forms], judged, self.taken
            self.found = curve.ByPieces(self.regression, self.line, *own).look(others)

    def _widen_hysteresis(self) -> None:
        """A sum of play operators in place of what was found to remember temperature, or to follow
        the start of a power-on, where it is likelier."""
        own = [f for f in self.found if f.candidate.kind in hysteresis.LIKE_IT]
        if not own:
            return
        before, self.found = self.found, [f for f in self.found if f not in own]
        simpler = [t for f in own for t in f.candidate.terms]
        beside = [*self.straight, *self.terms()]
        candidate, gain = hysteresis.likeliest(self.regression, beside)
        lost = evidence(self.regression, beside, simpler) - gain
        found = None
        if candidate and lost < 0:
            if fits_in_slots([*self.terms(), *candidate.terms], self.taken):
                found = Found(candidate, own[0].decision, {f.candidate.kind: lost for f in own})
        self.found = [*self.found, found] if found else before
        if candidate and not found:
            for f in own:
                f.rivals[hysteresis.KIND] = -lost

    def _look_afresh(self) -> None:
        r = self.regression
        r.turn(np.eye(3))
        nuisances = self._beside_bend()
        r.settle(nuisances)
        if coherence(r, nuisances)[0] < RARE:
            r.turn(turned_axes(r, nuisances))
            r.settle(nuisances)

    def _nuisances(self, candidate: Candidate) -> list[Term]:
        bend = () if candidate.kind in _BENDS else self.bend
        return [*self.straight, *bend, *self.terms()]

    def _ratios(self) -> tuple[np.ndarray, np.ndarray]:
        """Ratios beside the straight line (for choosing) and beside the bend too (for testing)."""
        r, groups = self.regression, [c.terms for c in self.pool]
        choose = r.gains([*self.straight, *self.terms()], groups).sum(axis=1)
        test = r.gains(self._beside_bend(), groups).sum(axis=1)
        test = np.where([c.kind in _BENDS for c in self.pool], choose, test)
        return choose, test

    def _add_one(self) -> bool:
        self._look_afresh()
        accepted = self._best_candidate()
        self.found += [accepted] if accepted else []
        return accepted is not None

    def _best_candidate(self) -> Found | None:
        choose, test = self._ratios()
        dof = np.array([3 * len(c.terms) for c in self.pool])
        need = np.array([self.testing.least_ratio(c) for c in self.pool])
        passing = np.flatnonzero(test > need)
        passing = passing[np.argsort(-(choose - 2.0 * dof)[passing])]
        kinds: list[str] = []
        for i in passing:
            c = self.pool[i]
            if (
                c.kind in kinds
                or c.label in self.dropped
                or not fits_in_slots([*self.terms(), *c.slots], self.taken)
            ):
                continue
            kinds.append(c.kind)
            found = self._beside_outliers(c)
            if found:
                return found
        return None

    def _beside_outliers(self, c: Candidate) -> Found | None:
        """As `_consider`, but a block that the candidate explains is no outlier."""
        if not self.regression.outliers:
            return self._consider(c)
        nuisances = self._nuisances(c)
        self.regression.settle([*nuisances, *c.terms])
        found = self._consider(c)
        if not found:
            self.regression.settle(self._beside_bend())
        return found

    def _consider(self, c: Candidate) -> Found | None:
        said = self.examiner.examine(c, self.straight, self.terms(), self._nuisances(c))
        if isinstance(said, Found):
            return said
        self.refused.append(said)
        return None

    def _passes(self, c: Candidate, others: Terms) -> bool:
        """Whether a candidate, its parameters refined, would be found beside other effects."""
        straight = less_slope(self.line, [*others, *c.terms])
        if not fits_in_slots([*others, *c.slots], self.taken):
            return False
        bend = () if c.kind in _BENDS else less_slope(self.own_bend, others)
        return self.examiner.accepts(c, straight, others, [*straight, *bend, *others])

    def _drop_idle(self) -> None:
        """An effect that the later ones explain is taken out again; the others' parameters are
        refined together.
        """
        latest = len(self.found) - 1
        for i in reversed(range(self.kept, len(self.found))):
            c = self.found[i].candidate
            rest = [*self.straight, *self.terms(leave=i)]
            if i < latest and self.examiner.is_idle(c, rest):
                self.refused.append((c.label, "explained by effects found later"))
                self.dropped.add(c.label)
                del self.found[i]
            else:
                self.found[i].candidate = drawn(
                    self.regression, rest, refined(self.regression, rest, c)
                )


def select(
    sessions: list[Session],
    taken: int = 0,
    on_pieces: PiecesByLine | None = None,
    judged_again: bool = False,
) -> Selection:
    """Everything that the training sessions show, as far as the firmware has room for it.

    taken: slots that what was found in motion needs; on_pieces: what judges effects of a session
    that stands alone by pieces of it left out; judged_again: whether another session, held out,
    has the last word.
    """
    return Search(sessions, taken, on_pieces, judged_again).run()
