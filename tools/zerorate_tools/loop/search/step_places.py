"""The places at which a step may be, and how much one explains at each.

The noise's colour is refitted at every place: without a step, noise that walks takes most of one
for its own, and what then explains most need not be the step. Places are blocks at first; where one
explains most, quarters of a block: half of a step in the midst of a block is in that block.
"""

from dataclasses import dataclass, replace

import numpy as np

from ..fit.likelihood import fit_base, ratios

#: Blocks at the end where a step cannot be told from the offset.
EDGE = 5
#: Blocks at the start where none is looked for: what remembers temperature wakes there.
_WAKES = 10
#: Quarters of a block at which a step is looked for around the best place.
_QUARTERS = np.arange(-3, 4) / 4
#: Blocks from the middle of a ramp to either end, and shares of them that it is off the place.
LONGEST = 8.0
_OF_SPAN = np.array([0.5, 0.75, 1.0, 1.25, 1.5, 2.0, 2.5, 3.0])
_RAMPS, _OFF = np.array([2.0, 4.0, LONGEST]), np.array([-0.5, 0.0, 0.5])


@dataclass
class Place:
    """A session's index, the blocks before a step in it, and the likelihood ratio of one there."""

    session: int
    at: float
    ratio: float


def heavisides(session, at: np.ndarray) -> np.ndarray:
    """(blocks, places) 0 before and 1 after each, and of a block with one in it the share after."""
    out = np.clip(np.arange(session.blocks)[:, None] + 1.0 - at[None], 0.0, 1.0)
    for k in np.flatnonzero(at % 1.0):
        if 0.0 <= at[k] < session.blocks:
            out[int(at[k]), k] = _share_after(session, float(at[k]))
    return out


def _share_after(session, at: float) -> float:
    """Of the ticks that count in a block's rate, those after a place in it: a hand that put the
    device aside left rest at one of its ends."""
    per, block = session.ticks_per_block, int(at)
    weight = (
        np.ones(per) if session.tick_weight is None else session.tick_weight.reshape(-1, per)[block]
    )
    after = np.clip(np.arange(per) + 1.0 - (at - block) * per, 0.0, 1.0)
    return float(after @ weight / weight.sum()) if weight.any() else block + 1.0 - at


def _around(session, at: float) -> np.ndarray:
    """Places by quarters of a block around one, and where the device did not rest there around the
    first and the last block of that: the step may be in either."""
    there = np.flatnonzero(session.available)
    k = int(np.searchsorted(there, at))
    ends = [there[k - 1] + 1.0, float(there[k])] if 0 < k < len(there) else []
    return np.unique(np.add.outer([at, *ends], _QUARTERS))


def beyond_ramps(regression, terms, session: int, at: float) -> float:
    """By how much a step explains more than the best ramp of some blocks around it, as twice a
    gain in log likelihood."""
    products = regression.cross_products(terms)
    base = fit_base(products, regression.scale)
    blocks = np.arange(regression.sessions[session].blocks)[:, None] + 0.5
    half = np.repeat(_RAMPS, len(_OFF))
    ramps = np.clip((blocks - at - half * np.tile(_OFF, len(_RAMPS))) / (2 * half) + 0.5, 0.0, 1.0)
    steps = heavisides(regression.sessions[session], _around(regression.sessions[session], at))
    columns = np.hstack([steps, ramps])
    found = _ratios(regression, products, base, regression.stack(terms), session, columns)
    return float(found[: steps.shape[1]].max() - found[steps.shape[1] :].max())


def best_slow(regression, terms, session: int, at: list[float]) -> float:
    """What the best slow change around some places explains: a ramp or an exponential, of lengths
    about theirs, as twice a gain in log likelihood."""
    products = regression.cross_products(terms)
    base = fit_base(products, regression.scale)
    span = max(at) - min(at)
    first = np.arange(min(at) - span, max(at), 0.25)
    since = np.arange(regression.sessions[session].blocks)[:, None] + 0.5 - first
    columns = [np.clip(since / (share * span), 0.0, 1.0) for share in _OF_SPAN]
    columns += [-np.expm1(-np.maximum(since, 0.0) / (share * span)) for share in _OF_SPAN]
    z = regression.stack(terms)
    return float(_ratios(regression, products, base, z, session, np.hstack(columns)).max())


def best_place(regression, terms) -> tuple[Place | None, list]:
    """Where a step explains most beside the terms and the events that the regression has, and
    (session, places, ratios) of every session."""
    products = regression.cross_products(terms)
    base = fit_base(products, regression.scale)
    z = regression.stack(terms)
    best, every = None, []
    for s, session in enumerate(regression.sessions):
        at = _ground(session)
        if not len(at):
            continue
        found = _ratios(regression, products, base, z, s, heavisides(session, at))
        every.append((s, at, found))
        if best is None or found.max() > best.ratio:
            best = Place(s, float(at[found.argmax()]), float(found.max()))
    if best:
        at = _around(regression.sessions[best.session], best.at)
        columns = heavisides(regression.sessions[best.session], at)
        found = _ratios(regression, products, base, z, best.session, columns)
        best = Place(best.session, float(at[found.argmax()]), float(found.max()))
    return best, every


def _ratios(regression, products, base, z, s, columns) -> np.ndarray:
    """(places,) likelihood ratios of columns of one session's blocks, over all axes."""
    y, columns = regression.y[s], regression.whiteners[s].prepare(columns)
    cross, alone = regression.whiteners[s].products(np.hstack([y, z[s]]), columns, 1)[1:]
    cross = cross[:, :, None]
    own = np.arange(len(regression.sessions)) == s
    axes = y.shape[1]
    xy, xz, xx = (np.multiply.outer(own, p) for p in (cross[..., :axes], cross[..., axes:], alone))
    beside = replace(products, xy=xy, xz=xz, xx=xx)
    return ratios(beside, base, regression.scale).sum(axis=1)


def tried(session) -> int:
    """How many places a session has, in motion or not."""
    return max(0, session.blocks + 1 - EDGE - _WAKES)


def _ground(session) -> np.ndarray:
    """Blocks before which a step may be: in motion a scale factor's error leaps, not the bias."""
    moved = session.moved
    free = ~(moved | np.r_[False, moved[:-1]])
    at = np.arange(_WAKES, session.blocks - EDGE + 1)
    return at[free[at]] if len(at) else at
