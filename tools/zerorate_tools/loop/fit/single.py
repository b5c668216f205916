"""One recording alone: blocks of time stand in for sessions, with gaps between what is fitted and
what is not.

Weaker than sessions: one turn-on offset, one course of temperature, and a slow cause outlasts any
gap.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...model.term import Term
from ..read.sessions import Session, block_basis

#: Shares of the recording's time that are locked away; inside, so that no range is extrapolated.
_LOCKED = ((0.28, 0.42), (0.66, 0.80))
_FOLDS = 5
_GAP_SHARE = 0.03
_LEAST_LEFT = 3
_WORTH = 0.1
#: Nats that pieces left out must gain in all. Of 310 simulated bends that the likelihood shows, at
#: two to five floors, 33 made the held-out error worse by more than 2 %; 285 and 26 of them pass.
#: To ask for more costs more of the bends that help: at 1 nat it is 256 and 22.
LEAST_NATS = 0.0
WEAKER = (
    "One recording only: stretches of it were held out instead of a whole power-on. An effect that "
    "repeats at every power-on cannot be told from one that happened once, and a slow cause spans "
    "the gaps; nothing is confirmed before a second power-on shows it too."
)


def _only(session: Session, keep: np.ndarray, name: str) -> Session:
    rate = np.where(keep[:, None], session.rate_dps, np.nan)
    return replace(session, name=name, rate_dps=rate, weight=np.where(keep, session.weight, 0.0))


def held_out(n: int) -> tuple[np.ndarray, np.ndarray]:
    """(n,) bool of n blocks: those locked away, and those with the gaps beside them."""
    at = (np.arange(n) + 0.5) / n
    locked, near = np.zeros(n, bool), np.zeros(n, bool)
    for first, last in _LOCKED:
        locked |= (at >= first) & (at < last)
        near |= (at >= first - _GAP_SHARE) & (at < last + _GAP_SHARE)
    return locked, near


def split(session: Session) -> tuple[Session, Session, list[Session]]:
    """Training part, locked part, and pieces of the training part to leave out in turn."""
    locked, near = held_out(session.blocks)
    train = _only(session, ~near, session.name)
    return train, _only(session, locked, session.name), pieces(train)


def gap_blocks(session: Session) -> int:
    """Blocks between a piece and what is fitted beside it, at either side of their border."""
    return max(1, int(_GAP_SHARE * session.blocks / 2))


def pieces(session: Session) -> list[Session]:
    """Five pieces of what a session has, with gaps, to leave out in turn."""
    n = session.blocks
    parts = np.array_split(np.flatnonzero(session.available), _FOLDS)
    gap = gap_blocks(session)
    return [
        _only(session, np.isin(np.arange(n), _inside(p, gap)), f"{session.name} part {i + 1}")
        for i, p in enumerate(parts)
    ]


def _inside(blocks: np.ndarray, gap: int) -> np.ndarray:
    """The blocks without a gap at either end; where rests are rare, some are left all the same."""
    gap = min(gap, max(0, (len(blocks) - _LEAST_LEFT) // 2))
    return blocks[gap : len(blocks) - gap]


class PiecesByLine:
    """Judges bends of one recording by how well its pieces are predicted from the others.

    Ordinary least squares with one offset for all pieces, as they are of one power-on, beside a
    straight line; for recordings that the firmware's own kernels cannot be run over.
    """

    reason = "does not predict the pieces left out"

    def __init__(self, folds: Sequence[Session]) -> None:
        self._folds = list(folds)

    def __call__(
        self, straight: Sequence[Term], found: Sequence[Term], candidate: Sequence[Term]
    ) -> np.ndarray:
        """(folds,) nats by which each piece is better predicted with the candidate."""
        before, after = (
            [self._left(i, [*straight, *found], more) for i in range(len(self._folds))]
            for more in ((), candidate)
        )
        blocks = [int(f.available.sum()) for f in self._folds]
        return nats(np.array(before), np.array(after), blocks)

    def _left(self, i, terms, more):
        """(3,) squares left in piece i by a fit to the others."""
        piece, others = self._folds[i], [f for j, f in enumerate(self._folds) if j != i]
        terms = [*terms, *(held(t, others) for t in more)]
        x, y = _stacked(terms, others)
        centre, scale = x.mean(axis=0), np.maximum(x.std(axis=0), 1e-300)
        design = np.column_stack([np.ones(len(x)), (x - centre) / scale])
        coefficients = np.linalg.lstsq(design, y, rcond=1e-10)[0]
        x, y = _stacked(terms, [piece])
        left = y - np.column_stack([np.ones(len(x)), (x - centre) / scale]) @ coefficients
        return (left**2).sum(axis=0)


def _stacked(terms, parts):
    """Columns of the terms, and rates, of all blocks of some sessions."""
    x = [np.column_stack([block_basis(t, s) for t in terms])[s.available] for s in parts]
    return np.vstack(x), np.vstack([s.rate_dps[s.available] for s in parts])


def nats(before: np.ndarray, after: np.ndarray, blocks: Sequence[int]) -> np.ndarray:
    """(folds,) nats gained, from (folds, 3) squares left before and after in so many blocks each.

    Every piece has a noise of its own, so that one far from what the others show, where both are
    far off, does not drown the rest. It counts as a tenth of its blocks, neighbours being alike.
    """
    count = np.asarray(blocks, float)[:, None]
    shown = (count > 0) & (before > 0) & (after > 0) & np.isfinite(before + after)
    ratio = np.log(np.where(shown, before, 1.0) / np.where(shown, after, 1.0))
    return (0.5 * _WORTH * count * ratio).sum(axis=1)


def speaks_for(gain: np.ndarray) -> bool:
    """Whether nats gained on pieces left out speak for an effect."""
    return bool(gain.sum() > LEAST_NATS)


def held(term: Term, sessions: Sequence[Session]) -> Term:
    """The term held at the edges of what some sessions show of its source."""
    seen = np.concatenate([s.block_mean(s.source(term.source))[s.available] for s in sessions])
    return replace(term, lo=float(seen.min()), hi=float(seen.max()))
