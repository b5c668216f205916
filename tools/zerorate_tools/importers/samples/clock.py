"""Time stamps as microseconds: counters that ran over, the rate, the gaps, coarse stamps, and those
of samples that a bus or a host handed over several at a time."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from ...errors import BadRecording
from ...numbers import duration
from ...recordings.recording import GYRO
from .spool import PLACE, TIME, Spool

_LONGEST_PAUSE_US = 10_000_000
#: Of what a counter holds: a log that begins anew comes so near by chance once in a hundred.
_PAUSE_OF_SPAN = 0.01
#: Stamps on both sides of a torn one are nearer to each other; of all, so many are torn at most.
_BESIDE_US, _MOST_TORN = 1e6, 0.01
_COUNTER_BITS = (16, 24, 30, 31, 32)
_HOUR_US, _DAY_US = 3_600e6, 86_400e6
#: Rows may be rarer than a counter's pause where midnight falls between two of them.
_LONGEST_NIGHT_US = 3_600e6
_MOST_US = 2.0**62
_STRIDE = 64
_KEPT = 250_000
#: Beyond as many usual intervals, and a second, is a gap.
GAP_INTERVALS, GAP_LEAST_US = 3.0, 1e6
#: Of all steps: beyond that the stamps are coarser than the samples.
_REPEATED = 0.2
#: Rows that one stamp may have more or less than a steady rate gives: its ends fall on either side.
_ROWS_OFF = 2.0
#: Of the stamps: so many may be short of a row that was lost, and the rest still tells the rate.
_MOST_UNEVEN = 0.1


def whole_stamps(t_us: np.ndarray) -> np.ndarray:
    """(n,) bool: not a stamp far from both neighbours, which are beside each other: on its way a
    digit was lost, or one added. Where that is usual, two clocks take turns, and all are whole."""
    whole = np.ones(len(t_us), bool)
    steps = np.abs(np.diff(t_us))
    far = np.minimum(steps[:-1], steps[1:]) > _LONGEST_PAUSE_US
    torn = far & (np.abs(t_us[2:] - t_us[:-2]) < _BESIDE_US)
    whole[1:-1] = ~torn | (torn.sum() > _MOST_TORN * len(torn))
    return whole


class Unwrapped:
    """Adds what a counter of 16 to 32 bits lost where it ran over, or midnight a time of day.

    step_us: what one count is worth, in microseconds; 0 for a column that is no counter.
    """

    def __init__(self, step_us: float) -> None:
        self._step_us = step_us
        self._last = -np.inf
        self._added = 0.0
        self._ran_over: dict[str, list[int]] = {}

    @property
    def notes(self) -> list[str]:
        """In words, a line each clock, where any ran over."""
        return [
            f"a clock of {clock} ran over {'' if len(rows) == 1 else f'{len(rows)} times, first '}"
            f"at row {rows[0]}: counted on"
            for clock, rows in self._ran_over.items()
        ]

    def __call__(self, t_us: np.ndarray, place: np.ndarray) -> np.ndarray:
        """(n,) the same stamps, going on where the counter ran over."""
        read = np.append(self._last, t_us)
        self._last = read[-1]
        t_us = t_us + self._added
        for at in np.flatnonzero(read[1:] < read[:-1]):
            clock, span = self._clock(read[at], read[at + 1])
            t_us[at:] += span
            self._added += span
            if span:
                self._ran_over.setdefault(clock, []).append(int(place[at]) + 1)
        return t_us

    def _clock(self, earlier: float, later: float) -> tuple[str, float]:
        """What ran over, and microseconds that it holds; 0 where nothing did."""
        spans = {f"{bits} bits": 2.0**bits * self._step_us for bits in _COUNTER_BITS}
        if not self._step_us:
            spans["60 minutes"] = _HOUR_US
        for clock, span in {**spans, "24 hours": _DAY_US}.items():
            night = clock == "24 hours" and not self._step_us
            usual = min(_LONGEST_PAUSE_US, _PAUSE_OF_SPAN * span)
            longest = _LONGEST_NIGHT_US if night else usual
            if earlier < span and 0 < later + span - earlier < longest:
                return clock, span
        return "", 0.0


class Pace:
    """The usual interval between samples, whatever gaps and bursts there are: the median of the
    means over 64 intervals, or fewer in a short recording."""

    def __init__(self) -> None:
        self._means: list[np.ndarray] = [np.empty(0)]
        self._spent_us, self._steps = 0.0, 0
        self.first: np.ndarray = np.empty(0)

    def add(self, t_us: np.ndarray) -> None:
        """Take the stamps of samples in order."""
        self.first = np.append(self.first, t_us)[:_KEPT]
        steps = np.diff(t_us)
        steps = steps[steps <= GAP_LEAST_US]
        self._spent_us += float(steps.sum())
        self._steps += len(steps)
        self._means.append(np.diff(t_us[::_STRIDE]) / _STRIDE)

    @property
    def mean_us(self) -> float:
        """The mean interval but for gaps: of bursts the only one that is true."""
        return self._spent_us / max(self._steps, 1)

    def interval_us(self, path: Path) -> float:
        """Raises BadRecording where time stands still."""
        means = np.concatenate(self._means)
        stride = max(1, len(self.first) // 16)
        if stride < _STRIDE:
            means = np.diff(self.first[::stride]) / stride
        if not len(means) or not (usual := float(np.median(means))):
            raise BadRecording(path, "time stands still", do="give --hz, samples a second")
        return usual


def longest_us(interval_us: float) -> float:
    """Until when a reading counts as the next one: a later one is beyond a gap."""
    return max(GAP_INTERVALS * interval_us, GAP_LEAST_US)


class Gaps:
    """Counts pauses that are far longer than the usual interval."""

    def __init__(self, interval_us: float) -> None:
        self._least_us = longest_us(interval_us)
        self._last = np.nan
        self.count = 0
        self.longest_us = 0.0

    def add(self, t_us: np.ndarray) -> None:
        """Take the stamps of samples in order."""
        t_us = np.append(self._last, t_us)
        self._last = t_us[-1]
        pauses = np.diff(t_us)
        pauses = pauses[pauses > self._least_us]
        self.count += len(pauses)
        self.longest_us = max(self.longest_us, float(pauses.max(initial=0.0)))

    def note(self) -> list[str]:
        """In words, where there are any."""
        if not self.count:
            return []
        if self.count == 1:
            return [f"a gap of {duration(self.longest_us * 1e-6)} in the time stamps"]
        return [f"{self.count} gaps in the time stamps, at most {duration(self.longest_us * 1e-6)}"]


def refuse_impossible(t_us: np.ndarray, place: np.ndarray, path: Path) -> None:
    """Raise BadRecording for stamps that no integer of microseconds holds."""
    outside = np.abs(t_us) >= _MOST_US
    if outside.any():
        at = int(np.argmax(outside))
        problem = f"the time stamp is {t_us[at]:.4g} us, more than 62 bits hold"
        do = "name the unit that it is in: --time-unit ns"
        raise BadRecording(path, problem, row=int(place[at]) + 1, do=do)


class Ticks:
    """What the stamps of the first samples tell: how long one lasts, and how long a sample."""

    def __init__(self, t_us: np.ndarray) -> None:
        steps = np.diff(t_us)
        went = steps[steps > 0]
        self.coarse = len(went) > 1 and bool((steps == 0).mean() > _REPEATED)
        self.tick_us = float(np.median(went)) if len(went) else 0.0
        self.sample_us = self.tick_us
        if self.coarse:
            at = np.flatnonzero(steps > 0) + 1
            rows, lasted = np.diff(at), np.diff(t_us[at])
            whole = lasted <= GAP_INTERVALS * self.tick_us
            # of which the first tick, the last, and those beside a gap are a part each
            whole[1:] &= whole[:-1]
            if whole.any():
                self.sample_us = float(lasted[whole].sum() / rows[whole].sum())


class _Spread:
    def __init__(self, ticks: Ticks) -> None:
        self.ticks = ticks
        self.begins = True
        self.uneven = self.groups = 0
        self.fewest, self.most = np.inf, 0.0

    def pieces(self, spool: Spool) -> Iterator[dict[str, np.ndarray]]:
        """Yield the rows of a spool spread, those of one stamp together."""
        rest = {name: np.empty(0) for name in spool.names}
        for columns in spool:
            rows = {name: np.concatenate([rest[name], columns[name]]) for name in spool.names}
            t_us = rows[TIME]
            ready = int(np.searchsorted(t_us, t_us[-1], "left"))
            rest = {name: values[ready:] for name, values in rows.items()}
            if ready:
                yield self._spread({n: v[:ready] for n, v in rows.items()}, t_us[ready])
        yield self._spread(rest, np.inf)

    def _spread(self, rows: dict[str, np.ndarray], following_us: float) -> dict[str, np.ndarray]:
        """The same rows, each with a time of its own. following_us: the stamp after the last."""
        t_us = rows[TIME]
        starts = np.flatnonzero(np.diff(t_us, prepend=-np.inf) > 0)
        stamps = t_us[starts]
        group = np.searchsorted(stamps, t_us, "right") - 1
        samples = np.isfinite(rows["gx"])
        first, lasts = self._windows(
            np.bincount(group[samples], minlength=len(stamps)),
            np.diff(stamps, append=following_us),
        )
        spread = t_us.copy()
        for kind in (samples, ~samples):
            own, count = group[kind], np.bincount(group[kind], minlength=len(stamps))
            number = np.arange(len(own)) - (np.cumsum(count) - count)[own]
            spread[kind] += first[own] + number * lasts[own] / count[own]
        order = np.lexsort((rows[PLACE], spread))
        return {name: values[order] for name, values in {**rows, TIME: spread}.items()}

    def _windows(self, count: np.ndarray, step_us: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(when its rows begin after its stamp, how long they last) of each stamp, microseconds."""
        tick_us, sample_us = self.ticks.tick_us, self.ticks.sample_us
        due = np.minimum(step_us, GAP_INTERVALS * tick_us) / sample_us
        ends = (step_us > 1.5 * tick_us) & (count < due - _ROWS_OFF) | np.isinf(step_us)
        begins = np.concatenate([[self.begins], ends[:-1]])
        self.begins = bool(ends[-1])
        off = np.abs(count - due)
        partly = (begins | ends) & (count <= tick_us / sample_us + _ROWS_OFF)
        odd = (off > _ROWS_OFF) & ~partly & (count > 0)
        self.uneven += int(odd.sum())
        self.groups += int((count > 0).sum())
        inner = count[(count > 0) & ~begins & ~ends].astype(float)
        self.fewest = min(self.fewest, inner.min(initial=np.inf))
        self.most = max(self.most, inner.max(initial=0.0))
        within = np.where(ends, tick_us, step_us)
        own = np.where(count > 0, np.minimum(within, count * sample_us), within)
        lasts = np.where((begins | ends) & (off > _ROWS_OFF), own, within)
        return np.where(begins & ~ends, step_us - lasts, 0.0), lasts

    def refuse_uneven(self, path: Path) -> None:
        """Raise BadRecording where no steady rate gives so many rows a stamp."""
        if self.uneven > _MOST_UNEVEN * self.groups:
            problem = (
                f"{self.fewest:.0f} to {self.most:.0f} rows share each time stamp of "
                f"{duration(self.ticks.tick_us * 1e-6)}, so nothing tells their times"
            )
            do = "write finer times; where no row was lost, give --hz, rows a second"
            raise BadRecording(path, problem, do=do)

    def note(self) -> str:
        stamp = duration(self.ticks.tick_us * 1e-6)
        each = self.ticks.tick_us / self.ticks.sample_us
        lost = f"; in {self.uneven} of them rows are lost" if self.uneven else ""
        return f"rows that share a time stamp of {stamp} are spread over it, {each:.4g} each{lost}"


