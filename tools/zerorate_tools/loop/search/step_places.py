"""The places at which a step may be, and how much one explains at each.

The noise's colour is refitted at every place: without a step, noise that walks takes most of one
for its own, and what then explains most need not be the step. Places are blocks at first; where one
explains most, quarters of a block: half of a step in the midst of a block is in that block.
"""

from dataclasses import dataclass, replace

import numpy as np

from ...model.term import Terms
from ..fit.likelihood import fit_base, ratios
from ..fit.regression import Regression
from ..read.sessions import Session

#: Quarters of a block at which a step is looked for around the best place.
_QUARTERS = np.arange(-3, 4) / 4
#: Blocks from the middle of a ramp to either end, and shares of them that it is off the place.
_RAMPS, _OFF = np.array([2.0, 4.0, 8.0]), np.array([-0.5, 0.0, 0.5])
#: Blocks at either end where none is looked for: there it is told neither from a ramp nor, at the
#: end, from the offset, and at the start what remembers temperature wakes.
LONGEST = int(_RAMPS.max())

#: (session, places, ratios) of some sessions.
Ratios = list[tuple[int, np.ndarray, np.ndarray]]


@dataclass
class Place:
    """A session's index, the blocks before a step in it, and the likelihood ratio of one there."""

    session: int
    at: float
    ratio: float


def heavisides(session: Session, at: np.ndarray) -> np.ndarray:
    """(blocks, places) 0 before and 1 after each, and of a block with one in it the share after."""
    out = np.clip(np.arange(session.blocks)[:, None] + 1.0 - at[None], 0.0, 1.0)
    for k in np.flatnonzero(at % 1.0):
        if 0.0 <= at[k] < session.blocks:
            out[int(at[k]), k] = _share_after(session, float(at[k]))
    return out


def _share_after(session: Session, at: float) -> float:
    """Of the ticks that count in a block's rate, those after a place in it: a hand that put the
    device aside left rest at one of its ends."""
    per, block = session.ticks_per_block, int(at)
    weight = (
        np.ones(per) if session.tick_weight is None else session.tick_weight.reshape(-1, per)[block]
    )
    after = np.clip(np.arange(per) + 1.0 - (at - block) * per, 0.0, 1.0)
    return float(after @ weight / weight.sum()) if weight.any() else block + 1.0 - at


def _around(session: Session, at: float) -> np.ndarray:
    """Places by quarters of a block around one, and where the device did not rest there around the
    first and the last block of that: the step may be in either."""
    there = np.flatnonzero(session.available)
    k = int(np.searchsorted(there, at))
    ends = [there[k - 1] + 1.0, float(there[k])] if 0 < k < len(there) else []
    return np.unique(np.add.outer([at, *ends], _QUARTERS))


class _Beside:
    """Likelihood ratios of columns beside the terms and the events that the regression has."""

    def __init__(self, regression: Regression, terms: Terms) -> None:
        self._regression, self._z = regression, regression.stack(terms)
        self._products = regression.cross_products(terms)
        self._base = fit_base(self._products, regression.scale)

    def ratios(self, s: int, columns: np.ndarray) -> np.ndarray:
        """(K,) of (blocks, K) columns of one session, over all axes."""
        r, whitener = self._regression, self._regression.whiteners[s]
        axes = r.y[s].shape[1]
        fixed = np.hstack([r.y[s], self._z[s]])
        _, cross, xx = whitener.products(fixed, whitener.prepare(columns))
        cross = cross[:, :, None]
        own = np.arange(len(r.sessions)) == s
        parts = {"xy": cross[..., :axes], "xz": cross[..., axes:], "xx": xx}
        of_all = {name: np.multiply.outer(own, part) for name, part in parts.items()}
        return ratios(replace(self._products, **of_all), self._base, r.scale).sum(axis=1)


def beyond_ramps(regression: Regression, terms: Terms, session: int, at: float) -> float:
    """By how much a step explains more than the best ramp of some blocks around it, as twice a
    gain in log likelihood."""
    own = regression.sessions[session]
    blocks = np.arange(own.blocks)[:, None] + 0.5
    half = np.repeat(_RAMPS, len(_OFF))
    ramps = np.clip((blocks - at - half * np.tile(_OFF, len(_RAMPS))) / (2 * half) + 0.5, 0.0, 1.0)
    steps = heavisides(own, _around(own, at))
    found = _Beside(regression, terms).ratios(session, np.hstack([steps, ramps]))
    return float(found[: steps.shape[1]].max() - found[steps.shape[1] :].max())


def best_place(regression: Regression, terms: Terms) -> tuple[Place | None, Ratios]:
    """Where a step explains most beside the terms and the events that the regression has, and
    (session, places, ratios) of every session."""
    beside = _Beside(regression, terms)

    def best_of(s: int, at: np.ndarray) -> tuple[Place, np.ndarray]:
        found = beside.ratios(s, heavisides(regression.sessions[s], at))
        return Place(s, float(at[found.argmax()]), float(found.max())), found

    best, every = None, []
    for s, session in enumerate(regression.sessions):
        at = _ground(session)
        if not len(at):
            continue
        place, found = best_of(s, at)
        every.append((s, at, found))
        if best is None or place.ratio > best.ratio:
            best = place
    if best:
        at = _around(regression.sessions[best.session], best.at)
        best, _ = best_of(best.session, at)
    return best, every


def tried(session: Session) -> int:
    """How many places a session has, in motion or not."""
    return max(0, session.blocks + 1 - 2 * LONGEST)


def _ground(session: Session) -> np.ndarray:
    """Blocks before which a step may be: in motion a scale factor's error leaps, not the bias."""
    moved = session.moved
    free = ~(moved | np.r_[False, moved[:-1]])
    at = np.arange(LONGEST, session.blocks - LONGEST + 1)
    return at[free[at]] if len(at) else at
