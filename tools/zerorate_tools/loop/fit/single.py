"""One recording alone: short pieces of it, interleaved over its whole course, are left out in turn.

What remembers needs the whole course of its input, so that is always there: only the rates of a
piece are left out, with a gap on either side. Weaker than whole power-ons: there is one turn-on
offset and one course of temperature, and a slow cause outlasts any gap.
"""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from dataclasses import replace
from functools import partial

import numpy as np
from scipy.ndimage import binary_dilation

from ...model.effects import is_free
from ...model.term import Term, Terms, play
from ..read.sessions import Session
from .line import by_axis, ordinary, with_line
from .regression import Regression, predicted
from .shrunk import has_play_operators
from .smooth import draw

#: Pieces, and the turns in which they are left out: each turn has pieces far apart.
PIECES, FOLDS = 20, 10
#: Blocks of a piece, at least.
LEAST_OF_A_PIECE = 3
#: Shares of the range of temperature by which it turns back in another pass, and moves in a hold.
_TURNS_BACK, _HOLD = 0.25, 0.05
WEAKER = (
    f"One recording only: it was cut into {PIECES} pieces, which were left out in {FOLDS} turns. "
    "Each was judged by a model fitted to the others. The same pieces chose the effects, so the "
    "error after is a little too low. One recording does not show whether an effect repeats at the "
    "next power-on, so no effect at rest is confirmed before a second one."
)
#: Said beside it where the recording has steps.
STEPS_CHOSEN = (
    " Whether every stretch between two steps has an offset of its own is chosen by these pieces, "
    "too."
)


def fold_of(session: Session) -> np.ndarray:
    """(n,) the turn in which each block is left out; one without a rate goes with its neighbour.

    Pieces are even in time and in the way of temperature taken together, so that where it runs
    fast a piece is short, and what is left out of it little.
    """
    there = np.flatnonzero(session.available)
    pieces = pieces_of(len(there))
    way = np.minimum(_way(session, there), len(there) / (pieces * LEAST_OF_A_PIECE))
    piece = np.floor((np.cumsum(way) - way / 2) / way.sum() * pieces).astype(int)
    ends = there[np.flatnonzero(np.diff(piece))]
    each = piece[np.r_[np.flatnonzero(np.diff(piece)), len(piece) - 1]]
    return each[np.searchsorted(ends, np.arange(session.blocks))] % min(FOLDS, pieces)


