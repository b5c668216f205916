"""Heading lost in motion, against an attitude that somebody else saw: cameras, a second sensor."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from ...recordings import open_recording
from ...simulate.attitude import IDENTITY, integrate
from ..read.reference import attitude_names
from .by_windows import by_windows
from .columns import BIAS
from .in_motion import InMotion, slots_of
from .matrix import beside
from .moving import LEAST_DPS, Moving

#: Headings are told over stretches of this length: filters with a magnetometer forget as soon.
_STRETCH_S = 30.0
_W_LAST = [1, 2, 3, 0]


def heading_lost(moving: Mapping[Path, Moving]) -> tuple[float, float] | None:
    """Degrees a minute without and with the matrix, RMS over stretches; each log with the matrix
    of the others, a log alone its second half with that of its first. None without attitude."""
    errors = []
    for path in filter(has_attitude, moving):
        one, others = moving[path], [m for p, m in moving.items() if p != path]
        middle = len(one.rate) // 2
        shown = by_windows(others or [one.part(slice(0, middle))], [])
        judged = slice(0 if others else middle, None)
        errors.append(_without_and_with(one, judged, _deployed(shown)))
    return _rms(errors)


def heading_lost_by(moving: Mapping[Path, Moving], shown) -> tuple[float, float] | None:
    """The same of logs with an attitude, which a matrix was not fitted to. None where no stretch
    of them is seen."""
    matrix = _deployed(shown)
    return _rms([_without_and_with(one, slice(None), matrix) for one in moving.values()])


def _without_and_with(one: Moving, judged: slice, matrix: NDArray) -> NDArray:
    """(2, k) degrees a second of each stretch."""
    own = one.part(judged)
    return np.array([_lost(own, m) for m in (np.zeros((3, 3)), matrix)])


def _rms(errors: list[NDArray]) -> tuple[float, float] | None:
    squares = np.concatenate([np.zeros((2, 0)), *errors], axis=1) ** 2
    if not squares.shape[1]:
        return None
    before, after = 60.0 * np.sqrt(squares.mean(axis=1))
    return float(before), float(after)


def _deployed(shown) -> NDArray[np.float64]:
    """(3, 3) what the slots of a model would add; zeros where nothing is found."""
    slots = slots_of(InMotion(shown))
    return np.array([s.coefficient_dps for s in slots]).T if slots else np.zeros((3, 3))


def has_attitude(path: Path) -> bool:
    """Whether a recording has the columns of one."""
    return attitude_names(open_recording(path, keep_gaps=True).column_names) is not None


def _lost(one: Moving, matrix: NDArray) -> NDArray[np.float64]:
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
    ends, second = _stretches(one, seen), round(1.0 / one.dt_s)
    steps = [(a, a + second) for a in range(0, len(seen) - second, second)]
    steps = [(a, b) for a, b in steps if seen[a] and seen[b]]
    if not ends or not steps:
        return np.zeros(0)
    frame, _ = Rotation.align_vectors(*(_turned(q, steps).as_rotvec() for q in (attitude, ours)))
    first = Rotation.from_quat(attitude[[a for a, _ in ends]][:, _W_LAST])
    left = first * _turned(attitude, ends) * (frame * _turned(ours, ends) * frame.inv()).inv()
    return np.degrees((left * first.inv()).as_rotvec()[:, 2]) / _STRETCH_S


def _turned(attitude: NDArray, ends: list[tuple[int, int]]) -> Rotation:
    """From the first to the last sample of each pair, in the body's frame."""
    first, last = (Rotation.from_quat(attitude[list(at)][:, _W_LAST]) for at in zip(*ends))
    return first.inv() * last


def _stretches(one: Moving, seen: NDArray) -> list[tuple[int, int]]:
    """First and last sample of stretches that move, one after the other, seen at both ends."""
    n = round(_STRETCH_S / one.dt_s)
    every = [(a, a + n) for a in range(0, len(one.rate) - n, n)]
    spread = [np.degrees(np.sqrt(one.rate[a:b].var(axis=0).sum())) for a, b in every]
    whole = [abs(one.at_s[b] - one.at_s[a] - _STRETCH_S) < 1.0 for a, b in every]
    return [
        (a, b)
        for (a, b), dps, is_whole in zip(every, spread, whole)
        if dps > LEAST_DPS and is_whole and seen[a] and seen[b]
    ]
