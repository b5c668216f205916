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
from .checks import arrow_batch, check_names
from .recording import TIME
from .scales import Scales, example_for, scales_from_text
from .text import damaged, head, open_text

SUFFIXES = (".csv", ".csv.gz")
_HEADER_BYTES = 1 << 16
_BLOCK_BYTES = 1 << 20
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
    try:
        yield from _open(path, header, pa.int64())
    except (pa.ArrowException, OSError, EOFError) as error:
        raise _diagnosis(path, header, error) from error


def _open(path: Path, header: Header, kind: pa.DataType, take_odd: Any = None) -> Any:
    return pyarrow.csv.open_csv(
        open_text(path, header.encoding)[0],
        read_options=pyarrow.csv.ReadOptions(
            block_size=_BLOCK_BYTES,
            column_names=header.names,
            skip_rows=header.skip,
            use_threads=False,
        ),
        parse_options=pyarrow.csv.ParseOptions(invalid_row_handler=take_odd),
        convert_options=pyarrow.csv.ConvertOptions(
            column_types=dict.fromkeys(header.names, kind),
            null_values=["", "nan", "NaN", "NA", "null", "None"],
            strings_can_be_null=True,
            check_utf8=False,
        ),
    )


def _diagnosis(path: Path, header: Header, error: Exception) -> BadRecording:
    """Find the row that Arrow stumbled over, as its own message does not always name it."""
    odd: list[Any] = []

    def take(row: Any) -> str:
        odd.append(row)
        return "skip"

    rows = 0
    try:
        for batch in _open(path, header, pa.string(), take):
            found = _first_bad_cell(batch)
            if odd and (found is None or odd[0].number - header.skip <= rows + found[0] + 1):
                break
            if found is not None:
                at, name, cell = found
                do = "give raw LSB as integers, or convert with `zerorate import`"
                problem = f"{name} is {cell[:40]!r}, no integer"
                return BadRecording(path, problem, row=rows + at + 1, do=do)
            rows += batch.num_rows
    except pa.ArrowInvalid as again:
        if "straddling" in str(again):
            problem = f"a row is longer than {_BLOCK_BYTES >> 20} MiB"
            return BadRecording(path, problem, do="name a CSV file with a sample on each line")
    except (pa.ArrowException, OSError, EOFError):
        return damaged(path)
    if odd:
        problem = f"{odd[0].actual_columns} cells where the header names {len(header.names)}"
        row = odd[0].number - header.skip
        return BadRecording(path, problem, row=row, do="complete or drop the row")
    return BadRecording(path, str(error)[:200], do="name a CSV file")


def _first_bad_cell(batch: pa.RecordBatch) -> tuple[int, str, str] | None:
    """(row within the batch, column, cell) of the first cell that is no integer of 64 bits."""
    found = None
    for name in batch.schema.names:
        cells = batch.column(name).cast(pa.binary())
        good = pc.match_substring_regex(cells, rb"^[ \t]*[+-]?[0-9]{1,18}[ \t]*$")
        bad = pc.invert(pc.fill_null(good, True)).to_numpy(zero_copy_only=False)
        at = int(np.argmax(bad)) if bad.any() else None
        if at is not None and (found is None or at < found[0]):
            found = at, name, cells[at].as_py().decode("utf-8", "replace")
    return found


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
