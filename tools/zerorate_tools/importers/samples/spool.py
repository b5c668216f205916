"""Rows set aside in a temporary file, so that no recording is ever whole in memory, and by time."""

import tempfile
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pyarrow as pa

from ...errors import BadRecording
from ..report import cut_words

TIME, PLACE = "t_us", "place"
#: Rows that may wait for their turn: some 150 MB.
_MOST_WAITING = 2_000_000
#: Rows in a row, from which on a stretch in order counts as one of its own.
_LONG = 100
_SHARED = 0.1
#: Rows that one step back may mix with others: late ones fill gaps, bursts overlap by few.
_MIXED = 10


#: The first and the last reading, each as (t_us, value).
Ends = tuple[tuple[float, float], tuple[float, float]]


@dataclass(frozen=True)
class Piece:
    """What is known of a stretch of rows. ends: by column."""

    rows: int
    first_us: float
    last_us: float
    in_order: bool
    ends: dict[str, Ends] = field(default_factory=dict)


class Spool:
    """Float columns of which `t_us` is one, written in pieces and read again in any order.

    The file has no name and goes with the process, however that ends.
    """

    def __init__(self, names: list[str], folder: Path | None = None) -> None:
        self.names, self._folder = names, folder
        self.pieces: list[Piece] = []
        self._schema = pa.schema([(name, pa.float64()) for name in names])
        self._file = tempfile.TemporaryFile(dir=folder)
        self._writer = pa.ipc.new_file(pa.PythonFile(self._file, "w"), self._schema)
        self._reader: pa.ipc.RecordBatchFileReader | None = None

    def append(self, columns: dict[str, np.ndarray]) -> None:
        """Add rows; none of them may lack its time."""
        t_us = columns[TIME]
        if not len(t_us):
            return
        arrays = [pa.array(np.asarray(columns[name], float)) for name in self.names]
        self._writer.write_batch(pa.RecordBatch.from_arrays(arrays, schema=self._schema))
        ends = {name: _ends(t_us, columns[name]) for name in self.names if name != TIME}
        self.pieces.append(
            Piece(
                len(t_us),
                float(t_us.min()),
                float(t_us.max()),
                bool((np.diff(t_us) >= 0).all()),
                {name: both for name, both in ends.items() if both is not None},
            )
        )

    def finish(self) -> None:
        self._writer.close()
        self._file.seek(0)
        self._reader = pa.ipc.open_file(pa.PythonFile(self._file, "r"))

    def read(self, number: int) -> dict[str, np.ndarray]:
        """The columns of one piece."""
        assert self._reader is not None, "finish() first"
        batch = self._reader.get_batch(number)
        return {name: batch.column(name).to_numpy() for name in self.names}

    def __iter__(self) -> Iterator[dict[str, np.ndarray]]:
        return (self.read(number) for number in range(len(self.pieces)))

    def remade(self, pieces: Iterable[dict[str, np.ndarray]]) -> "Spool":
        """A spool of these pieces in the place of this one, which is closed."""
        out = Spool(self.names, self._folder)
        for columns in pieces:
            out.append(columns)
        out.finish()
        self.close()
        return out

    def span_us(self, name: str) -> tuple[float, float] | None:
        """When a column has its first and its last reading; None where it has none."""
        ends = [piece.ends[name] for piece in self.pieces if name in piece.ends]
        if not ends:
            return None
        return min(first[0] for first, _ in ends), max(last[0] for _, last in ends)

    def close(self) -> None:
        self._reader = None
        self._file.close()


def _ends(t_us: np.ndarray, values: np.ndarray) -> Ends | None:
    at = np.flatnonzero(np.isfinite(values))
    if not len(at):
        return None
    first, last = at[0], at[-1]
    return (t_us[first], values[first]), (t_us[last], values[last])


