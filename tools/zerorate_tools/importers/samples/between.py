"""Readings of slower sensors, put at the times of the samples."""

from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from ...errors import BadRecording
from ...numbers import duration
from ...recordings.recording import ACCEL, COLUMNS, GYRO, TEMP, Columns
from .clock import longest_us
from .spool import PLACE, TIME, Spool

SAID = {"ax": "acceleration", TEMP: "temperature"}
#: Steps of each piece that are looked at; so many of all are no gap, however unsteady a sensor is.
_LOOKED_AT, _USUAL = 1000, 0.9
_TOGETHER_US, _TOGETHER = 5e6, 0.02


def refuse_two_recordings(spool: Spool, path: Path, counted: bool) -> None:
    """Raise BadRecording where the files of a folder hold rates and forces of other times: those of
    one recording begin and end together. counted: rows are the times, so there are as many."""
    rates, force = spool.span_us("gx"), spool.span_us("ax")
    if rates is None or force is None:
        return
    within = 0.0 if counted else max(_TOGETHER_US, _TOGETHER * (rates[1] - rates[0]))
    if max(abs(one - other) for one, other in zip(rates, force)) > within:
        problem = (
            "its rates and its acceleration do not begin and end together, as in one recording"
        )
        other = "leave out --hz if they have times; else " if counted else ""
        raise BadRecording(path, problem, do=f"{other}import the file of the gyroscope alone")


class Bridged:
    """The samples of a spool, with what lacks a reading of its own on a line between those around.

    Where a column has a gap, by its own usual interval, no line spans it: its samples are dropped.
    stretches: by column, the longest time in microseconds that such a line spans.
    """

    def __init__(self, spool: Spool) -> None:
        self._spool = spool
        self.stretches: dict[str, float] = {}
        self.dropped: Counter[str] = Counter()
        self._columns = self._bridged()
        self._after = {name: _next_readings(self._spool, name) for name in self._columns}
        self._longest_us = {
            name: longest_us(_usual_us(self._spool, name)) for name in self._columns
        }

    def __iter__(self) -> Iterator[dict[str, np.ndarray]]:
        """Columns of each piece's samples, none NaN but those of extra channels."""
        before: dict[str, tuple[float, float]] = {}
        for number, columns in enumerate(self._spool):
            whole = np.isfinite(columns["gx"])
            for name in self._columns:
                ends = self._spool.pieces[number].ends.get(name)
                columns[name] = self._line(
                    name, columns, whole, before.get(name), self._after[name][number]
                )
                if ends:
                    before[name] = ends[1]
            yield self._near_enough({name: values[whole] for name, values in columns.items()})

    def notes(self) -> list[str]:
        """What was put on lines, and how long those were."""
        return [
            f"{SAID.get(name, name)} interpolated between its readings, over at most "
            f"{duration(stretch * 1e-6)}"
            for name, stretch in self.stretches.items()
            if name not in ACCEL[1:]
        ]

    def _bridged(self) -> list[str]:
        """The columns of which samples lack readings."""
        names = [name for name in self._spool.names if name not in (PLACE, TIME, *GYRO)]
        lacking, own = set(), set()
        for columns in self._spool:
            for name in names:
                there = np.isfinite(columns[name][np.isfinite(columns["gx"])])
                lacking |= set() if there.all() else {name}
                own |= {name} if there.any() else set()
        # a further channel may have gaps; where it never comes with a sample it has its own rows
        return [n for n in names if n in lacking and (n in COLUMNS or n not in own)]

    def _line(
        self,
        name: str,
        columns: Columns,
        whole: np.ndarray,
        before: tuple[float, float] | None,
        after: tuple[float, float] | None,
    ) -> np.ndarray:
        t_us, values = columns[TIME], columns[name]
        there = np.isfinite(values)
        at, readings = t_us[there], values[there]
        if before is not None:
            at, readings = np.append(before[0], at), np.append(before[1], readings)
        if after is not None:
            at, readings = np.append(at, after[0]), np.append(readings, after[1])
        lacking = whole & ~there
        filled = values.copy()
        filled[lacking] = np.interp(t_us[lacking], at, readings)
        spans = _spans(t_us, at)
        filled[lacking & (spans > self._longest_us[name])] = np.nan
        bridged = spans[lacking & np.isfinite(filled)]
        if bridged.any():
            self.stretches[name] = max(self.stretches.get(name, 0.0), float(bridged.max()))
        return filled

    def _near_enough(self, columns: Columns) -> Columns:
        """Less the samples that lie in a gap of the acceleration or of the temperature."""
        for group in (ACCEL, (TEMP,)):
            if group[0] in columns:
                good = np.isfinite([columns[name] for name in group]).all(axis=0)
                self.dropped[group[0]] += int((~good).sum())
                columns = {name: values[good] for name, values in columns.items()}
        return columns


def _spans(t_us: np.ndarray, at: np.ndarray) -> np.ndarray:
    """(n,) microseconds between the two of the sorted `at` around each time; before the first and
    after the last, to that one."""
    ends = np.concatenate([[np.nan], at, [np.nan]])
    spans = ends[np.searchsorted(at, t_us) + 1] - ends[np.searchsorted(at, t_us, "right")]
    return np.where(np.isnan(spans), np.maximum(at[0] - t_us, t_us - at[-1]), spans)


def _usual_us(spool: Spool, name: str) -> float:
    """The time from one reading of a column to the next that few exceed."""
    usual, last = [], np.empty(0)
    for columns in spool:
        at = columns[TIME][np.isfinite(columns[name])]
        steps = np.diff(np.concatenate([last, at]))
        usual.append(steps[:_LOOKED_AT])
        last = at[-1:] if len(at) else last
    every = np.concatenate([np.empty(0), *usual])
    return float(np.quantile(every, _USUAL)) if len(every) else 0.0


def _next_readings(spool: Spool, name: str) -> list[tuple[float, float] | None]:
    """For each piece, the first reading of a column in those after it."""
    out: list[tuple[float, float] | None] = []
    following = None
    for piece in reversed(spool.pieces):
        out.append(following)
        following = piece.ends[name][0] if name in piece.ends else following
    return out[::-1]
