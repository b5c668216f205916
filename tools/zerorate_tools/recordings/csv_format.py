"""CSV and .csv.gz with run.json beside run.csv.gz."""

import csv
import io
import re
from collections.abc import Iterator
from dataclasses import dataclass
from glob import escape
from itertools import count
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.csv

from ..bounds import bytes_of
from ..errors import BadRecording
from .checks import arrow_batch, arrow_schema
from .scales import Scales, example_for, scales_from_text
from .text import head, line_blocks, rows_of

SUFFIXES = (".csv", ".csv.gz")
_HEADER_BYTES = 65_536
_BLOCK_BYTES = 1_048_576
_ENDING = re.compile(r"(\.partial(-[0-9]+)?)?(\.csv|\.csv\.gz|\.parquet)$")
_UNFINISHED = re.compile(r"\.partial(-[0-9]+)?\.csv$")


def scales_path(path: Path) -> Path:
    """run.json for run.csv or run.csv.gz."""
    return path.with_name(path.name.removesuffix(".gz").removesuffix(".csv") + ".json")


def read_scales(path: Path, column_names: list[str]) -> Scales:
    """The scales beside a CSV, whole for its columns. Raises BadRecording."""
    beside = scales_path(path)
    example = example_for(column_names)
    do = f"write there, with your sensor's numbers for these of an MPU-6050: {example}"
    if not beside.exists():
        problem = f"what one LSB means is unknown: there is no {beside.name} beside it"
        raise BadRecording(path, problem, do=do)
    return scales_from_text(bytes_of(beside, do, BadRecording), beside, column_names)


@dataclass(frozen=True)
class Header:
    """Column names of a CSV, the lines before its first row, and the encoding of its text."""

    names: list[str]
    skip: int
    encoding: str


def read_header(path: Path) -> Header:
    """The first line that is not blank. Raises BadRecording."""
    content, encoding = head(path, _HEADER_BYTES)
    text = content.decode(encoding, errors="replace").lstrip("\ufeff")
    lines = text.splitlines()
    at = next((number for number, line in enumerate(lines) if line.strip()), None)
    if at is None:
        raise BadRecording(path, "empty file", do="record again, or name another file")
    if len(lines) == 1 and len(content) == _HEADER_BYTES:
        problem = f"no line ends within the first {_HEADER_BYTES >> 10} KiB"
        raise BadRecording(path, problem, do="name a CSV file")
    try:
        names = next(csv.reader([lines[at]]))
    except csv.Error as error:
        raise BadRecording(path, f"no header: {error}", do="name a CSV file") from error
    return Header([name.strip() for name in names], at + 1, encoding)


def batches(path: Path, header: Header) -> Iterator[pa.RecordBatch]:
    """Arrow batches of int64 columns, read as they are needed. Raises BadRecording."""
    start, skip = 0, header.skip
    for lines in line_blocks(path, header.encoding, lambda read: None, _BLOCK_BYTES):
        try:
            rows = rows_of(lines, header.names, pa.int64(), skip)
        except pa.ArrowInvalid as error:
            raise _diagnosis(path, header.names, lines, skip, start, error) from error
        yield from rows.to_batches()
        start, skip = start + rows.num_rows, 0


def _diagnosis(
    path: Path, names: list[str], lines: bytes, skip: int, start: int, error: Exception
) -> BadRecording:
    """Find the row of a block that Arrow stumbled over, as its own message may not name it."""
    odd: list[Any] = []

    def take(row: Any) -> str:
        odd.append(row)
        return "skip"

    try:
        found = _first_bad_cell(rows_of(lines, names, pa.string(), skip, take))
    except pa.ArrowInvalid:
        found = None
    if odd and (found is None or odd[0].number - skip <= found[0] + 1):
        problem = f"{odd[0].actual_columns} cells where the header names {len(names)}"
        row = start + odd[0].number - skip
        return BadRecording(path, problem, row=row, do="complete or drop the row")
    if found is not None:
        at, name, cell = found
        do = "give raw LSB as integers, or convert with `zerorate import`"
        problem = f"{name} is {cell[:40]!r}, no integer"
        return BadRecording(path, problem, row=start + at + 1, do=do)
    return BadRecording(path, str(error)[:200], do="name a CSV file")


def _first_bad_cell(rows: pa.Table) -> tuple[int, str, str] | None:
    """(row within the block, column, cell) of the first cell that is no integer of 64 bits."""
    found = None
    for name in rows.schema.names:
        cells = rows.column(name).combine_chunks().cast(pa.binary())
        good = pc.match_substring_regex(cells, rb"^[ \t]*[+-]?[0-9]{1,18}[ \t]*$")
        bad = pc.invert(pc.fill_null(good, True)).to_numpy(zero_copy_only=False)
        at = int(np.argmax(bad)) if bad.any() else None
        if at is not None and (found is None or at < found[0]):
            found = at, name, cells[at].as_py().decode("utf-8", "replace")
    return found


class CsvWriter:
    """Appends batches to a CSV; the names come with the first batch."""

    def __init__(self, path: Path, names: list[str]) -> None:
        self._schema = arrow_schema(names, path)
        options = pyarrow.csv.WriteOptions(include_header=False, quoting_style="none")
        compression = "gzip" if path.name.endswith(".gz") else None
        self._file = pa.output_stream(str(path), compression=compression)
        header = io.StringIO()
        csv.writer(header, lineterminator="\n").writerow(names)
        self._file.write(header.getvalue().encode())
        self._writer = pyarrow.csv.CSVWriter(self._file, self._schema, write_options=options)

    def append(self, columns: dict[str, Any]) -> None:
        """Write one batch of equally long columns."""
        self._writer.write_batch(arrow_batch(columns, self._schema))

    def close(self) -> None:
        self._writer.close()
        self._file.close()


def is_unfinished(path: Path) -> bool:
    """Whether the name is one of a recording that is not finished."""
    return _UNFINISHED.search(path.name) is not None


def stem(path: Path) -> str:
    """run, of run.parquet as of run.partial.csv."""
    return _ENDING.sub("", path.name)


def names_for(out: Path) -> Iterator[Path]:
    """Names for a recording that becomes `out`, until one is free."""
    for number in count(1):
        yield out.with_name(f"{stem(out)}.partial{f'-{number}' if number > 1 else ''}.csv")


def unfinished_of(out: Path) -> list[Path]:
    """What there is of `out` that is not finished, the newest last."""
    found = out.parent.glob(f"{escape(stem(out))}.partial*.csv")
    mine = [path for path in found if is_unfinished(path) and stem(path) == stem(out)]
    return sorted(mine, key=lambda path: path.stat().st_mtime_ns)
