"""What one recording alone tells by pieces of it left out, before the likelihood is asked."""

from collections.abc import Sequence
from dataclasses import dataclass, field

from ...model.term import Term
from ..fit.line import less_slope
from ..fit.regression import Regression
from ..fit.single import LEAST_OF_A_PIECE, PIECES, PiecesByLine
from . import cross_validation, hysteresis
from .bends import JudgedOnPieces, find_bends
from .catalogue import Candidate
from .likely_hysteresis import of_a_pair
from .selection import Found

#: Blocks at rest below which bends are not looked for.
_LEAST_BLOCKS = PIECES * LEAST_OF_A_PIECE


@dataclass
class OneRecording:
    """A bend over temperature, what remembers temperature, or a line of many segments.

    line: over temperature; judged: what an effect gains on pieces left out, by the firmware's
    kernels; taken: slots that motion needs; judged_again: whether another session, held out, has
    the last word; found, refused: filled by `look`.
    """

    regression: Regression
    line: tuple[Term, ...]
    pool: list[Candidate]
    judged: JudgedOnPieces
    taken: int
    judged_again: bool
    found: list[Found] = field(default_factory=list)
    refused: list[tuple[str, str]] = field(default_factory=list)

    def look(self) -> None:
        """Find what pieces left out speak for."""
        if self.regression.sessions[0].available.sum() < _LEAST_BLOCKS:
            self.refused.append(("temperature-curve", "too few rests to tell by pieces left out"))
            return
        bends = find_bends(self.regression, self.judged, self.line, self.pool)
        self.found = [Found(c, d) for c, d in bends.found]
        self.refused += bends.refused
        self._look_for_hysteresis(bends.curve)
        if not any(t.memory == "play" for t in self._terms()):
            self._by_pieces_alone(bends.curve)

    def _terms(self) -> list[Term]:
        return [t for f in self.found for t in f.candidate.terms]

    def _look_for_hysteresis(self, curve: tuple[Term, ...]):
        """A sum of play operators with the bend found, or with a whole curve, as one effect."""
        terms, taken = self._terms(), self.taken
        beside = [tuple(terms), *([curve] if curve else [])]
        straight = less_slope(self.line, terms)
        if self.judged_again:
            found, refused = of_a_pair(self.regression, straight, terms, self.pool, taken)
        else:
            found, refused = hysteresis.of_one_recording(
                self.regression, straight, beside, self.pool, self.judged, taken
            )
        self.found = [found] if found else self.found
        self.refused += [(hysteresis.KIND, refused)] if refused else []

    def _by_pieces_alone(self, curve: tuple[Term, ...]):
        """What the likelihood may not tell from a walk of the noise, but pieces left out do."""
        by_line = PiecesByLine(self.regression.sessions[0])
        judged = self.judged, by_line, self.taken
        better = cross_validation.polynomial(self.regression, self.line, self.found, *judged)
        self.found = [better] if better else self.found
        self._remember(by_line)
        # where another power-on has the last word, it has less to choose from
        alone = not self.judged_again
        better = cross_validation.whole_curve(
            self.regression, self.line, self.found, *judged, alone
        )
        if better:
            self._bend_often(better, curve, by_line)

    def _bend_often(self, better: Found, curve: Sequence[Term], by_line: PiecesByLine):
        """A line of many segments, unless what remembers temperature predicts as well: warming up
        once, both are much alike, and at another power-on they part. Then that is taken, or where
        it is not clear the line, if it is clear itself."""
        nats = float(by_line(self.line, (), better.candidate.terms).sum())
        other = cross_validation.remembering(self.line, curve, self.pool, by_line)
        if other is None or other.nats < nats - hysteresis.TIES_NATS:
            self.found = [better]
            self._remember(by_line)
            return
        found: list[Found] = []
        if not other.doubtful:
            judged = self.judged, by_line, self.taken
            beside = self.regression, self.line, self.found, other
            found = cross_validation.of_memory(*beside, self.pool, *judged)
        if not found and self._is_clear(better, other.doubtful):
            better.confounded_with = [other.memory.kind]
            found = [better]
        self.found = found or self.found
        if better not in self.found:
            said = "what remembers temperature predicts as well"
            self.refused.append((cross_validation.SEGMENTS, said))

    def _is_clear(self, better: Found, doubtful: bool) -> bool:
        """Whether a line is as clear as what remembers has to be, or one of segments leaves less
        than what was found, if none of that remembers."""
        if not doubtful and cross_validation.is_clear_memory(self.regression, better.decision):
            return True
        if self.judged_again or any(
            f.candidate.kind in cross_validation.MEMORIES for f in self.found
        ):
            return False
        terms, gain = better.candidate.terms, better.decision.session_gains
        segments = better.candidate.kind == cross_validation.SEGMENTS
        less = cross_validation.leaves_less(self.judged, self.line, self._terms(), terms, gain)
        return segments and less

    def _remember(self, by_line: PiecesByLine):
        own = cross_validation.memory(
            self.regression, self.line, self.found, self.pool, self.judged, by_line, self.taken
        )
        self.found += [own] if own else []
