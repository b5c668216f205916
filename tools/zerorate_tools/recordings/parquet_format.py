"""Parquet with the scales as schema metadata under the key `zerorate`."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq

from ..bounds import MEMORY_MB
from ..errors import BadRecording
from .checks import arrow_batch, arrow_schema
from .scales import Scales, scales_from_text

SUFFIXES = (".parquet",)
_KEY = b"zerorate"
# columns stream through this much each, so that one huge row group costs no more than many small
_BUFFER_BYTES = 65_536


def open_file(path: Path) -> pq.ParquetFile:
    """The opened Parquet file. Raises BadRecording."""
    if path.stat().st_size == 0:
        raise BadRecording(path, "empty file", do="record again, or name another file")
    try:
        how = {"buffer_size": _BUFFER_BYTES, "page_checksum_verification": True}
        return pq.ParquetFile(path, pre_buffer=False, **how)
    except MemoryError as error:
        raise _too_large(path) from error
    except Exception as error:  # of a damaged one, whatever its parser stumbles over
        problem = "no Parquet file, or cut off"
        raise BadRecording(path, problem, do="copy the file again") from error


def read_scales(file: pq.ParquetFile, path: Path) -> Scales:
    """The scales in the schema's metadata. Raises BadRecording."""
    text = (file.schema_arrow.metadata or {}).get(_KEY)
    if text is None:
        problem = "no scales (schema metadata `zerorate`)"
        do = "write it with zerorate_tools.write_recording, or convert with `zerorate import`"
        raise BadRecording(path, problem, do=do)
    return scales_from_text(text, path, file.schema_arrow.names)


def batches(
    file: pq.ParquetFile, path: Path, rows: int, names: list[str] | None = None
) -> Iterator[pa.RecordBatch]:
    """Arrow batches of at most `rows`, row groups read as they are needed. Raises BadRecording."""
    try:
        yield from file.iter_batches(batch_size=rows, columns=names, use_threads=False)
    except MemoryError as error:
        raise _too_large(path) from error
    except Exception as error:
        problem = "the Parquet data is damaged"
        raise BadRecording(path, problem, do="copy the file again") from error


def _too_large(path: Path) -> BadRecording:
    problem = f"a page of it takes more than {MEMORY_MB} MB"
    return BadRecording(path, problem, do="write it with smaller pages, or copy it again")


class TableWriter:
    """Writes tables of one form to a Parquet file as they come; none where none came.

    how: words of pyarrow.parquet.ParquetWriter.
    """

    def __init__(self, path: Path, **how: Any) -> None:
        self._path, self._how = path, how
        self._writer: pq.ParquetWriter | None = None

    def append(self, table: pa.Table) -> None:
        if self._writer is None:
            schema = table.schema
            self._writer = pq.ParquetWriter(self._path, schema, compression="zstd", **self._how)
        self._writer.write_table(table)

    def close(self) -> None:
        if self._writer is not None:
            self._writer.close()


class ParquetWriter:
    """Appends batches to a Parquet file, one row group each."""

    def __init__(self, path: Path, names: list[str], scales: Scales) -> None:
        metadata = {_KEY: json.dumps(scales.to_json()).encode()}
        self._schema = arrow_schema(names, path).with_metadata(metadata)
        # readings lie close to each other: a third of the bytes of a dictionary, twice as fast
        self._writer = pq.ParquetWriter(
            str(path),
            self._schema,
            compression="zstd",
            write_page_checksum=True,
            use_dictionary=False,
            column_encoding=dict.fromkeys(names, "DELTA_BINARY_PACKED"),
        )

    def append(self, columns: dict[str, Any]) -> None:
        """Write one batch of equally long columns."""
        self._writer.write_batch(arrow_batch(columns, self._schema))

    def close(self) -> None:
        """Write the footer and close the file."""
        self._writer.close()
