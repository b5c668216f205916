"""Disturbances: blocks that a knock or a hand spoiled, and after which the bias is what it was.

Each looks like two steps that undo each other. Its blocks are held at their neighbours before steps
are looked for.
"""

from itertools import pairwise

import numpy as np

from .steps import MOST_PER_SESSION, Step, standing

#: Blocks between two steps that undo each other up to which they are a disturbance: none need lie
#: between them whole.
_DISTURBED = 2.0
#: Cosine of two steps' sizes below which they undo each other.
_UNDONE = -0.5


def hold_disturbed(regression, terms, recordings: int = 1) -> None:
    """Hold every disturbance's blocks on a line between their neighbours."""
    kept = regression.events()
    for _ in range(MOST_PER_SESSION):
        steps = sorted(standing(regression, terms, recordings, kept), key=lambda s: s.block)
        regression.set_events([], kept)
        disturbed = [(a, b) for a, b in pairwise(steps) if _undoes(a, b)]
        if not disturbed:
            break
        for a, b in disturbed:
            _hold(regression, a, b)
        regression.prepare()


def _undoes(a: Step, b: Step) -> bool:
    apart = (b.block - b.share) - (a.block - a.share)
    both = np.linalg.norm(a.size_dps) * np.linalg.norm(b.size_dps)
    undone = a.size_dps @ b.size_dps < _UNDONE * both
    return bool(a.session == b.session and apart <= _DISTURBED and undone)


def _hold(regression, a: Step, b: Step) -> None:
    """The blocks from one step to another."""
    rate = regression.rate[a.session].copy()
    at = np.arange(a.block - int(np.ceil(a.share)), b.block)
    there = regression.sessions[a.session].available.copy()
    there[at] = False
    for axis in range(3):
        rate[at, axis] = np.interp(at, np.flatnonzero(there), rate[there, axis])
    regression.rate[a.session] = rate
