"""CSV and .csv.gz with run.json beside run.csv.gz."""

from __future__ import annotations

import csv
import gzip
import io
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.csv

from ..errors import BadRecording
from .checks import arrow_column, check_names
from .recording import TIME
from .scales import Scales, scales_from_text

SUFFIXES = (".csv", ".csv.gz")
_NO_VALUE = ("", "nan", "na", "null", "none")
_BLOCK_BYTES = 1 << 20


def scales_path(path: Path) -> Path:
    """run.json for run.csv or run.csv.gz."""
    return path.with_name(path.name.removesuffix(".gz").removesuffix(".csv") + ".json")


def read_scales(path: Path) -> Scales:
    """The scales beside a CSV. Raises BadRecording."""
    beside = scales_path(path)
    try:
        return scales_from_text(beside.read_bytes(), beside)
    except FileNotFoundError as error:
        do = (
            'write {"sensor": ..., "odr_hz": ..., "gyro_lsb_per_dps": ...} there, '
            "or turn a foreign CSV into a recording with `zerorate import`"
        )
        problem = f"{beside.name} with the scales is missing beside it"
        raise BadRecording(path, problem, do=do) from error


def read_names(path: Path) -> list[str]:
    """Column names of the header. Raises BadRecording."""
    try:
        with _text(path) as file:
            header = next(csv.reader(file), None)
    except (EOFError, zlib.error, gzip.BadGzipFile) as error:
        raise _damaged(path) from error
    except UnicodeDecodeError as error:
        raise BadRecording(path, "not text", do="name a CSV file") from error
    if header is None:
        raise BadRecording(path, "empty file", do="record again, or name another file")
    return [name.strip() for name in header]


def batches(path: Path, names: list[str]) -> Iterator[pa.RecordBatch]:
    """Arrow batches of int64 columns, read as they are needed. Raises BadRecording."""
    try:
        yield from _open(path, names)
    except (pa.ArrowInvalid, pa.ArrowNotImplementedError, OSError, EOFError) as error:
        raise _diagnosis(path, names, error) from error


def _open(path: Path, names: list[str]) -> pyarrow.csv.CSVStreamingReader:
    return pyarrow.csv.open_csv(
        str(path),
        read_options=pyarrow.csv.ReadOptions(
            block_size=_BLOCK_BYTES, column_names=names, skip_rows=1, use_threads=False
        ),
        convert_options=pyarrow.csv.ConvertOptions(
            column_types={name: pa.int64() for name in names},
            null_values=["", "nan", "NaN", "NA", "null", "None"],
        ),
    )


def _text(path: Path) -> Any:
    if path.name.endswith(".gz"):
        return gzip.open(path, "rt", encoding="utf-8-sig", newline="")
    return open(path, encoding="utf-8-sig", newline="")


def _damaged(path: Path) -> BadRecording:
    return BadRecording(path, "the gzip data is cut off or damaged", do="copy the file again")


def _diagnosis(path: Path, names: list[str], error: Exception) -> BadRecording:
    """Find the row that Arrow stumbled over, as its own message does not always name it."""
    try:
        with _text(path) as file:
            return _first_bad_row(path, names, csv.reader(file)) or BadRecording(path, str(error))
    except (EOFError, zlib.error, gzip.BadGzipFile):
        return _damaged(path)
    except UnicodeDecodeError:
        return BadRecording(path, "not text", do="name a CSV file")


def _first_bad_row(path: Path, names: list[str], rows: Any) -> BadRecording | None:
    next(rows, None)
    for number, cells in enumerate((cells for cells in rows if cells), start=1):
        if len(cells) != len(names):
            problem = f"{len(cells)} cells where the header names {len(names)}"
            return BadRecording(path, problem, row=number, do="complete or drop the row")
        for name, cell in zip(names, cells):
            if not _is_integer(cell):
                do = "give raw LSB as integers, or convert with `zerorate import`"
                problem = f"{name} is {cell[:40]!r}, no integer"
                return BadRecording(path, problem, row=number, do=do)
    return None


def _is_integer(cell: str) -> bool:
    text = cell.strip()
    return text.lower() in _NO_VALUE or text.lstrip("+-").isdecimal()


class CsvWriter:
    """Appends batches to a CSV; the names come with the first batch."""

    def __init__(self, path: Path, names: list[str]) -> None:
        check_names(names, path)
        types = [(name, pa.int64() if name == TIME else pa.int32()) for name in names]
        self._schema = pa.schema(types)
        options = pyarrow.csv.WriteOptions(include_header=False, quoting_style="none")
        compression = "gzip" if path.name.endswith(".gz") else None
        self._file = pa.output_stream(str(path), compression=compression)
        header = io.StringIO()
        csv.writer(header, lineterminator="\n").writerow(names)
        self._file.write(header.getvalue().encode())
        self._writer = pyarrow.csv.CSVWriter(self._file, self._schema, write_options=options)

    def append(self, columns: dict[str, Any]) -> None:
        """Write one batch of equally long columns."""
        arrays = [
            arrow_column(name, columns[name], self._schema.field(name).type)
            for name in self._schema.names
        ]
        self._writer.write_batch(pa.RecordBatch.from_arrays(arrays, schema=self._schema))

    def close(self) -> None:
        """Flush and close the file."""
        self._writer.close()
        self._file.close()