def pieces_of(blocks: int) -> int:
    """Into how many pieces so many blocks with a rate are cut."""
    return min(PIECES, max(1, blocks // LEAST_OF_A_PIECE))


def pass_of(session: Session) -> np.ndarray:
    """(n,) which pass of the temperature each block is of. A hold belongs to the pass before it."""
    degc = session.block_mean(session.source("temp"))
    span = float(np.ptp(degc))
    way = np.sign(np.diff(play(degc, _TURNS_BACK * span)))
    moves = np.flatnonzero(way)
    ends = []
    for last, back in zip(moves, moves[1:]):
        if way[last] != way[back]:
            hold = np.abs(degc[last + 1 : back + 1] - degc[last + 1]) < _HOLD * span
            ends.append(last + 1 + np.flatnonzero(hold)[-1])
    return np.searchsorted(ends, np.arange(len(degc)))


def _way(session: Session, there: np.ndarray) -> np.ndarray:
    """(blocks,) of mean 1: by how much time and temperature go on with each block."""
    if "temp" not in session.sources:
        return np.ones(len(there))
    moved = np.abs(np.gradient(session.block_mean(session.sources["temp"])[there]))
    return 0.5 + 0.5 * moved / max(moved.mean(), 1e-12)


class PiecesByLine:
    """Judges effects of one recording by how well its pieces are predicted from the others.

    Ordinary least squares with one offset for all pieces, as they are of one power-on, beside a
    straight line; for recordings that the firmware's own kernels cannot be run over. beside: other
    recordings of the device, to which every turn is fitted as well; hold: whether a bend is held at
    the edges of what a turn is fitted to.
    """

    reason = "does not predict the pieces left out"

    def __init__(
        self,
        session: Session,
        beside: Sequence[Session] = (),
        hold: bool = True,
    ) -> None:
        self.session, self.beside, self.hold = session, beside, hold
        self._leave_out(fold_of(session))

    def by_passes(self) -> PiecesByLine:
        """The same with whole passes of the temperature left out in turn, where it passes twice.

        A walk of the noise goes on from a piece to its neighbours, and a curve that follows it
        predicts them, but no other pass of the same temperatures.
        """
        passes = pass_of(self.session) if "temp" in self.session.sources else np.zeros(1, int)
        if not passes.any():
            return self
        other = copy(self)
        other._leave_out(passes)
        return other

    def _leave_out(self, fold: np.ndarray) -> None:
        self.fold = fold
        self._known: dict[tuple[tuple[Term, ...], bytes | None], np.ndarray] = {}
        left = [fold == k for k in range(fold.max() + 1)]
        # a block at either side of a piece is neither fitted nor judged in its turn
        self.parts = [_only(self.session, ~binary_dilation(one)) for one in left]

    def __call__(self, straight: Terms, found: Terms, candidate: Terms) -> np.ndarray:
        """(folds,) nats by which each turn's pieces are better predicted with the candidate."""
        before, after = (
            self._squares(self.residual(straight, terms)) for terms in (found, [*found, *candidate])
        )
        counted = np.bincount(self.fold[self.session.available], minlength=len(self.parts))
        return nats(before, after, counted)

    def residual(
        self, straight: Terms, terms: Terms, applied: np.ndarray | None = None
    ) -> np.ndarray:
        """(n, 3) dps, each block by a fit that has not seen it; NaN where there is no rate.

        applied: (terms, 3) by which coefficients are multiplied.
        """
        out = np.full((self.session.blocks, 3), np.nan)
        for k, part in enumerate(self.parts):
            kept, coefficients = self.fitted_to(part, straight, terms, applied)
            left = self.session.rate_dps - predicted(kept, coefficients, self.session)
            own = self.fold == k
            out[own] = part.less_offsets(left, part.available)[own]
        return np.where(self.session.available[:, None], out, np.nan)

    def about_stretches(self, left: np.ndarray) -> np.ndarray:
        """(n, 3) what is left, less the offset of each stretch between steps by what is not left
        out with a block: no step's size is known so well. As it is where there is no step."""
        if not self.session.steps:
            return left
        out = left.copy()
        for k, part in enumerate(self.parts):
            own = self.fold == k
            out[own] = part.less_offsets(left, part.available)[own]
        return out

    def fitted_to(
        self, part: Session, straight: Terms, terms: Terms, applied: np.ndarray | None = None
    ) -> tuple[list[Term], np.ndarray]:
        """(terms, (terms, 3) dps per unit) fitted to a part of the recording and to others beside
        it, the line first.

        What does not remember is held at the edges of what the part shows of its source, if asked
        to; but beside play operators, which go on there and bend against it, as they all do on the
        board. The line is fitted anew beside what is applied.
        """
        straight, fitted = list(straight), [part, *self.beside]
        plays = has_play_operators(terms)
        hold = self.hold and not plays
        kept = [held(t, fitted) if hold and is_instant(t) else t for t in terms]
        for i in [i for i, t in enumerate(kept) if is_free(t)]:
            beside = [*straight, *kept[:i], *kept[i + 1 :]]
            kept[i], _ = draw(Regression(fitted, white=True), beside, kept[i])
        every = [*straight, *kept]
        if not every:
            return [], np.zeros((0, 3))
        each = np.ones((len(kept), 3)) if applied is None else applied
        fit = partial(ordinary, sessions=fitted)
        return every, by_axis(fit, every, with_line(straight, terms, each))

    def _squares(self, left: np.ndarray) -> np.ndarray:
        """(folds, 3) sums of squares; infinite where there is nothing to sum."""
        squares = np.where(self.session.available[:, None], left**2, 0.0)
        sums = [squares[self.fold == k].sum(axis=0) for k in range(len(self.parts))]
        return np.nan_to_num(sums, nan=np.inf)


def is_instant(term: Term) -> bool:
    """Whether a term knows nothing of what was before."""
    remembers = term.lag_mode != "none" or term.memory != "none" or term.delay_s or term.decay_s
    return not remembers and "time" not in (term.source, term.second)


def nats(before: np.ndarray, after: np.ndarray, blocks: Sequence[int] | np.ndarray) -> np.ndarray:
    """(folds,) nats gained, from (folds, 3) squares left before and after in so many blocks each.

    Every turn has a noise of its own, so that one far from what the others show, where both are
    far off, does not drown the rest. A piece counts as one block, neighbours being alike.
    """
    count = np.asarray(blocks, float)[:, None]
    shown = (count > 0) & (before > 0) & (after > 0) & np.isfinite(before + after)
    ratio = np.log(np.where(shown, before, 1.0) / np.where(shown, after, 1.0))
    worth = pieces_of(int(count.sum())) / max(count.sum(), 1.0)
    return (0.5 * worth * count * ratio).sum(axis=1)


def held(term: Term, sessions: Sequence[Session]) -> Term:
    """The term held at the edges of what some sessions show of its source; one that reaches beyond
    all that the source does, as far beyond them; one with a curve, where that ends; where nothing
    is seen, as it is."""
    seen = np.concatenate([s.block_mean(s.source(term.source))[s.available] for s in sessions])
    if term.table or not len(seen):
        return term
    every = np.concatenate([s.source(term.source) for s in sessions])
    margins = np.maximum([every.min() - term.lo, term.hi - every.max()], 0.0)
    below, above = np.where(np.isfinite(margins), margins, 0.0)
    lo, hi = max(term.lo, float(seen.min() - below)), min(term.hi, float(seen.max() + above))
    return replace(term, lo=min(lo, hi), hi=hi)


def _only(session: Session, keep: np.ndarray) -> Session:
    rate = np.where(keep[:, None], session.rate_dps, np.nan)
    return replace(session, rate_dps=rate, weight=np.where(keep, session.weight, 0.0))
