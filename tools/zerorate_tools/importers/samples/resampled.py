"""Whether the rows of a log lie on lines between readings of a slower clock, by a likelihood ratio.

Each reading has noise that those around it do not tell. Of n rows on lines between readings at a
period of r rows, n - n / r are told by the others: once what rows have in common is taken off all,
lines with knots at that period leave nothing, at one phase. Of readings they leave that noise.
"""

from collections.abc import Iterator

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

#: Rows of a block; so few blocks tell nothing, and so many enough.
_BLOCK, _FEWEST, _MOST = 64, 8, 64
#: Rows to a reading. Fewer leave too few rows too many, and of more a block has too few.
_PERIODS = (1.07, 2.2)
_PHASES = 6
#: Nats for it in half of the blocks.
_SURE = 20.0


def base_period(frame: np.ndarray, digits: np.ndarray) -> float:
    """Rows to a reading of (4, n) times and rates of that many digits, that were resampled from
    fewer; 0 where they were not."""
    found, every, unsure = 0.0, 1, 0
    # lines of a period are lines of its half, too: two in a row without them rule out longer ones
    while frame.shape[1] >= every * _BLOCK * _FEWEST and unsure < 2:
        nats, period = evidence(frame[:, ::every], digits)
        found = every * period if nats > _SURE else found
        unsure = 0 if nats > _SURE else unsure + 1
        every *= 2
    return found


def evidence(frame: np.ndarray, digits: np.ndarray) -> tuple[float, float]:
    """Nats for lines between readings in the median block, at the likeliest period, and that."""
    steps = np.diff(frame[0])
    even = sliding_window_view(steps < 1.5 * np.median(steps), _BLOCK - 1).all(axis=1)
    starts = np.flatnonzero(even)
    if len(starts) < _BLOCK * (_FEWEST - 1):
        return 0.0, 0.0
    counts = frame[1:].T / digits
    some = starts[np.linspace(0, len(starts) - 1, min(len(starts) // _BLOCK, _MOST)).astype(int)]
    blocks = counts[some + np.arange(_BLOCK)[:, None]].reshape(_BLOCK, -1)
    taken_off = _taken_off(counts, starts)
    news = taken_off @ (blocks - blocks.mean(axis=0))
    # digits are rounded: of their square some 1/4 is noise of any row
    rounded = (taken_off**2).sum() / 4 / _BLOCK
    usual = (np.median(abs(news), axis=0) / 0.6745) ** 2 + rounded
    return max((_nats(news, usual, rounded, left), period) for period, left in _lines(taken_off))


def _taken_off(counts: np.ndarray, starts: np.ndarray) -> np.ndarray:
    """(_BLOCK, _BLOCK) what makes noise of rows that have something in common."""
    windows = sliding_window_view(counts, _BLOCK, axis=0)[starts[:: 1 + len(starts) // 20000]]
    windows = (windows - windows.mean(axis=2, keepdims=True)) / (counts.std(axis=0)[:, None] + 1)
    flat = windows.reshape(-1, _BLOCK)
    common = flat.T @ flat
    common += 1e-9 * (1 + np.trace(common)) * np.eye(_BLOCK) + common.max()
    return np.linalg.inv(np.linalg.cholesky(common))


def _nats(news: np.ndarray, usual: np.ndarray, rounded: float, phases: list[np.ndarray]) -> float:
    """The log likelihood ratio of the best phase to the usual noise and to the opposite phase,
    which is as far from the rows: lines through rows fit what is smooth better than others."""
    left = [((left @ news) ** 2).mean(axis=0) + rounded for left in phases]
    noise = (np.array(left) / usual).reshape(len(phases), -1, 3).mean(axis=2)
    opposite = np.roll(noise, len(phases) // 2, axis=0)
    best = noise.argmin(axis=0)[np.newaxis]
    least, other = (np.take_along_axis(one, best, axis=0) for one in (noise, opposite))
    return 1.5 * len(phases[0]) * float(np.median(np.log(np.minimum(1, other) / least)))


def _lines(taken_off: np.ndarray) -> Iterator[tuple[float, list[np.ndarray]]]:
    """Each period and, for each phase of its knots, what is orthogonal to lines between these."""
    rows, period = np.arange(_BLOCK), _PERIODS[0]
    while period < _PERIODS[1]:
        phases = []
        for phase in np.arange(_PHASES) / _PHASES:
            knots = np.arange(-1, _BLOCK / period + 2) + phase
            hats = np.maximum(1 - np.abs(rows[:, None] / period - knots), 0)
            lines = taken_off @ hats[:, hats.any(axis=0)]
            phases.append(np.linalg.qr(lines, mode="complete")[0][:, lines.shape[1] :].T)
        yield period, phases
        # the last knot then moves by no more than it may be off
        period += 0.5 * period**2 / _BLOCK
