"""JSON: an object a line, a list of objects, an object of lists, or pandas' object of objects.

A line may also be a list of numbers, and what Python prints of a dict, a list or a tuple. A message
of Movesense, and a file of Edge Impulse, are their samples.
"""

import json
import re
from ast import literal_eval
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from dataclasses import replace
from itertools import chain, islice
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa

from ...errors import BadRecording
from ...recordings.text import head, lines_of, open_text
from ..tables.delimited import seconds_of
from ..tables.sniffing import DATE, MOST_WORDS
from ..tables.table import Chunk, Table
from .arrays import rate_said, table_of_arrays

_ROWS, _SEEN = 8_192, 3000
_LONGEST_LIST = 9
_UNITS = ("unit", "units")
_AXIS = re.compile(r"[xyz]$|\]$", re.I)
_DO = "write an object for each sample, one a line"
#: The units of the lists in a message of Movesense, whose times are in milliseconds.
_OF_MOVESENSE = {"ArrayAcc": "m/s2", "ArrayGyro": "dps", "ArrayMagn": "uT"}


def read(path: Path) -> Table:
    """Raises BadRecording."""
    first, _, others = head(path, 262_144)[0].partition(b"\n")
    if _is_sample(first) and (others.strip() or not _holds_all(_loaded(first))):
        return _of_records(lambda dropped: _lines(path, dropped), path)
    stream = open_text(path, head(path, 4096)[1])[0]
    held = _of_edge_impulse(_inner(json.loads(stream.read())))
    held, said_hz = _named(held), rate_said(held) if isinstance(held, dict) else None
    if isinstance(held, dict) and len(lists := [v for v in held.values() if _is_records(v)]) == 1:
        held = lists[0]
    if _is_records(held) or isinstance(held, list) and any(map(_is_numbers, held[:1])):
        return replace(_of_records(lambda dropped: iter(held), path), said_hz=said_hz)
    if not isinstance(held, dict):
        raise BadRecording(path, "JSON, and no records in it", do=_DO)
    arrays: dict[str, np.ndarray] = {}
    for name, column in _columns(held):
        with suppress(ValueError):  # lists of several lengths are no column
            arrays[name] = np.array(column)
    return replace(table_of_arrays(arrays, path, _DO), said_hz=said_hz)


def _columns(held: dict[str, Any]) -> Iterator[tuple[str, Any]]:
    """The lists of an object, and of objects in it, as gyro.x; pandas' {row: value} is one."""
    for name, value in held.items():
        inner = [*value.values()] if isinstance(value, dict) else []
        if any(isinstance(one, (dict, list)) for one in inner):
            yield from ((f"{name}.{of}", column) for of, column in _columns(value))
        else:
            yield name, inner or value


def _named(held: Any) -> Any:
    """The rows of an object as records, where it names their cells, too, as pandas does."""
    values = held.values() if isinstance(held, dict) else ()
    lists = [value for value in values if isinstance(value, list) and value]
    rows: list[Any] = next((v for v in lists if all(map(_is_numbers, v[:_SEEN]))), [[]])
    for names in lists:
        if all(isinstance(name, str) for name in names) and len(names) == len(rows[0]):
            return [dict(zip(names, row)) for row in rows]
    return held


def _inner(held: Any) -> Any:
    """What objects of one name hold, one within another: {"Meas": {"IMU6": [...]}}."""
    while isinstance(held, dict) and len(held) == 1 and isinstance([*held.values()][0], dict):
        [held] = held.values()
    return held


def _of_edge_impulse(held: Any) -> Any:
    """Its samples as records, where a file is one of Edge Impulse; else the file itself."""
    load = held.get("payload") if isinstance(held, dict) else None
    if not isinstance(load, dict) or not {"interval_ms", "sensors", "values"} <= set(load):
        return held
    names = [f"{one['name']} [{one['units']}]" for one in load["sensors"]]
    times = (n * load["interval_ms"] for n in range(len(load["values"])))
    return [{"t [ms]": t, **dict(zip(names, row))} for t, row in zip(times, load["values"])]


def _samples(record: Any) -> Iterator[Any]:
    """Each sample of a message of Movesense with the message's time; another record as it is."""
    held = _inner(record)
    if not isinstance(held, dict) or not _is_records(held.get("ArrayGyro")):
        yield record
        return
    lists = {name: held[name] for name in _OF_MOVESENSE if _is_records(held.get(name))}
    for row in zip(*lists.values()):
        sample = {name: {**one, "unit": _OF_MOVESENSE[name]} for name, one in zip(lists, row)}
        yield {"Timestamp [ms]": held.get("Timestamp"), **sample}


def _is_sample(line: bytes) -> bool:
    try:
        held = _loaded(line)
    except ValueError:
        return False
    parts = held if isinstance(held, tuple) else ()  # which a program prints one in another
    flat = [v for part in parts for v in (part if isinstance(part, tuple) else [part])]
    return isinstance(held, dict) or _is_numbers(flat or held)


