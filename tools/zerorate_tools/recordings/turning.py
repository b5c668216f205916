"""The size and axes of rates by gravity: turned back by them, the force of some seconds points one
way."""

from dataclasses import dataclass
from itertools import permutations, product

import numpy as np

#: Over so long the pushes of a hand average, and a bias turns little.
_SPAN_S, _STEP_S = 3.0, 0.03
#: Fewer may fit a size by chance, and more tell no more.
_LEAST_SPANS, _MOST_SPANS = 5, 100
#: From mdps to radians a second, in steps that a fit tells apart.
_SIZES_DPS = 1.25 ** np.arange(-33.0, 21.0)
#: Turns of the right size explain more than half of why the force does not point one way.
_EXPLAINED = 0.5
#: Pushes make gravity seem to turn up to 1.3 times as fast in recordings of hands and sticks.
#: Where the force swings little they may be a pendulum's, which make it up to 4 times as slow.
_PUSHED, _SWUNG = 1.4, 4.1
#: What the mean force lacks where it swings by 15 degrees (RMS): recorded pendulums swing it less.
_SWINGS = 0.035
#: Turned by so much over _SPAN_S, the mean force lacks this: by 50 dps, twice any bias, from rest.
_BEYOND, _TIMES_UNTURNED = 0.26, 4.0
#: Forces that differ by so little, as a share of their length (RMS), are gravity alone.
_UNPUSHED = 0.1
#: Every order of the axes with every sign.
_AXES = np.array(
    [
        np.diag(signs)[list(order)]
        for order in permutations(range(3))
        for signs in product((1, -1), repeat=3)
    ]
)


@dataclass(frozen=True)
class Size:
    """Degrees a second that 1.0 of some rates stands for: as gravity turns, the least and the most
    that it may be where pushes move with the turning. left: the share of why the force does not
    point one way that the rates do not explain."""

    dps: float
    least: float
    most: float
    left: float = 0.0


def dps_of_one(rates: np.ndarray, force: np.ndarray, t_s: np.ndarray) -> Size | None:
    """The size of rates by which gravity turns; None where it does not tell.

    rates, force: (3, n) in any unit, NaN in rows of the other; t_s: (n,). At rest and about the
    vertical gravity points one way whatever the size is.
    """
    spans = _spans(rates, force, t_s)
    if spans is None:
        return None
    turns, forces = spans
    unturned = _unturned(forces)
    best = int(np.argmin(_lacking(turns, forces, _sized(_SIZES_DPS))))
    if best in (0, len(_SIZES_DPS) - 1):
        return None
    near = _SIZES_DPS[best] * 1.25 ** np.linspace(-1.0, 1.0, 9)
    finer = _lacking(turns, forces, _sized(near))
    left = float(finer.min() / unturned)
    if not left < _EXPLAINED:
        return None
    dps = float(near[np.argmin(finer)])
    most = dps * (_SWUNG if unturned < _SWINGS else _PUSHED)
    return Size(dps, dps / _PUSHED, most, left)


def turns_otherwise(rates: np.ndarray, force: np.ndarray, t_s: np.ndarray) -> bool:
    """Whether gravity alone turns widely, and not as rates of any size would turn it.

    rates, force, t_s: as those of dps_of_one.
    """
    spans = _spans(rates, force, t_s)
    if spans is None or dps_of_one(rates, force, t_s) is not None:
        return False
    lengths = np.linalg.norm(spans[1], axis=1)
    unpushed = np.std(lengths) < _UNPUSHED * np.median(lengths)
    return bool(unpushed and _unturned(spans[1]) > _SWINGS)


def turn_too_far(rates_dps: np.ndarray, force: np.ndarray, t_s: np.ndarray) -> bool:
    """Whether the force stays where such rates would turn it, beyond what a bias adds to them.

    rates_dps, force: (3, n), row by row; t_s: (n,). About the vertical any rate is possible.
    """
    spans = _spans(rates_dps, force, t_s)
    if spans is None:
        return False
    lacking = _lacking(*spans, np.eye(3)[np.newaxis]).item()
    return lacking > max(_BEYOND, _TIMES_UNTURNED * _unturned(spans[1]))


