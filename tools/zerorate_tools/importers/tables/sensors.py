"""Rows of several sensors in one table, told apart by the column that says whose a row is."""

import re
from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

from ...errors import BadRecording
from ..columns import names as usual
from ..columns.guesses import only_grows
from .sniffing import MOST_WORDS
from .table import Chunk, Table

_OF_RATES = re.compile(r"gyr|angular|rotation.?rate|omega", re.I)
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
    for column, words in table.words.items():
        if any(map(_OF_RATES.search, words)) or usual.gyro_groups(words):
            return _beside(table, column, words), instance
    column, kinds = _devices(table)
    if not column:
        return table, instance
    listed = ", ".join(kinds.values())
    if not usual.gyro_groups(table.names):
        problem = f"rows of several sensors ({column}: {listed}), and nothing says which are rates"
        do = "write the rows of the gyroscope into a file of their own"
        raise BadRecording(path, problem, do=do)
    if instance >= len(kinds):
        problem = f"there are {len(kinds)} sensors ({column}: {listed})"
        raise BadRecording(path, problem, do=f"give --instance 0 to {len(kinds) - 1}")
    code = list(kinds)[instance]
    note = f"rows of several sensors ({column}: {listed}): {kinds[code]} is taken, by --instance"
    return _alone(table, column, code, note), 0


def _devices(table: Table) -> tuple[str, dict[float, str]]:
    """The column that tells devices apart, and its codes with their words; ("", {}) for none."""
    named = [n for n in table.names if _WHOSE.fullmatch(usual.spelled(n.rpartition(".")[2]))]
    numbers = table.first_rows([name for name in named if name not in table.words])
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


def _beside(table: Table, column: str, words: list[str]) -> Table:
    """The same rows, with columns for each sensor: `gyro x` is x where the word is gyro.

    Where a word names one value (gx), or rows have no time, those that take turns are one row.
    """
    shared = _times(table, column)
    values = [name for name in table.names if name not in (*shared, column)]
    bare = usual.unnamed(table.names) and len(values) == len("xyz")
    labels = dict(zip(values, "xyz" if bare else values))
    times = {("time" if bare else name): name for name in shared}
    first = table.first_rows([column, *values])
    one = len(values) == 1 and bool(usual.gyro_groups(words))
    parts = {
        word if one else f"{word} {labels[v]}": (code, v)
        for code, word in enumerate(words)
        for v in values
        if np.isfinite(first[v][first[column] == code]).any()
    }

    def chunks(wanted: list[str]) -> Iterator[Chunk]:
        whose = [parts[name] for name in wanted if name in parts]
        needed = [*(times[n] for n in wanted if n in times), *(v for _, v in whose), column]
        read = table.chunks([*dict.fromkeys(needed)])
        for chunk in _in_turns(read, column) if one or not shared else read:
            codes = chunk.columns[column]
            out = {name: chunk.columns[times[name]] for name in wanted if name in times}
            for name in wanted:
                if name in parts:
                    code, value = parts[name]
                    out[name] = np.where(codes == code, chunk.columns[value], np.nan)
            yield _as_rows(chunk.place, out, times)

    words_left = {} if one else table.words
    return replace(table, names=[*times, *parts], chunks=chunks, words=words_left)


def _in_turns(chunks: Iterable[Chunk], column: str) -> Iterator[Chunk]:
    """Chunks of whole rows, with the place of its row for each reading."""
    place, rest = 0, None
    for chunk in chunks:
        columns = chunk.columns
        if rest:
            columns = {n: np.concatenate([rest[n], values]) for n, values in columns.items()}
        starts = _starts(columns[column])
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


def _starts(codes: np.ndarray) -> list[int]:
    """Where a row begins: at the first word of all, or at one that the row has."""
    starts, held = [0], set[float]()
    for at, code in enumerate(codes.tolist()):
        if at and (code == 0 or code in held):
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
