"""A file as named columns of numbers that come in chunks."""

from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from itertools import islice

import numpy as np

_ROWS = 32_768
#: What single precision holds; the square of more would not be finite in double precision.
_MOST = float(np.finfo(np.float32).max)


@dataclass
class Chunk:
    """Rows in the file's order. place: (n,) each row's 0-based number among the data rows;
    columns: (n,) floats by name, NaN where a cell is no number, or too large for a sensor's."""

    place: np.ndarray
    columns: dict[str, np.ndarray]

    def __post_init__(self) -> None:
        for name, values in self.columns.items():
            if (beyond := np.abs(values) > _MOST).any():
                self.columns[name] = np.where(beyond, np.nan, values)


@dataclass
class Table:
    """What a reader knows of a file before it reads the rows.

    chunks: the rows of the columns asked for, from the first one at each call; it adds to `dropped`
    what it leaves out. mapping: words as of --map that the format itself implies. calendar: columns
    of dates and times, which come as seconds since 1970. words: columns of words, of which there
    are few: they come as each word's number. said_hz: what the file says of its rate. read_bytes:
    of the file, so far, where the reader knows. parts: files that it is made of.
    """

    names: list[str]
    chunks: Callable[[list[str]], Iterator[Chunk]]
    mapping: list[str] = field(default_factory=list)
    calendar: frozenset[str] = frozenset()
    words: dict[str, list[str]] = field(default_factory=dict)
    sensor: str = ""
    dropped: Counter[str] = field(default_factory=Counter)
    notes: list[str] = field(default_factory=list)
    said_hz: float | None = None
    read_bytes: float = 0.0
    parts: int = 1

    @contextmanager
    def looked_at(self) -> Iterator[Callable[[list[str]], Iterator[Chunk]]]:
        """Yield `chunks`; what is left out of them within the block is not counted."""
        dropped = self.dropped.copy()
        try:
            yield self.chunks
        finally:
            self.dropped.clear()
            self.dropped.update(dropped)

    def first_rows(self, names: list[str]) -> dict[str, np.ndarray]:
        """The columns asked for, of the first chunk; empty ones where there is no row."""
        with self.looked_at() as chunks:
            first = next(iter(chunks(names)), None) if names else None
        return first.columns if first else {name: np.empty(0) for name in names}


def chunks_of(begun: Callable[[], Iterable[dict[str, float]]], names: list[str]) -> Iterator[Chunk]:
    """Chunks of rows, from the first on, that each have some of the columns; the others are NaN."""
    start, rows = 0, iter(begun())
    while some := list(islice(rows, _ROWS)):
        columns = {name: np.array([row.get(name, np.nan) for row in some], float) for name in names}
        yield Chunk(np.arange(start, start + len(some)), columns)
        start += len(some)


def one_after_the_other(
    streams: Iterable[dict[str, np.ndarray]], names: list[str]
) -> Iterator[Chunk]:
    """Chunks of whole streams of columns: the rows of the first, then those of the next."""
    start = 0
    for stream in streams:
        size = len(next(iter(stream.values())))
        for first in range(0, size, _ROWS):
            end = min(first + _ROWS, size)
            nan = np.full(end - first, np.nan)
            columns = {
                name: stream[name][first:end].astype(float) if name in stream else nan
                for name in names
            }
            yield Chunk(np.arange(start + first, start + end), columns)
        start += size
