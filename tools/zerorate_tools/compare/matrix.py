"""What the matrix of scale factors and axes would win, from the logs alone: their own motion."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from ..loop.motion.by_gravity import by_gravity
from ..loop.motion.in_motion import InMotion, slots_of
from ..loop.motion.matrix import beside
from ..loop.motion.same_device import DifferentDevices
from ..loop.motion.windows import LEAST_DPS, Moving, moving_of
from ..loop.read.reference import Reference, attitude_names
from ..recordings import open_recording
from ..recordings.recording import TIME
from ..simulate.attitude import IDENTITY, integrate

WITHOUT, WITH = "without the matrix", "with the matrix that gravity shows"
#: Headings are told over stretches of this length: filters with a magnetometer forget as soon.
_STRETCH_S = 30.0
_W_LAST = [1, 2, 3, 0]


@dataclass(frozen=True)
class Won:
    """tilt: degrees a minute of windows left out, without and with; heading: the same of heading
    against the given attitude, None without one; deployed: whether `close` would deploy it;
    refused: why the logs are not of one device, "" where they are.
    """

    tilt: tuple[float, float] = (float("nan"), float("nan"))
    heading: tuple[float, float] | None = None
    deployed: bool = False
    refused: str = ""

    def sentence(self) -> str:
        """What it would win, in one sentence."""
        if self.refused:
            return f"In motion: {self.refused}."
        before, after = self.tilt
        if not self.deployed:
            return (
                f"In motion gravity sees {before:.2f} deg of tilt a minute on windows left out; "
                "it shows no matrix that would lower that."
            )
        more = "" if self.heading is None else f", and {_of(self.heading)} of heading"
        return (
            f"In motion the matrix would leave {after:.2f} of {before:.2f} deg of tilt a minute on "
            f"windows left out{more}: `zerorate close` deploys it."
        )

    def rows(self) -> list[tuple[str, str, str, str]]:
        """A row each, without and with: its name, tilt, heading, both in degrees a minute."""
        if self.refused:
            return []
        names = (WITHOUT, WITH) if self.deployed else (WITHOUT,)
        told = [f"{h:.2f}" for h in self.heading] if self.heading else ["no attitude"] * 2
        return [(n, f"{t:.2f}", h, "") for n, t, h in zip(names, self.tilt, told)]


def _of(pair: tuple[float, float]) -> str:
    return f"{pair[1]:.2f} of {pair[0]:.2f}"


def matrix_of(logs: Sequence[str | Path]) -> Won | None:
    """What the matrix of the logs' device would win; None where too little of them moves.

    Raises BadRecording.
    """
    moving = {Path(log): m for log in logs if (m := moving_of(log)) is not None}
    try:
        shown = by_gravity(list(moving.values()), [])
    except DifferentDevices as problem:
        return Won(refused=str(problem))
    if shown is None:
        return None
    found = bool(slots_of(InMotion(shown)))
    return Won((shown.before, shown.after), _headings(moving) if found else None, found)


def _headings(moving: dict[Path, Moving]) -> tuple[float, float] | None:
    """Degrees a minute, RMS over stretches; each log with the matrix of the others, a log alone
    its second half with that of its first."""
    errors = []
    for path, one in moving.items():
        others = [m for p, m in moving.items() if p != path]
        middle = len(one.rate) // 2
        shown = by_gravity(others or [_part(one, slice(0, middle))], [])
        judged = slice(0 if others else middle, None)
        attitude = _attitude(path)
        if attitude is not None:
            matrices = [np.zeros((3, 3)), _deployed(shown)]
            own = _part(one, judged)
            errors.append([_lost(own, m, attitude[judged]) for m in matrices])
    squares = np.concatenate(errors, axis=1) ** 2 if errors else np.zeros((2, 0))
    if not squares.shape[1]:
        return None
    before, after = 60.0 * np.sqrt(squares.mean(axis=1))
    return float(before), float(after)


def _part(one: Moving, span: slice) -> Moving:
    at_s = one.at_s[span]
    inside = (one.rests[:, 0] >= at_s[0]) & (one.rests[:, 0] <= at_s[-1])
    parts = {k: getattr(one, k)[span] for k in ("rate", "accel", "at_s", "usable")}
    return replace(one, rests=one.rests[inside], **parts)


def _deployed(shown) -> NDArray[np.float64]:
    """(3, 3) what the slots of a model would add; zeros where nothing is found."""
    slots = slots_of(InMotion(shown))
    return np.array([s.coefficient_dps for s in slots]).T if slots else np.zeros((3, 3))


def _attitude(path: Path) -> NDArray[np.float64] | None:
    """(n, 4) body to world, w first, NaN where it was not seen; None without the columns."""
    opened = open_recording(path, keep_gaps=True)
    if attitude_names(opened.column_names) is None:
        return None
    reference = Reference(opened.column_names, opened.scales.gyro_lsb_per_dps)
    parts = [reference.quaternions(b) for b in opened.batches(rows=1 << 18) if len(b[TIME])]
    return np.concatenate(parts)


def _lost(one: Moving, matrix: NDArray, attitude: NDArray) -> NDArray[np.float64]:
    """(k,) degrees of heading a second that each moving stretch loses against the attitude.

    The bias is what gravity finds beside the matrix; a constant turn between the attitude's frame
    and the sensor's is fitted.
    """
    fitted = beside(one, matrix)
    bias = np.zeros(3) if fitted is None else fitted.bias
    rate = np.degrees(one.rate - one.rate @ matrix.T - bias)
    ours, seen = integrate(rate, one.dt_s, IDENTITY), np.isfinite(attitude).all(axis=1)
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
