"""Rows of several sensors in one table, told apart by the column that says whose a row is."""

import re
from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import zip_longest
from pathlib import Path

import numpy as np

from ...errors import BadRecording
from ...recordings.recording import TIME
from ..columns import names as usual
from ..columns.guesses import only_grows
from ..columns.units import unit_in_name
from .sniffing import MOST_WORDS
from .table import Chunk, Table

_OF_RATES = re.compile(r"gyr|angular|rotation.?rate|omega", re.I)
#: Of a word, that are read together.
_ROWS, PLACE = 32_768, "place of a row"
#: Of rows, how many are another device's than the row before where devices take turns.
_TURNS = 0.1
#: No two clocks of one sample go further apart.
_CLOCKS_APART = 1e-3
_WHOSE = re.compile(
    r"i|(?:imu|sensor|device|node|multi|instance)?(?:id|no|num|number|index|name|type)?"
    r"|instance|source|topic|frameid|address|mac"
)


def told_apart(table: Table, instance: int, path: Path) -> tuple[Table, int]:
    """(The table of one device, the instance that is left to choose).

    Where words name sensors (gyro, accel), each gets columns of its own; where they or numbers name
    devices, the rows of one are kept. Raises BadRecording where nothing says which rows are rates.
    """
    if table.mapping:
        return table, instance
    of_rates = (
        column
        for column, words in table.words.items()
        if any(map(_OF_RATES.search, words)) or usual.gyro_groups(words)
    )
    sensor = next(of_rates, "")
    column, kinds = _devices(table, sensor)
    if not column:
        return _by_sensor(table, sensor), instance
    listed = ", ".join(kinds.values())
    if not sensor and not usual.gyro_groups(table.names):
        problem = f"rows of several sensors ({column}: {listed}), and nothing says which are rates"
        do = "write the rows of the gyroscope into a file of their own"
        raise BadRecording(path, problem, do=do)
    if instance >= len(kinds):
        problem = f"there are {len(kinds)} sensors ({column}: {listed})"
        raise BadRecording(path, problem, do=f"give --instance 0 to {len(kinds) - 1}")
    code = list(kinds)[instance]
    note = f"rows of several sensors ({column}: {listed}): {kinds[code]}, chosen by --instance"
    return _by_sensor(_alone(table, column, code, note), sensor), 0


def _by_sensor(table: Table, sensor: str) -> Table:
    """Columns for each sensor where a column of words names it; "" for none."""
    return _beside(*_with_axes(table, sensor, table.words[sensor])) if sensor else table


def by_own_times(table: Table) -> Table:
    """Tables beside each other, each behind its own time, as rows of one; others as they are."""
    parts = {} if table.mapping else _behind_times(table)
    units = {unit_in_name(TIME, re.sub(r"\.\d+$", "", time)) for time in parts}
    if len(parts) < 2 or len(units) > 1:
        return table
    [unit] = units
    shared = f"time [{unit}]" if unit else "time"

    def chunks(wanted: list[str]) -> Iterator[Chunk]:
        needed = [*parts, *(name for name in wanted if name != shared)]
        for chunk in table.chunks([*dict.fromkeys(needed)]):
            rows = {time: np.isfinite(chunk.columns[time]) for time in parts}
            nan = np.full(len(chunk.place), np.nan)
            out = {
                n: [chunk.columns[t if n == shared else n] if n in (shared, *held) else nan
                    for t, held in parts.items()]
                for n in wanted
            }  # fmt: skip
            there = np.concatenate([*rows.values()])
            columns = {name: np.concatenate(values)[there] for name, values in out.items()}
            yield Chunk(np.tile(chunk.place, len(parts))[there], columns)

    names = [shared, *(name for held in parts.values() for name in held)]
    note = f"columns beside each other, each by its own time: {', '.join(parts)}"
    calendar = frozenset({shared} if table.calendar & {*parts} else ())
    notes = [*table.notes, note]
    return replace(table, names=names, chunks=chunks, calendar=calendar, notes=notes, parts=2)


def _behind_times(table: Table) -> dict[str, list[str]]:
    """Each time with the columns behind it, or before it where the last one is a time; none where
    all times go on alike, as where each row is one sample."""
    clocks = usual.clocks([name for name in table.names if name not in table.words])
    first = table.first_rows(clocks) if len(clocks) > 1 else {}
    first = {n: t for n, t in first.items() if only_grows(t[np.isfinite(t)])}
    parts: dict[str, list[str]] = {}
    if len(first) < 2:
        return parts
    names = table.names[::-1] if table.names[-1] in first else table.names
    time = next(name for name in names if name in first)
    for name in names:
        if name in first:
            alike = (t for t in parts if np.array_equal(first[t], first[name], equal_nan=True))
            time = next(alike, name)
        elif name not in clocks:
            parts.setdefault(time, []).append(name)
    firsts = [first[time] for time in parts]
    return parts if any(_part_company(firsts[0], other) for other in firsts[1:]) else {}