def _is_numbers(held: Any) -> bool:
    return isinstance(held, (list, tuple)) and all(isinstance(v, (int, float)) for v in held)


def _loaded(line: bytes) -> Any:
    """Raises ValueError."""
    try:
        return json.loads(line)
    except RecursionError as error:
        raise ValueError from error
    except ValueError:
        if b"'" not in line and not line.lstrip().startswith(b"("):
            raise
    try:
        return literal_eval(line.decode().strip())
    except (SyntaxError, TypeError, RecursionError, MemoryError) as error:
        raise ValueError from error


def _holds_all(held: Any) -> bool:
    """Whether an object is no sample but all of them: columns, or one list of records."""
    held = _inner(held)
    if _of_edge_impulse(held) is not held:
        return True
    columns = _columns(held) if isinstance(held, dict) else ()
    long = [v for _, v in columns if isinstance(v, list) and len(v) > _LONGEST_LIST]
    records = sum(map(_is_records, long))
    return records == 1 or records < len(long)


def _is_records(held: Any) -> bool:
    return isinstance(held, list) and bool(held) and isinstance(held[0], dict)


def _lines(path: Path, dropped: Counter[str]) -> Iterator[Any]:
    """The object of each line; None where a line holds none."""
    for line in lines_of(path, head(path, 4096)[1]):
        if line.strip():
            yield _object(line, dropped)


def _object(line: bytes, dropped: Counter[str]) -> Any:
    try:
        return _loaded(line)
    except ValueError:
        dropped["a line that is no JSON"] += 1
        return None


def _of_records(begun: Callable[[Counter[str]], Iterator[Any]], path: Path) -> Table:
    """begun: makes the records from the first on, of which some may be no object."""

    def every(dropped: Counter[str]) -> Iterator[Any]:
        return chain.from_iterable(map(_samples, begun(dropped)))

    first = next(every(Counter()), None)
    for name, value in first.items() if isinstance(first, dict) else ():
        if _is_records(value) and len(value) > _LONGEST_LIST:
            problem = f"each record holds {len(value)} samples or so, in {name!r}"
            raise BadRecording(path, problem, do=f"{_DO}, each with a time of its own")
    seen = [dict(_flat(record)) for record in islice(every(Counter()), _SEEN)]
    by_name: dict[str, list[Any]] = {}
    for name, value in chain.from_iterable(record.items() for record in seen):
        by_name.setdefault(name, []).append(value)
    texts = {n: [v for v in found if isinstance(v, str)] for n, found in by_name.items()}
    texts = {n: found for n, found in texts.items() if len(found) > 0.8 * len(by_name[n])}
    dates = frozenset(name for name, found in texts.items() if DATE.match(found[0]))
    kinds = {name: list(dict.fromkeys(found)) for name, found in texts.items()}
    words = {n: k for n, k in kinds.items() if n not in dates and 2 <= len(k) <= MOST_WORDS}
    names = [name for name in by_name if name not in texts or name in dates or name in words]
    if not set(names) - set(words):
        raise BadRecording(path, "JSON, and no numbers in it", do=_DO)

    def chunks(wanted: list[str]) -> Iterator[Chunk]:
        place, records = 0, every(table.dropped)
        while some := [dict(_flat(record)) for record in islice(records, _ROWS)]:
            columns = {n: [record.get(n) for record in some] for n in wanted}
            yield Chunk(
                np.arange(place, place + len(some)),
                {n: _column(v, n in dates, words.get(n)) for n, v in columns.items()},
            )
            place += len(some)

    table = Table(names, chunks, calendar=dates, words=words)
    return table


def _flat(record: Any, before: str = "", unit: str = "") -> Iterator[tuple[str, Any]]:
    """Numbers and texts of an object by their path: angular_velocity.x; those of a short list by
    their number; axes with the unit that stands beside them. A text that is a number is one."""
    items: Iterable[tuple[str, Any]] = ()
    if isinstance(record, dict):
        unit = next((f" [{record[key]}]" for key in _UNITS if key in record), unit)
        others = ((key, value) for key, value in record.items() if key not in _UNITS)
        items = ((f"{before}.{key}".lstrip("."), value) for key, value in others)
    elif isinstance(record, (list, tuple)) and len(record) <= _LONGEST_LIST:
        items = ((f"{before}[{at}]", value) for at, value in enumerate(record))
    for name, value in items:
        if isinstance(value, (dict, list, tuple)):
            yield from _flat(value, name, unit)
        elif isinstance(value, str):
            yield name, _number(value)
        elif value is not None:
            yield name + (unit if _AXIS.search(name) else ""), value


def _number(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text


def _column(values: list[Any], is_date: bool, words: list[str] | None) -> np.ndarray:
    if is_date:
        return seconds_of(pa.array([v if isinstance(v, str) else None for v in values]))
    if words is not None:
        code = {word: float(at) for at, word in enumerate(words)}
        return np.array([code.get(value, np.nan) for value in values])
    return np.array([v if isinstance(v, (int, float)) else np.nan for v in values], float)
