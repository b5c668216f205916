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
                row = _first_row(table, plan, axes, factor)
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


def _first_row(table: Table, plan: Plan, axes: tuple[str, ...], factor: float) -> int:
    """The 1-based row at which readings grow by most of the factor."""
    before = np.nan
    for chunk in table.chunks(plan.columns):
        columns = plan.physical(chunk)
        size = np.linalg.norm([columns[name] for name in axes], axis=0)
        grown = np.log(size / np.concatenate([[before], size[:-1]])) / np.log(factor)
        if (grown > 0.5).any():
            return int(chunk.place[np.argmax(grown > 0.5)]) + 1
        before = size[-1] if len(size) else before
    return 1
