"""Whether an effect is all but the same as those found already."""

from collections.abc import Sequence

import numpy as np

from ...model.term import Term
from ..fit.line import ordinary
from ..fit.regression import predicted
from ..read.sessions import Session, block_basis

#: Share of a term's squares that others must leave: with less, coefficients would be huge and
#: opposite, which no integers hold and no other power-on repeats.
_OWN_SHARE = 0.003
#: Of the error without it that an effect may be. Lags of real parts are 0.6 times; what tells a
#: start's decay from a warm-up by cancelling both is 6 times and more.
_MOST_TIMES = 2.0


def collinear(terms: Sequence[Term], others: Sequence[Term], sessions: list[Session]) -> bool:
    """Whether others of its source with a memory leave next to nothing of an effect of one term
    with one.

    Powers and kinks are none the worse for being much alike: nothing tells their places better.
    """
    if len(terms) != 1:
        return False
    [term] = terms
    same_source = [t for t in others if t.source == term.source and _has_memory(t)]
    if not same_source or not _has_memory(term):
        return False
    own = _within(term, sessions)
    design = np.column_stack([_within(t, sessions) for t in same_source])
    design /= np.maximum(np.linalg.norm(design, axis=0), 1e-300)
    left = own - design @ np.linalg.lstsq(design, own, rcond=1e-10)[0]
    return bool(left @ left < _OWN_SHARE * (own @ own))


def _has_memory(term):
    return bool(term.lag_s or term.delay_s or term.decay_s or term.width)


def _within(term, sessions):
    """(blocks,) basis of all sessions where there is a rate, less each session's own mean."""
    parts = [block_basis(term, s)[s.available] for s in sessions]
    return np.concatenate([p - p.mean() for p in parts])


def cancels(sessions: Sequence[Session], beside: Sequence[Term], terms: Sequence[Term]) -> bool:
    """Whether terms are far larger than the error that they explain: then they only stand against
    others, as a start's decay against a warm-up, and not at another power-on."""
    without = _squares(sessions, beside, ordinary(beside, sessions) if beside else (), True)
    fitted = ordinary([*beside, *terms], sessions)[len(beside) :]
    return _squares(sessions, terms, fitted, False) > _MOST_TIMES**2 * without


def _squares(sessions, terms, coefficients, left: bool) -> float:
    """Of what terms add to the bias, or leave of it, offsets aside, in all."""
    total = 0.0
    for s in sessions:
        added = predicted(terms, coefficients, s)
        values = s.rate_dps - added if left else added
        total += float((s.less_offsets(values, s.available)[s.available] ** 2).sum())
    return total
