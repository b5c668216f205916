"""Rows of several sensors, each at its own times, gathered into chunks of one table."""

from collections.abc import Callable, Iterable, Iterator
from itertools import islice

import numpy as np

from ..tables.table import Chunk

_ROWS = 1 << 15
_SI = [
    "t_us=t_us:us",
    *(f"g{axis}=g{axis}:rad/s" for axis in "xyz"),
    *(f"a{axis}=a{axis}:m/s2" for axis in "xyz"),
    "temp=temp:degc",
]


def si_mapping(names: Iterable[str]) -> list[str]:
    """Words as of --map for those columns of a recording that an autopilot has, in SI units."""
    names = set(names)
    return [words for words in _SI if words.partition("=")[0] in names]


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
