"""Rows that somebody put on straight lines between others: a gap filled, or a log resampled."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...errors import BadRecording
from ...recordings.recording import GYRO
from .spool import TIME, Spool

#: Of a step, that much is lost where times are dates of seconds since 1970.
_OF_STEP = 1e-4
#: Steps of so many digits tell a line; what is off it by so many is none.
_CLEARLY = 8.0
#: Noise puts some rows near a line, and by chance one of so many upon it.
_BETWEEN, _BY_CHANCE, _RUN = 0.05, 0.01, 5
#: Between lines stand a reading, or the two rows around each reading that is no row itself. Rows
#: lost by chance, and noise that lies on lines by chance, leave odd numbers of rows as often.
_LEAST_EVEN, _EVEN, _ODD = 20, 0.3, 0.1


@dataclass
class _Seen:
    """Rows of a log by where they lie; on, near, off: of those whose neighbours differ."""

    rows: int = 0
    lines: int = 0
    on: int = 0
    near: int = 0
    off: int = 0
    longest: int = 0
    stretches: int = 0
    even: int = 0
    odd: int = 0

    def add(self, off: np.ndarray, moves: np.ndarray) -> None:
        on = (off <= 1.0) & moves
        self.rows += len(off)
        self.lines += int((off <= 1.0).sum())
        self.on += int(on.sum())
        self.off += int((moves & (off > _CLEARLY)).sum())
        self.near += int((moves & ~on & (off <= _CLEARLY)).sum())
        self.longest = max(self.longest, int(_stretches(on).max(initial=0)))
        between = _stretches(off > 1.0)
        self.stretches += len(between)
        self.even += int((between % 2 == 0).sum())
        self.odd += int(((between % 2 == 1) & (between > 1)).sum())

    @property
    def are_lines(self) -> bool:
        two_kinds = self.near < _BETWEEN * self.off
        return two_kinds and (self.on > _BY_CHANCE * self.rows or self.longest >= _RUN)

    @property
    def ends_are_no_rows(self) -> bool:
        least = max(_LEAST_EVEN, _EVEN * self.stretches)
        return self.even >= least and self.odd <= _ODD * self.even


def without_lines(spool: Spool, path: Path) -> tuple[Spool, int]:
    """The rows that lie on no line between those around them, and how many did; the spool itself
    where none did. Raises BadRecording where a line's ends are no readings either."""
    digits = _digits(spool)
    seen = _Seen()
    for _, off, moves in _pieces(spool, digits):
        seen.add(off, moves)
    if seen.ends_are_no_rows:
        problem = "its rows lie on lines between readings that are no rows, as of a resampled log"
        raise BadRecording(path, problem, do="import the log as the sensor wrote it")
    if not seen.are_lines:
        return spool, 0
    return spool.remade(_off_lines(spool, digits)), seen.lines


def _stretches(where: np.ndarray) -> np.ndarray:
    """How long each stretch is in which it holds."""
    return np.diff(np.flatnonzero(np.diff(where, prepend=False, append=False)))[::2]


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