def evenly(spool: Spool, ticks: Ticks, path: Path) -> tuple[Spool, str]:
    """(The same rows in order of time, each at its share of the time of its stamp; what was done).

    Raises BadRecording where the rows of a stamp do not come evenly.
    """
    spread = _Spread(ticks)
    out = spool.remade(spread.pieces(spool))
    spread.refuse_uneven(path)
    return out, spread.note()


#: Of all steps: beyond that so many are shorter than half the usual one that stamps come in bursts.
_SHORT = 0.2
#: Of what the stamps leave of the rates beside a pause, what even steps leave: of noise as much.
_CLEARLY = 0.5


def arrive_in_bursts(columns: dict[str, np.ndarray], interval_us: float) -> bool:
    """Whether samples were taken evenly, though their stamps come in bursts. A logger that really
    paused has the same stamps: the rates beside a pause tell, as they go on from their neighbours
    in the order of the samples or in the time of the stamps.

    columns: some samples in order; interval_us: the usual one.
    """
    steps = np.diff(columns[TIME])
    whole = columns[TIME][-1:] - columns[TIME][:1] > 2.0 * GAP_LEAST_US
    if not whole.all() or np.mean(steps < 0.5 * interval_us) <= _SHORT:
        return False
    before, after = steps[:-1], steps[1:]
    at_pause = np.maximum(before, after) > 2.0 * interval_us
    rates = np.array([columns[name] for name in GYRO])
    by_stamps = after / np.maximum(before + after, 1e-9)
    even = np.full_like(by_stamps, 0.5)
    return _misfit(rates, even, at_pause) < _CLEARLY * _misfit(rates, by_stamps, at_pause)