def _part_company(one: np.ndarray, other: np.ndarray) -> bool:
    """Whether two times of the same rows, in whatever units, go on by other steps."""
    both = np.array([one, other])[:, np.isfinite(one) & np.isfinite(other)]
    spans = np.ptp(both, axis=1) if both.size else np.ones(2)
    unit = 1000.0 ** np.round(np.log(spans[1] / spans[0]) / np.log(1000.0))
    steps = spans / max(1, both.shape[1] - 1)
    least = max(3.0 * steps[0], 3.0 * steps[1] / unit, _CLOCKS_APART * spans[0])
    return bool(abs(spans[1] / unit - spans[0]) > least)


def _devices(table: Table, sensor: str) -> tuple[str, dict[float, str]]:
    """The column that tells devices apart, and its codes with their words; ("", {}) for none.

    Where a column names sensors, each device's words stand beside each of its words.
    """
    if sensor:
        first = table.first_rows([*table.words])
        named = [n for n in table.words if n != sensor and _WHOSE.fullmatch(usual.spelled(n))]
        cells = {n: len(np.unique(first[sensor] * MOST_WORDS + first[n])) for n in named}
        sizes = {n: len(table.words[n]) * len(table.words[sensor]) for n in named}
        whole = next((n for n in named if cells[n] == sizes[n]), "")
        return whole, {float(code): word for code, word in enumerate(table.words.get(whole, []))}
    named = [n for n in table.names if _WHOSE.fullmatch(usual.spelled(n.rpartition(".")[2]))]
    numbers = table.first_rows([name for name in named if name not in table.words])
    # IMU1 and IMU2 differ in their number alone, and take turns
    alike = [n for n, of in table.words.items() if len({re.sub(r"\d", "", w) for w in of}) == 1]
    turns = table.first_rows(alike)
    changes = {name: (np.diff(codes) != 0).sum() for name, codes in turns.items()}
    named += [n for n in alike if n not in named and changes[n] > _TURNS * len(turns[n])]
    for name in named:
        if name in table.words:
            return name, {float(code): word for code, word in enumerate(table.words[name])}
        found = np.unique(numbers[name][np.isfinite(numbers[name])])
        if 2 <= len(found) <= MOST_WORDS and (found % 1 == 0).all():
            return name, {code: f"{code:g}" for code in found.tolist()}
    return "", {}


def _alone(table: Table, column: str, code: float, note: str) -> Table:
    def chunks(wanted: list[str]) -> Iterator[Chunk]:
        for chunk in table.chunks([*dict.fromkeys([*wanted, column])]):
            ours = chunk.columns[column] == code
            yield Chunk(chunk.place[ours], {name: chunk.columns[name][ours] for name in wanted})

    names = [name for name in table.names if name != column]
    return replace(table, names=names, chunks=chunks, notes=[*table.notes, note])


def _with_axes(table: Table, column: str, words: list[str]) -> tuple[Table, str, list[str]]:
    """The same, with words of a sensor and its axis where another column has the latter's."""
    found = (n for n, of in table.words.items() if {w.lower() for w in of} <= {*"xyz"})
    axis = next(found, column)
    if axis == column:
        return table, column, words
    axes = table.words[axis]

    def chunks(wanted: list[str]) -> Iterator[Chunk]:
        for chunk in table.chunks([*dict.fromkeys([*wanted, column, axis])]):
            codes = chunk.columns[column] * len(axes) + chunk.columns[axis]
            yield Chunk(chunk.place, {**chunk.columns, column: codes})

    names = [name for name in table.names if name != axis]
    both = [f"{word} {of}" for word in words for of in axes]
    return replace(table, names=names, chunks=chunks), column, both


def _beside(table: Table, column: str, words: list[str]) -> Table:
    """The same rows, with columns for each sensor: `gyro x` is x where the word is gyro.

    Where a word names one value (gx), or rows have no time, those that take turns are one row.
    """
    shared = _times(table, column)
    values = [name for name in table.names if name not in (*shared, column)]
    first = table.first_rows([column, *values])
    own, unnamed = _that_change(first, column), usual.unnamed(table.names)
    if len(own) == (len("xyz") if unnamed else 1) and (unnamed or usual.gyro_groups(words)):
        values = own  # beside a unit, say, a number of the word, or how accurate it is
    bare = unnamed and len(values) == len("xyz")
    labels = dict(zip(values, "xyz" if bare else values))
    times = {("time" if bare else name): name for name in shared}
    is_sorted = bool(shared) and (np.diff(first[column]) != 0).sum() < len(words)
    one = len(values) == 1 and bool(usual.gyro_groups(words))
    parts = {
        word if one else f"{word} {labels[v]}": (code, v)
        for code, word in enumerate(words)
        for v in values
        if is_sorted or np.isfinite(first[v][first[column] == code]).any()
    }

    def chunks(wanted: list[str]) -> Iterator[Chunk]:
        whose = [parts[name] for name in wanted if name in parts]
        needed = [*(times[n] for n in wanted if n in times), *(v for _, v in whose), column]
        needed = [*dict.fromkeys([*needed, *shared] if one or is_sorted else needed)]
        read = table.chunks(needed)
        if is_sorted:
            turns = {code: table.chunks(needed) for code in {code for code, _ in whose} or {0}}
            read = _by_time([_of_word(*turn, column) for turn in turns.items()], shared)
        for chunk in _in_turns(read, column, shared) if one or not shared else read:
            codes = chunk.columns[column]
            out = {name: chunk.columns[times[name]] for name in wanted if name in times}
            for name in wanted:
                if name in parts:
                    code, value = parts[name]
                    out[name] = np.where(codes == code, chunk.columns[value], np.nan)
            yield _as_rows(chunk.place, out, times)

    words_left = {} if one else table.words
    return replace(table, names=[*times, *parts], chunks=chunks, words=words_left)


