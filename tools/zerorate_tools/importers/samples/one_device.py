"""Rows that are not of one device in one unit: devices that take turns, a unit that changes."""

from pathlib import Path

import numpy as np

from ...errors import BadRecording
from ...recordings.recording import ACCEL, GYRO
from ..columns.plan import Plan
from ..columns.units import ACCEL_G, RATE_DPS
from ..report import cut_words
from ..tables.table import Table

#: Devices that a loop reads one after the other.
_MOST_DEVICES = 8
#: Rows that are looked at together: a whole number of cycles of nearly any number of devices.
_BLOCK = 120
#: Levels scatter more than that many times the rows of each: three standard deviations apart for
#: two devices, where a row nearly always tells whose it is.
_APART = 1.5
_GOES_ON = 0.95
#: Blocks that levels stay for, and how alike they are then at least: the cosine between them.
_LAGS, _ALIKE = 4, 0.5
#: Of the largest reading, what the decomposition itself may be off.
_ROUNDING, _TINY = 1e-9, 1e-300
#: Samples that are compared: at either end, and before and after a change.
_STRETCH = 100
#: From one sample to the next, of what is at rest; of the length of the force, as it has no unit.
_UNSHAKEN = 0.02
#: What both level and noise of one sensor keep, whatever it warms.
_WITHIN = 1.4
#: Standard errors of a level, within which it is the same.
_SURE = 5.0
_UNITS = {GYRO: RATE_DPS, ACCEL: ACCEL_G}


def refuse_turns(stretches: list[dict[str, np.ndarray]], names: list[str], path: Path) -> None:
    """Raise BadRecording where it depends on a row's number at which level or time it is: in the
    samples of one device nothing does. stretches: consecutive rows, each with t_us and names."""
    for time in (stretch["t_us"] for stretch in stretches):
        if devices := clocks_in_turn(time):
            raise _refused(devices, "time goes back and forth from row to row", path)
    rows = [np.column_stack([stretch[name] for name in names]) for stretch in stretches]
    if devices := levels_in_turn(rows):
        raise _refused(devices, "the readings change their level from row to row", path)


def _refused(devices: int, why: str, path: Path) -> BadRecording:
    problem = f"rows of {devices} devices take turns: {why}"
    do = "write the rows of each into a file of its own, or add a column `device` and give "
    return BadRecording(path, problem, do=f"{do}--instance 0 to {devices - 1}")


def clocks_in_turn(t_us: np.ndarray) -> int:
    """How many clocks take turns; 0 where there is one. Each goes on from its own last row, and one
    is behind the row before by more than that step."""
    for devices in range(2, _MOST_DEVICES + 1):
        steps = t_us[devices:] - t_us[:-devices]
        if len(steps) < _BLOCK // 2 or (steps >= 0).mean() < _GOES_ON:
            continue
        back = np.diff(t_us) < -max(float(np.median(steps)), 0.0)
        if back.mean() > 0.5 / devices:
            return devices
    return 0


def levels_in_turn(stretches: list[np.ndarray]) -> int:
    """How many devices take turns by the levels of their rows; 0 where none is told apart in half
    of the blocks: a device that shakes at a fraction of its rate does not do so throughout.

    stretches: (rows, columns) each.
    """
    blocks = [r[at : at + _BLOCK] for r in stretches for at in range(0, len(r), _BLOCK)]
    whole = [block for block in blocks if len(block) == _BLOCK and np.isfinite(block).all()]
    if not whole:
        return 0
    counts = range(2, _MOST_DEVICES + 1)
    apart = {n: float(np.median([_apart(block, n) for block in whole])) for n in counts}
    # twice as many tell no more, and half as many much less
    least = max(_APART, max(apart.values()) / 2)
    return next((n for n in counts if apart[n] > least and _stay(stretches, n)), 0)


def _stay(stretches: list[np.ndarray], devices: int) -> bool:
    """Whether the levels of the rows of a cycle are the same from block to block: what shakes a
    device at a fraction of its rate, as a stepper does, is no clock, and its phase wanders."""
    alike: dict[int, list[float]] = {lag: [] for lag in range(1, _LAGS + 1)}
    size = _BLOCK // devices * devices
    for rows in (rows for rows in stretches if len(rows) >= 2 * size):
        starts = range(0, len(rows) - size + 1, size)
        blocks = (_levels(rows[at : at + size], devices)[0] for at in starts)
        levels = np.array([block.ravel() for block in blocks])
        for lag, found in alike.items():
            one, other = levels[:-lag], levels[lag:]
            lengths = np.sqrt((one**2).sum(axis=-1) * (other**2).sum(axis=-1))
            found += [*((one * other).sum(axis=-1) / np.maximum(lengths, _TINY))]
    return all(np.nanmedian(found or [1.0]) > _ALIKE for found in alike.values())


