"""A unit that changes within a log: the same sensor at rest, and all its numbers are others."""

from pathlib import Path

import numpy as np

from ...errors import BadRecording
from ...recordings.recording import ACCEL, GYRO
from ..columns.plan import Plan
from ..columns.units import ACCEL_G, RATE_DPS
from ..report import cut_words
from ..tables.table import Table

#: Samples of a stretch at rest, and the stretches at either end that are compared.
_STRETCH, _COMPARED = 100, 3
#: From one sample to the next, of what is at rest; of the length of the force, as it has no unit.
_UNSHAKEN = 0.02
#: What both level and noise of one sensor keep, whatever it warms.
_WITHIN = 1.4
#: Standard errors of a level, within which it is the same.
_SURE = 5.0
_UNITS = {GYRO: RATE_DPS, ACCEL: ACCEL_G}


def refuse_change_of_unit(
    stretches: list[dict[str, np.ndarray]], plan: Plan, table: Table, path: Path
) -> None:
    """Raise BadRecording where readings at rest are at the end by the factor of a unit larger or
    smaller than at the beginning, their noise with them. stretches: samples in the file's order."""
    for axes, units in _UNITS.items():
        if not all(axis in plan.wanted for axis in (*axes, *ACCEL)):
            continue
        rests = [rest for stretch in stretches for rest in _rests(stretch, axes)]
        if len(rests) < 2 * _COMPARED:
            continue
        first, last = (np.median(part, axis=0) for part in (rests[:_COMPARED], rests[-_COMPARED:]))
        with np.errstate(divide="ignore", invalid="ignore"):
            grown = last / first
        for factor in _factors(units):
            if (np.abs(np.log(grown / factor)) < np.log(_WITHIN)).all():
                row = _row_of_change(table, plan, axes, factor)
                if not row:
                    continue
                problem = f"the unit of {', '.join(axes)} changes: from there on all is "
                problem += f"{factor:.4g} times as large"
                raise BadRecording(path, problem, row=row, do=cut_words(path, row))


def _factors(units: dict[str, float]) -> list[float]:
    """Of every unit in every other, where it is no hair's breadth."""
    every = {one / other for one in units.values() for other in units.values()}
    return [factor for factor in sorted(every) if abs(np.log(factor)) > 2 * np.log(_WITHIN)]


def _rests(stretch: dict[str, np.ndarray], axes: tuple[str, ...]) -> list[tuple[float, float]]:
    """(usual length, noise) of the readings of each stretch in which the force stands still."""
    values = np.array([stretch[name] for name in axes])
    force = np.array([stretch[name] for name in ACCEL])
    out = []
    for at in range(0, values.shape[1] - _STRETCH + 1, _STRETCH):
        seen, still = values[:, at : at + _STRETCH], force[:, at : at + _STRETCH]
        usual = float(np.linalg.norm(np.median(still, axis=1)))
        if np.median(np.abs(np.diff(still, axis=1))) < _UNSHAKEN * usual:
            noise = float(np.median(np.abs(np.diff(seen, n=2, axis=1))))
            out.append((float(np.linalg.norm(np.median(seen, axis=1))), noise))
    return out


def _row_of_change(table: Table, plan: Plan, axes: tuple[str, ...], factor: float) -> int:
    """The 1-based row at which readings grow by the factor; 0 where no row shows that.

    There, from one row to the next, every axis' level and the noise grow by it, and the force does
    not change: motion that begins or ends does none of that.
    """
    before = np.nan
    for chunk in table.chunks(plan.columns):
        columns = plan.physical(chunk)
        size = np.linalg.norm([columns[name] for name in axes], axis=0)
        with np.errstate(divide="ignore", invalid="ignore"):
            grown = np.log(size / np.concatenate([[before], size[:-1]])) / np.log(factor)
        at = int(np.argmax(grown > 0.5))
        if len(grown) and grown[at] > 0.5:
            return int(chunk.place[at]) + 1 if _is_scaled(columns, axes, at, factor) else 0
        before = size[-1] if len(size) else before
    return 0


def _is_scaled(columns: dict[str, np.ndarray], axes: tuple[str, ...], at: int, by: float) -> bool:
    """Whether the rows on both sides of one are the same sensor's at rest, in other numbers."""
    values = np.array([columns[name] for name in axes])
    force = np.array([columns[name] for name in ACCEL])
    sides = slice(max(0, at - _STRETCH), at), slice(at, at + _STRETCH)
    if at < _STRETCH or at + _STRETCH > values.shape[1]:
        return False
    one, other = values[:, sides[0]], values[:, sides[1]] / by
    noise = [float(np.median(np.abs(np.diff(side, n=3, axis=1)))) for side in (one, other)]
    level = [np.median(side, axis=1) for side in (one, other)]
    unsure = max(noise) / np.sqrt(_STRETCH)
    told = np.linalg.norm(level[0]) > _SURE * unsure
    same = (np.abs(level[1] - level[0]) < _SURE * unsure).all()
    alike = min(noise) > 0 and max(noise) < _WITHIN * min(noise)
    still = [np.median(force[:, side], axis=1) for side in sides]
    still[1] = still[1] / (by if axes == ACCEL else 1.0)
    stands = np.linalg.norm(still[1] - still[0]) < _UNSHAKEN * np.linalg.norm(still[0])
    return bool(told and same and alike and stands)
