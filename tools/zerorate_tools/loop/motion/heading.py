"""Heading lost in motion, against an attitude that somebody else saw: cameras, a second sensor."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from ...simulate.attitude import IDENTITY, integrate
from .columns import BIAS
from .matrix import FREEDOM, ROUNDS, beside
from .moving import LEAST_DPS, W_LAST, Moving, seconds_seen, turned_between

#: Headings are told over stretches of this length: filters with a magnetometer forget as soon.
_STRETCH_S = 30.0
#: Stretches to the length of one, and lengths that tell a wrong matrix from a wrong bias: one alone
#: does not.
_OVERLAP, _LEAST_LENGTHS = 4, 1.5


def heading_lost(
    judged: Sequence[tuple[Moving, NDArray[np.float64]]],
) -> tuple[float, float] | None:
    """Degrees a minute without and with a matrix (3, 3), weighted RMS over stretches of recordings,
    each beside a matrix. None where no stretch is seen."""
    seen = [(one, matrix) for one, matrix in judged if one.given is not None]
    errors = [[_lost(one, m) for m in (0.0 * matrix, matrix)] for one, matrix in seen]
    squares = np.concatenate([np.zeros((2, 0)), *errors], axis=1) ** 2
    if not squares.shape[1]:
        return None
    before, after = 60.0 * np.sqrt(np.average(squares, axis=1, weights=_weights(squares)))
    return float(before), float(after)


def tells_worse(judged: Sequence[tuple[Moving, NDArray[np.float64]]]) -> bool:
    """Whether there are stretches enough to forbid a matrix."""
    seen = [(one, np.isfinite(one.given).all(axis=1)) for one, _ in judged if one.given is not None]
    numbers = [len(_stretches(*each)) for each in seen]
    return sum(1.0 + (n - 1) / _OVERLAP for n in numbers if n) >= _LEAST_LENGTHS


def _weights(squares: NDArray[np.float64]) -> NDArray[np.float64]:
    """(k,) weight of each stretch: an error that is large without and with the matrix is the
    attitude's own (Student's t, as in `matrix._weigh`). squares: (2, k) without and with."""
    least, weight = squares.min(axis=0), np.ones(squares.shape[1])
    for _ in range(ROUNDS):
        usual = max(np.average(least, weights=weight), 1e-300)
        weight = (FREEDOM + 1.0) / (FREEDOM + least / usual)
    return weight


def _lost(one: Moving, matrix: NDArray[np.float64]) -> NDArray[np.float64]:
    """(k,) degrees of heading a second that each moving stretch loses against the attitude.

    The bias is what gravity finds beside the matrix; a constant turn between the attitude's frame
    and the sensor's is fitted.
    """
    fitted = beside(one, matrix)
    bias = np.zeros(3) if fitted is None else fitted.own[BIAS]
    rate = np.degrees(one.rate - one.rate @ matrix.T - bias)
    assert one.given is not None, "only of an attitude"
    attitude, ours = one.given, integrate(rate, one.dt_s, IDENTITY)
    seen = np.isfinite(attitude).all(axis=1)
    ends, steps = _stretches(one, seen), seconds_seen(attitude, one.dt_s)
    if not ends or not steps:
        return np.zeros(0)
    frame, _ = Rotation.align_vectors(
        *(turned_between(q, steps).as_rotvec() for q in (attitude, ours))
    )
    first = Rotation.from_quat(attitude[[a for a, _ in ends]][:, W_LAST])
    theirs, turned = (turned_between(q, ends) for q in (attitude, ours))
    left = first * theirs * (frame * turned * frame.inv()).inv()
    return np.degrees((left * first.inv()).as_rotvec()[:, 2]) / _STRETCH_S


def _stretches(one: Moving, seen: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """First and last sample of stretches that move, each a quarter on, seen at both ends."""
    n = round(_STRETCH_S / one.dt_s)
    every = [(a, a + n) for a in range(0, len(one.rate) - n, n // _OVERLAP)]
    spread = [np.degrees(np.sqrt(one.rate[a:b].var(axis=0).sum())) for a, b in every]
    whole = [abs(one.at_s[b] - one.at_s[a] - _STRETCH_S) < 1.0 for a, b in every]
    return [
        (a, b)
        for (a, b), dps, is_whole in zip(every, spread, whole)
        if dps > LEAST_DPS and is_whole and seen[a] and seen[b]
    ]
