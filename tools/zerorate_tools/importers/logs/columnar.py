"""Parquet and Feather of others, batch by batch."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from ...errors import BadRecording
from ...recordings.parquet_format import batches, open_file
from ..tables.sniffing import MOST_WORDS
from ..tables.table import Chunk, Table

#: Cells of a batch: 32 MB of numbers.
_CELLS, _ROWS = 4_194_304, 65_536


def read(path: Path, instance: int = 0) -> Table:
    """Its numbers, times, and columns of few words. Raises BadRecording."""
    with open(path, "rb") as file:
        feather = file.read(6) == b"ARROW1"
    source: Any = pa.ipc.open_file(pa.memory_map(str(path))) if feather else open_file(path)
    schema = source.schema if feather else source.schema_arrow
    twice = next((name for name in schema.names if schema.names.count(name) > 1), None)
    if twice is not None:
        raise BadRecording(path, f"the column {twice!r} is there twice", do="give it another name")
    kinds = {field.name: field.type for field in schema}
    rows = min(_ROWS, max(1, _CELLS // max(1, len(kinds))))

    def every() -> Iterator[pa.RecordBatch]:
        if not feather:
            yield from batches(source, path, rows, list(kinds))
            return
        for number in range(source.num_record_batches):
            batch = source.get_batch(number)
            yield from (batch.slice(at, rows) for at in range(0, batch.num_rows, rows))

    dates = frozenset(name for name, kind in kinds.items() if pa.types.is_timestamp(kind))
    first = next(every(), None)
    words = _words(first) if first is not None else {}
    names = [n for n, kind in kinds.items() if _is_number(kind) or n in dates or n in words]

    def chunks(wanted: list[str]) -> Iterator[Chunk]:
        place = 0
        for batch in every():
            columns = {n: _floats(batch.column(n), n in dates, words.get(n)) for n in wanted}
            yield Chunk(np.arange(place, place + batch.num_rows), columns)
            place += batch.num_rows

    return Table(names, chunks, calendar=dates, words=words)


def _words(batch: pa.RecordBatch) -> dict[str, list[str]]:
    out = {}
    for name, column in zip(batch.schema.names, batch.columns):
        if pa.types.is_dictionary(column.type):
            column = column.cast(column.type.value_type)
        if pa.types.is_string(column.type) or pa.types.is_large_string(column.type):
            found = [word for word in column.unique().to_pylist() if word]
            if 2 <= len(found) <= MOST_WORDS:
                out[name] = found
    return out


def _is_number(kind: pa.DataType) -> bool:
    return pa.types.is_integer(kind) or pa.types.is_floating(kind) or pa.types.is_boolean(kind)


def _floats(values: pa.Array, is_date: bool, words: list[str] | None = None) -> np.ndarray:
    if words is not None:
        text = values.cast(pa.string())
        return _floats(pc.index_in(text, value_set=pa.array(words, pa.string())), False)
    if is_date:
        since = pc.cast(values, pa.timestamp("ns", values.type.tz), safe=False)
        return _floats(pc.cast(since, pa.int64()), False) * 1e-9
    return pc.cast(values, pa.float64(), safe=False).to_numpy(zero_copy_only=False)
