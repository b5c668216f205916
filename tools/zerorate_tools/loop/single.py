"""One recording alone: blocks of time stand in for sessions, with gaps between what is fitted and
what is not.

Weaker than sessions: one turn-on offset, one course of temperature, and a slow cause outlasts any
gap.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .sessions import Session

#: Shares of the recording's time that are locked away; inside, so that no range is extrapolated.
_LOCKED = ((0.28, 0.42), (0.66, 0.80))
_FOLDS = 5
_GAP_SHARE = 0.03
WEAKER = (
    "One recording only: stretches of it were held out instead of a whole power-on. An effect that "
    "repeats at every power-on cannot be told from one that happened once, and a slow cause spans "
    "the gaps; nothing is confirmed before a second power-on shows it too."
)


def _only(session: Session, keep: np.ndarray, name: str) -> Session:
    rate = np.where(keep[:, None], session.rate_dps, np.nan)
    return replace(session, name=name, rate_dps=rate, weight=np.where(keep, session.weight, 0.0))


def split(session: Session) -> tuple[Session, Session, list[Session]]:
    """Training part, locked part, and pieces of the training part to leave out in turn."""
    n = session.blocks
    at = (np.arange(n) + 0.5) / n
    locked, near = np.zeros(n, bool), np.zeros(n, bool)
    for first, last in _LOCKED:
        locked |= (at >= first) & (at < last)
        near |= (at >= first - _GAP_SHARE) & (at < last + _GAP_SHARE)
    train = ~near
    pieces = np.array_split(np.flatnonzero(train), _FOLDS)
    gap = max(1, int(_GAP_SHARE * n / 2))
    folds = [
        _only(session, np.isin(np.arange(n), p[gap:-gap]), f"{session.name} part {i + 1}")
        for i, p in enumerate(pieces)
    ]
    return _only(session, train, session.name), _only(session, locked, session.name), folds