class Runs:
    """Follows the order of time stamps: how many rows step back, and whether time begins anew."""

    def __init__(self) -> None:
        self.steps_back = 0
        self._first_back = 0
        self._long: list[tuple[float, float, int]] = []
        self._begin: tuple[float, int] | None = None
        self._last = 0.0
        self._rows = 0

    def add(self, t_us: np.ndarray, place: np.ndarray) -> None:
        """Take the time stamps of the next rows."""
        if self._begin is None and len(t_us):
            self._begin, self._last = (t_us[0], int(place[0])), t_us[0]
        read, start = np.append(self._last, t_us), 0
        back = np.flatnonzero(np.diff(read) < 0).tolist()
        if back and not self.steps_back:
            self._first_back = int(place[back[0]])
        self.steps_back += len(back)
        for at in back:
            self._rows += at - start
            self._close(read[at])
            start, self._begin = at, (t_us[at], int(place[at]))
        self._rows += len(t_us) - start
        self._last = read[-1]

    def refuse_a_restart(self, path: Path) -> None:
        """Raise BadRecording where two long stretches claim the same time, or where one leads back
        to well before the one above it: a clock was set back, or a counter ran over. Halves in the
        wrong order fit together."""
        self._close(self._last)
        for (above, _, _), (begin, end, place) in zip(self._long, self._long[1:]):
            if above - end > _SHARED * (end - begin):
                row = place + 1
                raise BadRecording(path, "time begins anew", row=row, do=cut_words(path, row))
        latest, before = -np.inf, None
        for begin, end, place in sorted(self._long):
            if before is not None and latest - begin > _SHARED * (end - begin):
                row = max(place, before) + 1
                raise BadRecording(path, "time begins anew", row=row, do=cut_words(path, row))
            if end > latest:
                latest, before = end, place

    def refuse_mixed(self, spool: Spool, path: Path) -> None:
        """Raise BadRecording where rows by time stand between others than they were read between:
        the clock was set back."""
        places = (columns[PLACE][np.isfinite(columns["gx"])] for columns in spool)
        if sum(int(np.sum(np.diff(p) < 0)) for p in places) > _MIXED * self.steps_back:
            row = self._first_back + 1
            raise BadRecording(path, "the clock is set back", row=row, do=cut_words(path, row))

    def _close(self, end: float) -> None:
        if self._begin is not None and self._rows >= _LONG:
            self._long.append((self._begin[0], end, self._begin[1]))
        self._rows = 0


def in_order(spool: Spool, path: Path) -> Spool:
    """The same rows by time; the spool itself where they are. Raises BadRecording."""
    pieces = spool.pieces
    follow = all(a.last_us <= b.first_us for a, b in zip(pieces, pieces[1:]))
    is_sorted = follow and all(piece.in_order for piece in pieces)
    return spool if is_sorted else spool.remade(_by_time(spool, path))


def _by_time(spool: Spool, path: Path) -> Iterator[dict[str, np.ndarray]]:
    pieces = spool.pieces
    numbers = sorted(range(len(pieces)), key=lambda n: pieces[n].first_us)
    waiting = {name: np.empty(0) for name in spool.names}
    for at, number in enumerate(numbers):
        piece = spool.read(number)
        waiting = {name: np.concatenate([waiting[name], piece[name]]) for name in spool.names}
        if len(waiting[TIME]) > _MOST_WAITING:
            problem = f"rows are out of order by more than {_MOST_WAITING} rows"
            raise BadRecording(path, problem, do="sort it by time first, as `sort -n` does")
        order = np.lexsort((waiting[PLACE], waiting[TIME]))
        waiting = {name: values[order] for name, values in waiting.items()}
        until = pieces[numbers[at + 1]].first_us if at + 1 < len(numbers) else np.inf
        ready = int(np.searchsorted(waiting[TIME], until))
        yield {name: values[:ready] for name, values in waiting.items()}
        waiting = {name: values[ready:] for name, values in waiting.items()}