def axes_of(rates_dps: np.ndarray, force: np.ndarray, t_s: np.ndarray) -> np.ndarray | None:
    """(3, 3) an order of the axes with signs that the rates must be taken in to turn gravity as it
    is seen to turn; None where gravity does not tell, or the force swings so little that it may be
    a push that goes with the turning: a car's in a curve, against its roll.

    rates_dps, force: (3, n), row by row; t_s: (n,).
    """
    spans = _spans(rates_dps, force, t_s)
    if spans is None or _unturned(spans[1]) < _SWINGS:
        return None
    turns, forces = spans
    lacking = _lacking(turns, forces, _AXES)
    best, second = np.argsort(lacking)[:2]
    clear = lacking[best] < _EXPLAINED * min(lacking[second], _unturned(forces))
    return _AXES[best] if clear else None


def axes_words(axes: np.ndarray) -> str:
    """-x -y z, say: which reading each axis is."""
    return " ".join(("-" if row.sum() < 0 else "") + "xyz"[np.argmax(np.abs(row))] for row in axes)


def _sized(sizes: np.ndarray) -> np.ndarray:
    return sizes[:, np.newaxis, np.newaxis] * np.eye(3)


def _spans(
    rates: np.ndarray, force: np.ndarray, t_s: np.ndarray
) -> tuple[np.ndarray, np.ndarray] | None:
    """Turns and forces (steps, 3, spans), both means over a step; None where there are too few."""
    rates, force, t_s = _at_one_time(rates, force, t_s)
    whole = np.isfinite([*rates, *force, t_s]).all(axis=0)
    rates, force, t_s = rates[:, whole], force[:, whole], t_s[whole]
    step_s = float(np.median(np.diff(t_s))) if len(t_s) > 1 else 0.0
    rows = max(1, round(_STEP_S / step_s)) if step_s > 0 else 0
    steps = int(_SPAN_S / (rows * step_s)) if rows else 0
    if steps < 2:
        return None
    every = np.arange(0, len(t_s) - steps * rows, steps * rows)
    away_s = t_s[every + steps * rows] - t_s[every] - steps * rows * step_s
    every = every[np.abs(away_s) < 0.1 * _SPAN_S]
    if len(every) < _LEAST_SPANS:
        return None
    every = every[:: 1 + len(every) // _MOST_SPANS]
    at = every + rows * np.arange(steps)[:, np.newaxis]
    rates, force = (
        np.mean([of[:, at + n] for n in range(rows)], axis=0).swapaxes(0, 1)
        for of in (rates, force)
    )
    return np.radians(rates * rows * step_s), force


def _at_one_time(
    rates: np.ndarray, force: np.ndarray, t_s: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Rates, force and times, the force put at the times of the rates where both have rows of their
    own: none in its gaps."""
    rated, felt = (np.isfinite([*of, t_s]).all(axis=0) for of in (rates, force))
    if (rated & felt).any() or not felt.any():
        return rates, force, t_s
    at_s, t_s = t_s[felt], t_s[rated]
    away_s = np.diff(at_s, prepend=-np.inf, append=np.inf)[np.searchsorted(at_s, t_s)]
    near = away_s < 0.1 * _SPAN_S
    lines = np.array([np.interp(t_s[near], at_s, axis[felt]) for axis in force])
    return rates[:, rated][:, near], lines, t_s[near]


def _lacking(turns: np.ndarray, forces: np.ndarray, taken: np.ndarray) -> np.ndarray:
    """What the mean force is shorter by in a frame that does not turn, as a share, with the rates
    taken so: (k, 3, 3) as many matrices."""
    summed = np.zeros((3, len(taken), forces.shape[2]))
    for turn, force in zip(turns[::-1], forces[::-1]):
        # from the end of the span to its start, so that one turn a step serves all after it
        summed = _turned(summed, np.einsum("kij,js->iks", taken, turn))
        summed += force[:, np.newaxis]
    lengths = np.linalg.norm(forces, axis=1).sum()
    return 1.0 - np.linalg.norm(summed, axis=0).sum(axis=1) / lengths


def _unturned(forces: np.ndarray) -> float:
    """What the mean force is shorter by as it is, as a share."""
    return _lacking(np.zeros_like(forces), forces, np.eye(3)[np.newaxis]).item()


def _turned(vectors: np.ndarray, turn: np.ndarray) -> np.ndarray:
    """Vectors about an axis by an angle, as rotation vectors; their three axes come first."""
    angle = np.linalg.norm(turn, axis=0)
    axis = turn / np.maximum(angle, 1e-12)
    along = (axis * vectors).sum(axis=0) * axis
    across = np.cross(axis, vectors, axis=0)
    return along + (vectors - along) * np.cos(angle) + across * np.sin(angle)
