"""Rows that somebody put on straight lines between others: a gap filled, or a log resampled."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from ...errors import BadRecording
from ...recordings.recording import GYRO
from .spool import TIME, Spool

#: Rows of a block; so few blocks tell nothing, and so many enough.
_BLOCK, _FEWEST, _MOST = 64, 8, 64
#: Rows to a reading. Fewer leave too few rows too many, and of more a block has too few.
_PERIODS = (1.07, 2.2)
_PHASES = 6
#: Nats for it in half of the blocks.
_SURE = 20.0


def base_period(frame: np.ndarray, digits: np.ndarray) -> float:
    """Rows to a reading of (4, n) times and rates of that many digits, that were resampled from
    fewer; 0 where they were not: by a likelihood ratio.

    Each reading has noise that those around it do not tell. Of n rows on lines between readings at
    a period of r rows, n - n / r are told by the others: once what rows have in common is taken off
    all, lines with knots at that period leave nothing, at one phase. Of readings they leave that
    noise.
    """
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


#: Of a step, that much is lost where times are dates of seconds since 1970.
_OF_STEP = 1e-4
#: Steps of so many digits tell a line; what is off it by so many is none.
_CLEARLY = 8.0
#: Noise puts some rows near a line, and by chance one of so many upon it.
_BETWEEN, _BY_CHANCE, _RUN = 0.05, 0.01, 5
#: Rows that are on no line are as many as the readings, where they are these; else twice as many,
#: or half as many more where every other reading is on a row.
_TOO_MANY = 1.25


@dataclass
class _Seen:
    """Rows of a log by where they lie; on, near, off: of those whose neighbours differ."""

    rows: int = 0
    lines: int = 0
    on: int = 0
    near: int = 0
    off: int = 0
    longest: int = 0

    def add(self, off: np.ndarray, moves: np.ndarray) -> None:
        on = (off <= 1.0) & moves
        self.rows += len(off)
        self.lines += int((off <= 1.0).sum())
        self.on += int(on.sum())
        self.off += int((moves & (off > _CLEARLY)).sum())
        self.near += int((moves & ~on & (off <= _CLEARLY)).sum())
        edges = np.flatnonzero(np.diff(on, prepend=False, append=False))
        self.longest = max(self.longest, int(np.diff(edges)[::2].max(initial=0)))

    @property
    def are_lines(self) -> bool:
        two_kinds = self.near < _BETWEEN * self.off
        return two_kinds and (self.on > _BY_CHANCE * self.rows or self.longest >= _RUN)


def without_lines(spool: Spool, path: Path) -> tuple[Spool, int]:
    """The rows that lie on no line between those around them, and how many did; the spool itself
    where none did. Raises BadRecording where a line's ends are no readings either."""
    digits = _digits(spool)
    seen = _Seen()
    for _, off, moves in _pieces(spool, digits):
        seen.add(off, moves)
    first = _frame(spool.read(0)) if spool.pieces else np.empty((4, 0))
    period = base_period(first, digits)
    left = seen.rows - seen.lines
    if period and not (seen.are_lines and left * period <= _TOO_MANY * seen.rows):
        problem = (
            f"its rows lie on lines between {100 / period:.0f} % as many, as of a resampled log"
        )
        raise BadRecording(path, problem, do="import the log as the sensor wrote it")
    if not seen.are_lines:
        return spool, 0
    return spool.remade(_off_lines(spool, digits)), seen.lines


def _off_lines(spool: Spool, digits: np.ndarray) -> Iterator[dict[str, np.ndarray]]:
    for columns, off, _ in _pieces(spool, digits):
        drop = np.flatnonzero(np.isfinite(columns["gx"]))[off <= 1.0]
        yield {name: np.delete(values, drop) for name, values in columns.items()}


def _pieces(
    spool: Spool, digits: np.ndarray
) -> Iterator[tuple[dict[str, np.ndarray], np.ndarray, np.ndarray]]:
    """Columns of each piece; of its samples, how far each is off the line through its neighbours,
    by what digits lose, and whether these differ. What has no two is off it."""
    before = _frame({name: np.empty(0) for name in (TIME, *GYRO)})
    for number, columns in enumerate(spool):
        frame = _frame(columns)
        more = number + 1 < len(spool.pieces)
        after = _frame(spool.read(number + 1))[:, :1] if more else frame[:, :0]
        off, moves = _off_line(np.hstack([before, frame, after]), digits)
        first = before.shape[1]
        yield columns, off[first : first + frame.shape[1]], moves[first : first + frame.shape[1]]
        before = np.hstack([before, frame])[:, -1:]


def _frame(columns: dict[str, np.ndarray]) -> np.ndarray:
    """(4, n) time and rates of the samples."""
    frame = np.array([columns[name] for name in (TIME, *GYRO)])
    return frame[:, np.isfinite(frame).all(axis=0)]


def _off_line(frame: np.ndarray, digits: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    off, moves = np.full(frame.shape[1], np.inf), np.zeros(frame.shape[1], bool)
    t_us, rates = frame[0], frame[1:]
    step, from_first = rates[:, 2:] - rates[:, :-2], rates[:, 1:-1] - rates[:, :-2]
    lost = digits[:, None] + _OF_STEP * np.abs(step)
    by_time = np.diff(t_us)[:-1] / np.maximum(t_us[2:] - t_us[:-2], 1e-9)
    ways = [(np.abs(from_first - w * step) / lost).max(axis=0) for w in (by_time, 0.5)]
    off[1:-1] = np.minimum(*ways)
    moves[1:-1] = (np.abs(step) > _CLEARLY * digits[:, None]).all(axis=0)
    return off, moves


def _digits(spool: Spool) -> np.ndarray:
    """(3,) the least by which readings of an axis differ."""
    rates = _frame(spool.read(0))[1:] if spool.pieces else np.empty((3, 0))
    steps = [np.diff(np.unique(axis)) for axis in rates]
    return np.array([s[s > 1e-9 * s.max()].min() if s.any() else 1.0 for s in steps])
