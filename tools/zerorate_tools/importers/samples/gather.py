"""All rows of a table, told apart into samples and readings of slower sensors, into a spool."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ...errors import BadRecording
from ...numbers import counted
from ...recordings.recording import ACCEL, GYRO, TEMP, Columns
from ..columns.guesses import unit_words
from ..columns.plan import Plan, hz_words
from ..columns.units import TIME_S
from ..tables.table import Table
from . import clock
from .lines import without_lines
from .one_device import refuse_change_of_unit, refuse_turns
from .spool import PLACE, TIME, Runs, Spool, in_order

_KEPT = 200
_FAST_SHARE = 0.001
#: A bus that is late now and then repeats fewer rows.
_OFTEN_NEW = 0.8
_NO_TIME = "the time stamp is no number"
#: Times of the accelerations that are looked at.
FELT = "t_us of ax"
HELD = "the reading before once more, read faster than the sensor measures"


@dataclass
class Gathered:
    """The rows, by time, and what they have in common. largest: by kind (gyro, accel).
    looked_at: some hundred samples; where acceleration or temperature lacks some, readings of it
    that have times of their own, those of acceleration FELT."""

    spool: Spool
    rows: int
    samples: int
    interval_us: float
    largest: dict[str, float]
    dropped: Counter[str]
    notes: list[str]
    counted: bool = False
    looked_at: dict[str, np.ndarray] = field(default_factory=dict)


def gathered(
    table: Table, plan: Plan, path: Path, *, hz: float | None, fast_dps: float, folder: Path | None
) -> Gathered:
    """Read a table once. hz: counts the rows instead of time stamps. fast_dps: beyond it, a rate
    is none that a sensor of this kind measures. Raises BadRecording."""
    if TIME not in plan.wanted and not hz:
        raise BadRecording(path, "the source has no time stamps", do=f"give {hz_words(table)}")
    return _Gathering(table, plan, path, hz, fast_dps, folder).result()


def _are_held(rates: np.ndarray, t_us: np.ndarray) -> bool:
    """Whether rates often stand still and then change together while time goes on, as of a sensor
    that is read faster than it measures. On a coarse scale each stands still by itself, and at
    exactly zero a device holds them that hides its bias.

    rates: (3, n) of the first rows; t_us: (n,).
    """
    steps = np.diff(rates, axis=1)
    goes_on = np.isfinite(steps).all(axis=0) & (np.diff(t_us) != 0) & rates[:, 1:].any(axis=0)
    changed = steps[:, goes_on] != 0
    if not changed.size:
        return False
    some, every = changed.any(axis=0), changed.all(axis=0)
    return bool(some.any() and some.mean() < _OFTEN_NEW and every.sum() > 0.5 * some.sum())


#: Counts that are words of 16 bits, however a program printed their sign.
_BEYOND, _SPAN = 1 << 15, 1 << 16
#: Words with a sign turn from 32,767 to 32,768 at the end of the range, where readings are rare.
_MIDDLE, _MOST_IN_MIDDLE = (24_576, 40_960), 0.01
_KINDS = {"gyro": GYRO, "accel": ACCEL, "temp": (TEMP,)}


class Counts:
    """Gives counts that were printed without a sign theirs, and says what cannot be counts."""

    def __init__(self, raw: frozenset[str]) -> None:
        # the least, the most, how many are about the middle, and in all
        self._seen = dict.fromkeys(sorted(raw), (np.inf, 0.0, 0, 0))

    def signed(self, columns: dict[str, np.ndarray]) -> None:
        """Turn 32,768 to 65,535 into negative counts, in place."""
        for kind, (least, most, middle, size) in self._seen.items():
            there = {name: columns[name] for name in _KINDS[kind] if name in columns}
            every = np.concatenate([np.empty(0), *there.values()])
            every = every[np.isfinite(every)]
            least, most = float(every.min(initial=least)), float(every.max(initial=most))
            middle += int(((every >= _MIDDLE[0]) & (every < _MIDDLE[1])).sum())
            self._seen[kind] = least, most, middle, size + len(every)
            for name, values in there.items():
                turned = (values >= _BEYOND) & (values < _SPAN)
                columns[name] = np.where(turned, values - _SPAN, values)

    def notes(self, path: Path) -> list[str]:
        """What was taken for what. Raises BadRecording where the counts are of another kind."""
        for kind, (least, most, middle, size) in self._seen.items():
            span = f"{kind}: counts from {least:.0f} to {most:.0f}"
            unsigned = 0 <= least and _BEYOND <= most < _SPAN
            if unsigned and middle > _MOST_IN_MIDDLE * size:
                problem = f"{span} are around 32768, where a word of 16 bits changes its sign"
                raise BadRecording(path, problem, do="subtract 32768 from each and import that")
            if not unsigned and not (-_BEYOND <= least and most < _BEYOND):
                do = "divide them by their scale, and import deg/s, g or degC"
                raise BadRecording(path, f"{span} are no words of 16 bits", do=do)
        turned = [kind for kind, (_, most, *_) in self._seen.items() if most >= _BEYOND]
        return [f"{kind}: counts of 32768 and more are negative ones" for kind in turned]


class _Gathering:
    def __init__(
        self,
        table: Table,
        plan: Plan,
        path: Path,
        hz: float | None,
        fast_dps: float,
        folder: Path | None,
    ) -> None:
        self.table, self.plan, self.path, self.hz = table, plan, path, hz
        self.fast_dps = fast_dps
        self.readings = [name for name in plan.wanted if name != TIME]
        self.spool = Spool([TIME, PLACE, *self.readings], folder)
        self.dropped: Counter[str] = Counter()
        self.rows = self.samples = self.too_fast = 0
        self.fastest = 0.0
        self.largest = {"gyro": 0.0, "accel": 0.0}
        self.unfiltered: list[dict[str, np.ndarray]] = []
        self.held: bool | None = None  # until the first rates tell
        self.compared = [TIME, *self.readings]
        self.before = np.full(len(self.compared), np.nan)
        self.runs = Runs()
        self.clock = clock.Unwrapped(self._step_us())
        self.counts = Counts(plan.raw)
        self.kept: list[dict[str, np.ndarray]] = []
        self.beside: dict[str, list[np.ndarray]] = {}

    def result(self) -> Gathered:
        try:
            for chunk in self.table.chunks(self.plan.columns):
                self._take(self.plan.physical(chunk), chunk.place)
            self.spool.finish()
            self._check()
            of_counts = self.counts.notes(self.path)
            self._refuse_turns(self.unfiltered)
            self.spool = in_order(self.spool, self.path)
            self._leave_lines_out()
            if self.runs.steps_back:
                self._refuse_turns([self._some(n, columns) for n, columns in enumerate(self.spool)])
                self.runs.refuse_mixed(self.spool, self.path)
        except BaseException:
            self.spool.close()
            raise
        notes = [*self.table.notes, *self.plan.notes, *self.clock.notes, *of_counts]
        back = self.runs.steps_back
        if back:
            notes.append(f"time goes back at {counted(back, 'row')}: sorted by time")
        interval_us, repeated = self._interval_us()
        looked_at = {
            n: np.concatenate([k[n] for k in self.kept]) for n in (TIME, *self.readings)
        }  # fmt: skip
        lacking = {n for n in (*ACCEL, TEMP) if not np.isfinite(looked_at.get(n, 0.0)).all()}
        own = [*((*ACCEL, FELT) if lacking & {*ACCEL} else ()), *lacking - {*ACCEL}]
        looked_at |= {n: np.concatenate(self.beside[n]) for n in own if n in self.beside}
        return Gathered(
            self.spool, self.rows + sum(self.table.dropped.values()), self.samples,
            interval_us, self.largest,
            self.table.dropped + self.dropped, repeated + notes, TIME not in self.plan.wanted,
            looked_at,
        )  # fmt: skip

    def _leave_lines_out(self) -> None:
        self.spool, lost = without_lines(self.spool, self.path)
        if lost:
            self.dropped["on a straight line between readings, so it is none"] += lost
            self.samples -= lost
            self.kept = [self._some(n, columns) for n, columns in enumerate(self.spool)]

    def _step_us(self) -> float:
        """Microseconds of one count of the time column, where it may be a counter."""
        mapped = self.plan.wanted.get(TIME)
        if mapped is None or mapped.plus or self.table.mapping:
            return 0.0
        unit_s = self.plan.factors[TIME][0]
        return 0.0 if unit_s == TIME_S["s"] else unit_s * 1e6

    def _take(self, columns: dict[str, np.ndarray], place: np.ndarray) -> None:
        self.rows += len(place)
        if TIME in columns:
            columns[TIME] = columns[TIME] * 1e6
        else:
            assert self.hz, "it is asked for before the first row"
            with np.errstate(over="ignore"):  # what no integer holds is refused below
                columns[TIME] = place * (1e6 / self.hz)
        columns[PLACE] = place.astype(float)
        columns = self._less(columns, np.isfinite(columns[TIME]), _NO_TIME)
        # what has no reading may have no true time either
        some = np.any(np.isfinite([columns[name] for name in self.readings]), axis=0)
        columns = self._less(columns, some, "no reading of these columns")
        clock.refuse_impossible(columns[TIME], columns[PLACE], self.path)
        columns = self._less(columns, clock.whole_stamps(columns[TIME]), "the time stamp is torn")
        columns[TIME] = self.clock(columns[TIME], columns[PLACE])
        columns = self._less(columns, *self._not_written_twice(columns))
        self.counts.signed(columns)
        columns = self._less(columns, *self._is_something(columns))
        columns = self._less(columns, *self._not_all_zero(columns))
        for axes in (GYRO, ACCEL) if "ax" in columns else (GYRO,):
            columns = self._less(columns, *self._not_filled(columns, axes))
        self.unfiltered.append(self._some(len(self.unfiltered), columns))
        columns = self._less(columns, *self._not_too_fast(columns))
        whole = np.isfinite([columns[name] for name in GYRO]).all(axis=0)
        self.samples += int(whole.sum())
        self.runs.add(columns[TIME][whole], columns[PLACE][whole])
        self._measure(columns)
        self.spool.append(columns)

    def _refuse_turns(self, stretches: list[Columns]) -> None:
        names = [n for n in (*GYRO, *ACCEL) if n in self.plan.wanted]
        refuse_turns(stretches, names, self.path)

    def _some(self, number: int, columns: Columns) -> Columns:
        """The first samples of a piece, more of the first piece."""
        at = np.flatnonzero(np.isfinite([columns[name] for name in GYRO]).all(axis=0))
        at = at[: _KEPT if number else 50 * _KEPT]
        return {name: columns[name][at] for name in (TIME, *self.readings)}

    def _less(self, columns: Columns, good: np.ndarray, reason: str) -> Columns:
        if good.all():
            return columns
        self.dropped[reason] += int((~good).sum())
        return {name: values[good] for name, values in columns.items()}

    def _is_something(self, columns: Columns) -> tuple[np.ndarray, str]:
        """Rows with three rates, or with none but a reading of another sensor."""
        rates = np.isfinite([columns[name] for name in GYRO])
        others = [columns[name] for name in self.readings if name not in GYRO]
        beside = np.isfinite(others).any(axis=0) if others else np.zeros(rates.shape[1], bool)
        return np.all(rates, axis=0) | (~np.any(rates, axis=0) & beside), "a reading is no number"

    def _not_written_twice(self, columns: Columns) -> tuple[np.ndarray, str]:
        """Not the row before once more: that is no second sample."""
        rates = np.array([columns[name] for name in GYRO])
        if self.held is None and np.isfinite(rates).any():
            self.held = _are_held(rates, columns[TIME])
            if self.held:
                self.compared, self.before = list(GYRO), np.full(len(GYRO), np.nan)
        rows = np.array([columns[name] for name in self.compared])
        before = np.column_stack([self.before, rows[:, :-1]]) if rows.size else rows
        self.before = rows[:, -1] if rows.size else self.before
        why = HELD if self.held else "the row before once more"
        return ~(rows == before).all(axis=0), why

    def _not_all_zero(self, columns: Columns) -> tuple[np.ndarray, str]:
        """Three rates alone may well be zero on a coarse scale; with gravity, or 0 degC, they are
        none."""
        beside = [n for n in (ACCEL if "ax" in columns else (TEMP,)) if n in columns]
        if not beside:
            return np.ones(len(columns[TIME]), bool), ""
        frame = np.array([columns[name] for name in (*GYRO, *beside)])
        return ~(frame == 0).all(axis=0), "all readings are zero"

    def _not_filled(self, columns: Columns, axes: Sequence[str]) -> tuple[np.ndarray, str]:
        """Not one number on three axes, larger than every other reading."""
        three = np.array([columns[name] for name in axes])
        same = (three == three[0]).all(axis=0)
        others = np.abs(three[:, ~same])
        most = others[np.isfinite(others)].max(initial=0.0) if not same.all() else np.inf
        why = "one number on three axes, larger than all others, as -999 for no reading"
        return ~(same & (np.abs(three[0]) > most)), why

    def _not_too_fast(self, columns: Columns) -> tuple[np.ndarray, str]:
        """Rates that no sensor of this kind measures: damaged, or in another unit than said."""
        rates = np.abs([columns[name] for name in GYRO])
        fast = np.any(rates > self.fast_dps, axis=0)
        self.too_fast += int(fast.sum())
        self.fastest = max(self.fastest, float(rates[:, fast].max(initial=0.0)))
        return ~fast, f"faster than any such sensor measures ({self.fast_dps:g} dps)"

    def _measure(self, columns: Columns) -> None:
        for kind, axes in (("gyro", GYRO), ("accel", ACCEL)):
            if axes[0] in columns:
                sizes = np.abs([columns[name] for name in axes])
                sizes = sizes[np.isfinite(sizes)]
                self.largest[kind] = max(self.largest[kind], float(sizes.max(initial=0.0)))
        self.kept.append(self._some(len(self.kept), columns))
        for group in (ACCEL, (TEMP,)):
            if group[0] in columns:
                self._look_beside(columns, group)
        if len(self.kept) > 2 * _KEPT:
            self.kept = [self.kept[0], *self.kept[1::2]]
            self.unfiltered = [self.unfiltered[0], *self.unfiltered[1::2]]
            self.beside = {name: pieces[::2] for name, pieces in self.beside.items()}

    def _look_beside(self, columns: Columns, names: Sequence[str]) -> None:
        """Keep some readings of a sensor that may have rows of its own."""
        at = np.flatnonzero(np.isfinite([columns[name] for name in names]).all(axis=0))
        at = at[: _KEPT if self.beside.get(names[0]) else 50 * _KEPT]
        kept = {name: columns[name][at] for name in names} | {FELT: columns[TIME][at]}
        for name in [*names, *(FELT,) * (names == ACCEL)] if len(at) else ():
            self.beside.setdefault(name, []).append(kept[name])

    def _check(self) -> None:
        refuse_change_of_unit(self.unfiltered, self.plan, self.table, self.path)
        self._refuse_too_fast()
        torn = self.dropped[_NO_TIME]
        if 2 * torn > self.rows:
            do = "write it as a number or a date, or give --hz"
            raise BadRecording(
                self.path, f"{torn} of {self.rows} time stamps are no numbers", do=do
            )
        if not self.samples:
            dropped = self.table.dropped + self.dropped
            if not dropped and not self.rows:
                raise BadRecording(self.path, "no data row", do="name another file")
            why = [f"{counted(count, 'row')}: {why}" for why, count in dropped.items()]
            do = "write each of three rates as a number in a cell of its own"
            raise BadRecording(self.path, "no sample is left", do="; ".join([*why, do]))
        self.runs.refuse_a_restart(self.path)

    def _refuse_too_fast(self) -> None:
        """Raise BadRecording where more than a spike is faster than any range of these sensors."""
        if self.too_fast <= _FAST_SHARE * (self.samples + self.too_fast):
            return
        meant = "dps" if self.plan.factors["gx"][0] > 1 else "mdps"
        many = f"in {self.too_fast} rows"
        problem = f"{self.fastest:.4g} dps is more than these sensors measure, {many}"
        words = unit_words(self.plan.wanted, "gx", meant)
        do = f"did you mean {meant}? Give {words}; if it is true, give --gyro-lsb-per-dps"
        raise BadRecording(self.path, problem, do=do)

    def _interval_us(self) -> tuple[float, list[str]]:
        if self.hz:
            return 1e6 / self.hz, []
        pace, notes = self._pace(), []
        ticks = clock.Ticks(pace.first)
        if ticks.coarse:
            self.spool, note = clock.evenly(self.spool, ticks, self.path)
            pace, notes = self._pace(), [note]
        interval_us = pace.interval_us(self.path)
        every_row = self.samples == sum(piece.rows for piece in self.spool.pieces)
        if every_row and clock.arrive_in_bursts(self.spool.read(0), pace.mean_us):
            interval_us = pace.mean_us
            self.spool = self.spool.remade(clock.evened(self.spool, interval_us))
            self.kept = [self._some(n, columns) for n, columns in enumerate(self.spool)]
            notes.append("time stamps come in bursts: samples are spread evenly between them")
        return interval_us, notes

    def _pace(self) -> clock.Pace:
        pace = clock.Pace()
        for columns in self.spool:
            pace.add(columns[TIME][np.isfinite(columns["gx"])])
        return pace
