"""Rows set aside in a temporary file, so that no recording is ever whole in memory."""

import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pyarrow as pa

TIME, PLACE = "t_us", "place"


@dataclass(frozen=True)
class Piece:
    """What is known of a stretch of rows. ends: by column, its first and its last reading, each as
    (t_us, value)."""

    rows: int
    first_us: float
    last_us: float
    in_order: bool
    ends: dict[str, tuple[tuple[float, float], tuple[float, float]]] = field(default_factory=dict)


class Spool:
    """Float columns of which `t_us` is one, written in pieces and read again in any order.

    The file has no name and goes with the process, however that ends.
    """

    def __init__(self, names: list[str], folder: Path | None = None) -> None:
        self.names = names
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

    def span_us(self, name: str) -> tuple[float, float] | None:
        """When a column has its first and its last reading; None where it has none."""
        ends = [piece.ends[name] for piece in self.pieces if name in piece.ends]
        if not ends:
            return None
        return min(first[0] for first, _ in ends), max(last[0] for _, last in ends)

    def close(self) -> None:
        self._reader = None
        self._file.close()


def _ends(t_us: np.ndarray, values: np.ndarray):
    at = np.flatnonzero(np.isfinite(values))
    if not len(at):
        return None
    first, last = at[0], at[-1]
    return (t_us[first], values[first]), (t_us[last], values[last])