def _apart(block: np.ndarray, devices: int) -> float:
    """How far the levels of each row of a cycle are apart, in what its rows scatter about them."""
    levels, scatter, cycles = _levels(block, devices)
    between = levels.var(axis=0) - scatter / cycles
    rounding = (_ROUNDING * np.abs(block).max(axis=0)) ** 2
    return float(
        np.sqrt((np.maximum(between - rounding, 0.0) / (scatter + rounding + _TINY)).sum())
    )


def _levels(block: np.ndarray, devices: int) -> tuple[np.ndarray, np.ndarray, int]:
    """Levels of each row of a cycle, the square by which its rows scatter about them, and how many
    cycles: a seasonal decomposition, whose moving mean holds every device alike and any steady
    change."""
    ends = [0.5] if devices % 2 == 0 else []
    weights = np.array([*ends, *[1.0] * (devices - len(ends)), *ends]) / devices
    half = len(weights) // 2
    trend = np.apply_along_axis(np.convolve, 0, block, weights, "valid")
    rest = block[half : len(block) - half] - trend
    cycles = len(rest) // devices
    rest = rest[: cycles * devices].reshape(cycles, devices, -1)
    levels = rest.mean(axis=0)
    return levels, ((rest - levels) ** 2).sum(axis=(0, 1)) / (devices * (cycles - 1)), cycles


def refuse_change_of_unit(
    stretches: list[dict[str, np.ndarray]], plan: Plan, table: Table, path: Path
) -> None:
    """Raise BadRecording where readings grow or shrink by the factor of a unit at some row, and are
    so at the end. stretches: samples in the file's order."""
    for axes, units in _UNITS.items():
        if not stretches or not all(axis in plan.wanted for axis in (*axes, *ACCEL)):
            continue
        every = np.concatenate([[s[axis] for axis in axes] for s in stretches], axis=1)
        sizes = np.linalg.norm(every[:, np.isfinite(every).all(axis=0)], axis=0)
        if not len(sizes):
            continue
        with np.errstate(divide="ignore", invalid="ignore"):
            grown = np.log(np.median(sizes[-_STRETCH:]) / np.median(sizes[:_STRETCH]))
        for factor in _factors(units):
            near = abs(grown - np.log(factor)) < np.log(_WITHIN)
            if near and (row := _row_of_change(table, plan, axes, factor)):
                problem = f"the unit of {', '.join(axes)} changes: from there on all is "
                problem += f"{factor:.4g} times as large"
                raise BadRecording(path, problem, row=row, do=cut_words(path, row))


def _factors(units: dict[str, float]) -> list[float]:
    """Of every unit in every other, where it is no hair's breadth."""
    every = {one / other for one in units.values() for other in units.values()}
    return [factor for factor in sorted(every) if abs(np.log(factor)) > 2 * np.log(_WITHIN)]


def _row_of_change(table: Table, plan: Plan, axes: tuple[str, ...], factor: float) -> int:
    """The 1-based row at which readings grow by the factor; 0 where no row shows that.

    There, from one row to the next, every axis' level and the noise grow by it, and the force does
    not change: motion that begins or ends does none of that.
    """
    with table.looked_at() as chunks, np.errstate(divide="ignore", invalid="ignore"):
        for chunk in chunks(plan.columns):
            columns = plan.physical(chunk)
            size = np.linalg.norm([columns[name] for name in axes], axis=0)
            jumps = np.flatnonzero(np.diff(np.log(size)) / np.log(factor) > 0.5) + 1
            if len(jumps):
                at = int(jumps[0])
                return int(chunk.place[at]) + 1 if _is_scaled(columns, axes, at, factor) else 0
    return 0


def _is_scaled(columns: dict[str, np.ndarray], axes: tuple[str, ...], at: int, by: float) -> bool:
    """Whether the rows on both sides of one are the same sensor's at rest, in other numbers."""
    values = np.array([columns[name] for name in axes])
    force = np.array([columns[name] for name in ACCEL])
    if not _STRETCH <= at <= values.shape[1] - _STRETCH:
        return False
    sides = slice(at - _STRETCH, at), slice(at, at + _STRETCH)
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
