"""Whether an effect is all but the same as those found already."""

from collections.abc import Sequence

import numpy as np

from ...model.term import Term
from ..read.sessions import Session, block_basis

#: Share of a term's squares that others must leave: with less, coefficients would be huge and
#: opposite, which no integers hold and no other power-on repeats.
_OWN_SHARE = 0.003


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
