"""One recording alone: blocks of time stand in for sessions, with gaps between what is fitted and
what is not.

Weaker than sessions: one turn-on offset, one course of temperature, and a slow cause outlasts any
gap.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .basis import Term, block_basis
from .sessions import Session

#: Shares of the recording's time that are locked away; inside, so that no range is extrapolated.
_LOCKED = ((0.28, 0.42), (0.66, 0.80))
_FOLDS = 5
_GAP_SHARE = 0.03
_WORTH = 0.1
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


def pieces(session: Session) -> list[Session]:
    """Five pieces of what a session has, with gaps, to leave out in turn."""
    n = session.blocks
    parts = np.array_split(np.flatnonzero(session.available), _FOLDS)
    gap = max(1, int(_GAP_SHARE * n / 2))
    return [
        _only(session, np.isin(np.arange(n), p[gap:-gap]), f"{session.name} part {i + 1}")
        for i, p in enumerate(parts)
    ]


def bend_gains(folds: list[Session], terms, candidate) -> np.ndarray:
    """(folds,) nats by which each piece is better predicted from the others with the candidate.

    Ordinary least squares with one offset for all pieces, as they are of one power-on; a piece
    counts as a tenth of its blocks, neighbours being alike. The candidate is held at the edges of
    what the other pieces show, as it is where it is deployed.
    """
    squares = np.array(
        [[_misfit(folds, i, terms, more) for i in range(len(folds))] for more in ((), candidate)]
    )
    blocks = np.array([f.available.sum() for f in folds])[:, None]
    variance = squares[1].sum(axis=0) / blocks.sum()
    return (0.5 * _WORTH * (squares[0] - squares[1]) / variance).sum(axis=1)


def _misfit(folds, i, terms, candidate):
    """(3,) squares left in piece i by a fit to the others."""
    others = [f for j, f in enumerate(folds) if j != i]
    terms = [*terms, *(_held(t, others) for t in candidate)]

    def stack(parts):
        x = [np.column_stack([block_basis(t, p) for t in terms])[p.available] for p in parts]
        return np.vstack(x), np.vstack([p.rate_dps[p.available] for p in parts])

    x, y = stack(others)
    centre, scale = x.mean(axis=0), np.maximum(x.std(axis=0), 1e-300)
    design = np.column_stack([np.ones(len(x)), (x - centre) / scale])
    coefficients = np.linalg.lstsq(design, y, rcond=1e-10)[0]
    x, y = stack([folds[i]])
    left = y - np.column_stack([np.ones(len(x)), (x - centre) / scale]) @ coefficients
    return (left**2).sum(axis=0)


def _held(term: Term, sessions: list[Session]) -> Term:
    """The term held at the edges of what some sessions show of its source."""
    seen = np.concatenate([s.block_mean(s.source(term.source))[s.available] for s in sessions])
    return replace(term, lo=float(seen.min()), hi=float(seen.max()))