def _misfit(rates: np.ndarray, weight: np.ndarray, take: np.ndarray) -> float:
    """Squares of rates (3, n) less the line through their neighbours, in units of white noise."""
    left = rates[:, 1:-1] - (weight * rates[:, :-2] + (1 - weight) * rates[:, 2:])
    return float(np.nansum((left**2 / (1 + weight**2 + (1 - weight) ** 2))[:, take]))


def evened(spool: Spool, interval_us: float) -> Iterator[dict[str, np.ndarray]]:
    """Yield the same pieces, each sample at the time when an even clock would have handed it over.

    A stamp is late, never early, and within a second a sample comes on time: those that do set
    the clock, and the others lie evenly between. Where samples are lost it stays later for good.
    """
    around = max(1, round(GAP_LEAST_US / interval_us))
    behind = np.full(around, -np.inf)
    place = 0
    for number in range(len(spool.pieces)):
        columns = spool.read(number)
        rows = len(columns[TIME])
        late = columns[TIME] - np.arange(place, place + rows) * interval_us
        ahead = _next_late(spool, number, place + rows, interval_us, around)
        padded = np.concatenate([behind, late, ahead])
        clock = np.maximum(_least(padded, around, -1), _least(padded, around, 1))
        on_time = np.flatnonzero((padded <= clock) & np.isfinite(padded))
        lateness = late - np.interp(np.arange(around, around + rows), on_time, padded[on_time])
        yield {**columns, TIME: columns[TIME] - lateness}
        behind = padded[rows : rows + around]
        place += rows


def _next_late(
    spool: Spool, number: int, place: int, interval_us: float, around: int
) -> np.ndarray:
    """By how much the next samples are later than an even clock says; inf beyond the end."""
    if number + 1 == len(spool.pieces):
        return np.full(around, np.inf)
    t_us = spool.read(number + 1)[TIME][:around]
    late = t_us - np.arange(place, place + len(t_us)) * interval_us
    return np.pad(late, (0, around - len(late)), constant_values=np.inf)


def _least(values: np.ndarray, around: int, side: int) -> np.ndarray:
    """The least of each value and the next `around` of them (side 1), or those before it (-1)."""
    from scipy.ndimage import minimum_filter1d  # which the child that reads a log does without

    size = around + 1
    return minimum_filter1d(values, size, origin=-(size // 2) if side > 0 else around // 2)