def _that_change(first: dict[str, np.ndarray], column: str) -> list[str]:
    """The columns that are not the same in all rows of each word."""
    rows = [first[column] == code for code in np.unique(first[column])]
    return [
        n
        for n, of in first.items()
        if any(np.nanmax(np.abs(np.diff(of[r])), initial=0) for r in rows)
    ]


def _of_word(code: int, chunks: Iterable[Chunk], column: str) -> Iterator[Chunk]:
    """The rows of one word, so many a chunk."""
    rest = {PLACE: np.empty(0)}
    for chunk in chunks:
        ours = chunk.columns[column] == code
        new = {name: values[ours] for name, values in {**chunk.columns, PLACE: chunk.place}.items()}
        rest = {n: np.concatenate([rest.get(n, v[:0]), v]) for n, v in new.items()}
        while len(rest[PLACE]) >= _ROWS:
            some = {name: values[:_ROWS] for name, values in rest.items()}
            rest = {name: values[_ROWS:] for name, values in rest.items()}
            yield Chunk(some.pop(PLACE), some)
    if len(rest[PLACE]):
        yield Chunk(rest.pop(PLACE), rest)


def _by_time(words: list[Iterator[Chunk]], times: list[str]) -> Iterator[Chunk]:
    """Chunks of each word together, by time."""
    for some in zip_longest(*words):
        there = [chunk for chunk in some if chunk]
        names = there[0].columns
        columns = {name: np.concatenate([chunk.columns[name] for chunk in there]) for name in names}
        order = np.lexsort([columns[time] for time in reversed(times)])
        place = np.concatenate([chunk.place for chunk in there])[order]
        yield Chunk(place, {name: values[order] for name, values in columns.items()})


def _in_turns(chunks: Iterable[Chunk], column: str, times: list[str]) -> Iterator[Chunk]:
    """Chunks of whole rows, with the place of its row for each reading. Where three readings or
    more share a time, those of another time are another row."""
    place, rest, by_time = 0, None, False
    for chunk in chunks:
        columns = chunk.columns
        if rest:
            columns = {n: np.concatenate([rest[n], values]) for n, values in columns.items()}
        goes_on = np.zeros(len(columns[column]), bool)
        for time in times:
            goes_on[1:] |= np.diff(columns[time]) != 0
        by_time = by_time or 2.5 * goes_on.sum() < len(goes_on)
        starts = _starts(columns[column], goes_on & by_time)
        row = place + np.searchsorted(starts, np.arange(starts[-1]), "right") - 1
        yield Chunk(row, {name: values[: starts[-1]] for name, values in columns.items()})
        rest = {name: values[starts[-1] :] for name, values in columns.items()}
        place += len(starts) - 1
    if rest:
        yield Chunk(np.full(len(rest[column]), place), rest)


def _as_rows(place: np.ndarray, columns: dict[str, np.ndarray], times: Iterable[str]) -> Chunk:
    """One row for all readings of one place."""
    rows, starts, row = np.unique(place, return_index=True, return_inverse=True)
    if len(rows) == len(place):
        return Chunk(place, columns)
    out = {name: columns[name][starts] for name in columns if name in times}
    for name in columns.keys() - out:
        there = np.isfinite(columns[name])
        out[name] = np.full(len(rows), np.nan)
        out[name][row[there]] = columns[name][there]
    return Chunk(rows, out)


def _starts(codes: np.ndarray, goes_on: np.ndarray) -> list[int]:
    """Where a row begins: at the first word of all, or at one that the row has, or as time does."""
    starts, held = [0], set[float]()
    for at, (code, another) in enumerate(zip(codes.tolist(), goes_on.tolist())):
        if at and (another or code == 0 or code in held):
            starts.append(at)
            held.clear()
        held.add(code)
    return starts


def _times(table: Table, column: str) -> list[str]:
    """The columns that hold for every sensor."""
    found = [
        *usual.time_columns(table.names),
        *table.calendar,
        *(name for split in usual.split_times(table.names) for name in split[:2]),
    ]
    if found:
        return [name for name in table.names if name in found]
    first = table.first_rows(table.names)
    ours = first[column] == 0
    return [name for name in table.names if name != column and only_grows(first[name][ours])]
