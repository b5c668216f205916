"""Rows of several devices that take turns, and nobody says whose a row is."""

from pathlib import Path

import numpy as np

from ...errors import BadRecording

#: Devices that a loop reads one after the other.
_MOST_DEVICES = 8
#: Rows that are looked at together: a whole number of cycles of nearly any number of devices.
_BLOCK = 120
#: Levels scatter more than that many times the rows of each: three standard deviations apart for
#: two devices, where a row nearly always tells whose it is.
_APART = 1.5
#: Of the stretches; a device that shakes at a fraction of its rate does not do so throughout.
_MOST_STRETCHES = 0.5
_GOES_ON = 0.95
#: Of the largest reading, what the decomposition itself may be off.
_ROUNDING, _TINY = 1e-9, 1e-300


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
    """How many devices take turns by the levels of their rows; 0 where none is told apart.

    stretches: (rows, columns) each.
    """
    blocks = [
        rows[at : at + _BLOCK]
        for rows in stretches
        for at in range(0, len(rows) - _BLOCK + 1, _BLOCK)
    ]
    whole = [block for block in blocks if np.isfinite(block).all()]
    for devices in range(2, _MOST_DEVICES + 1) if whole else ():
        told = sum(_apart(block, devices) > _APART for block in whole)
        if told > _MOST_STRETCHES * len(whole):
            return devices
    return 0


def _apart(block: np.ndarray, devices: int) -> float:
    """How far the levels of each row of a cycle are apart, in what its rows scatter about them: a
    seasonal decomposition, whose moving mean holds every device alike and any steady change."""
    ends = [0.5] if devices % 2 == 0 else []
    weights = np.array([*ends, *[1.0] * (devices - len(ends)), *ends]) / devices
    half = len(weights) // 2
    trend = np.apply_along_axis(np.convolve, 0, block, weights, "valid")
    rest = block[half : len(block) - half] - trend
    cycles = len(rest) // devices
    rest = rest[: cycles * devices].reshape(cycles, devices, -1)
    levels = rest.mean(axis=0)
    scatter = ((rest - levels) ** 2).sum(axis=(0, 1)) / (devices * (cycles - 1))
    between = levels.var(axis=0) - scatter / cycles
    rounding = (_ROUNDING * np.abs(block).max(axis=0)) ** 2
    return float(
        np.sqrt((np.maximum(between - rounding, 0.0) / (scatter + rounding + _TINY)).sum())
    )
