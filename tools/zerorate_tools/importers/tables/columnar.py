"""Parquet of others, row group by row group."""

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from ...recordings.parquet_format import batches, open_file
from .table import Chunk, Table

_ROWS = 1 << 16


def columnar(path: Path, advance: Callable[[float], None] = lambda n: None) -> Table:
    """The table of a Parquet file's numbers and times. Raises BadRecording."""
    file = open_file(path)
    kinds = {field.name: field.type for field in file.schema_arrow}
    dates = frozenset(name for name, kind in kinds.items() if pa.types.is_timestamp(kind))
    names = [name for name, kind in kinds.items() if _is_number(kind) or name in dates]

    def chunks(wanted: list[str]) -> Iterator[Chunk]:
        place = 0
        share = path.stat().st_size / max(file.metadata.num_rows, 1)
        for batch in batches(file, path, _ROWS, wanted):
            rows = np.arange(place, place + batch.num_rows)
            yield Chunk(rows, {n: _floats(batch.column(n), n in dates) for n in wanted})
            place += batch.num_rows
            advance(batch.num_rows * share)

    return Table(names, chunks, calendar=dates)


def _is_number(kind: pa.DataType) -> bool:
    return pa.types.is_integer(kind) or pa.types.is_floating(kind) or pa.types.is_boolean(kind)


def _floats(values: pa.Array, is_date: bool) -> np.ndarray:
    if is_date:
        since = pc.cast(values, pa.timestamp("ns", values.type.tz), safe=False)
        return _floats(pc.cast(since, pa.int64()), False) * 1e-9
    return pc.cast(values, pa.float64(), safe=False).to_numpy(zero_copy_only=False)
