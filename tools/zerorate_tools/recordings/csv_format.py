"""CSV and .csv.gz with run.json beside run.csv.gz."""

import csv
import io
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.csv

from ..errors import BadRecording
from .checks import arrow_batch, check_names
from .recording import TIME
from .scales import MOST_BYTES, Scales, example_for, scales_from_text

SUFFIXES = (".csv", ".csv.gz")
_HEADER_BYTES = 1 << 16
_BLOCK_BYTES = 1 << 20


def scales_path(path: Path) -> Path:
    """run.json for run.csv or run.csv.gz."""
    return path.with_name(path.name.removesuffix(".gz").removesuffix(".csv") + ".json")


def read_scales(path: Path, column_names: list[str]) -> Scales:
    """The scales beside a CSV, whole for its columns. Raises BadRecording."""
    beside = scales_path(path)
    try:
        with open(beside, "rb") as file:
            return scales_from_text(file.read(MOST_BYTES + 1), beside, column_names)
    except FileNotFoundError as error:
        example = example_for(column_names)
        do = f"write there, with your sensor's numbers for these of an MPU-6050: {example}"
        problem = f"what one LSB means is unknown: there is no {beside.name} beside it"
        raise BadRecording(path, problem, do=do) from error


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


_PACKED = {
    b"\x1f\x8b": "gzip",
    b"BZh": "bz2",
    b"\x28\xb5\x2f\xfd": "zstd",
    b"\x04\x22\x4d\x18": "lz4",
}
_MARKS = {
    b"\xff\xfe\x00\x00": "utf-32",
    b"\x00\x00\xfe\xff": "utf-32",
    b"\xff\xfe": "utf-16",
    b"\xfe\xff": "utf-16",
    b"\xef\xbb\xbf": "utf-8",
}


def open_text(path: Path, encoding: str = "utf-8") -> tuple[pa.NativeFile, Callable[[], int]]:
    """The text as UTF-8 bytes, and how many bytes of the file itself were read so far."""
    raw = pa.OSFile(str(path))
    stream = raw
    packed = _packed(path)
    if packed is not None:
        stream = pa.CompressedInputStream(raw, packed)
    if encoding != "utf-8":
        stream = pa.transcoding_input_stream(stream, encoding, "utf-8")
    return stream, raw.tell


def head(path: Path, size: int) -> tuple[bytes, str]:
    """The first `size` bytes, unpacked, and the encoding that they are in. Raises BadRecording."""
    try:
        content = open_text(path)[0].read(size)
    except (OSError, EOFError, pa.ArrowException) as error:
        raise damaged(path) from error
    return content, _encoding(content)


def damaged(path: Path) -> BadRecording:
    """What to raise where a packed file cannot be unpacked."""
    kind = _packed(path) or "file"
    return BadRecording(path, f"the {kind} data is cut off or damaged", do="copy the file again")


def _packed(path: Path) -> str | None:
    with open(path, "rb") as file:
        start = file.read(4)
    return next((name for mark, name in _PACKED.items() if start.startswith(mark)), None)


def _encoding(content: bytes) -> str:
    for mark, name in _MARKS.items():
        if content.startswith(mark):
            return name
    sample = content[:4096]
    if len(sample) > 8 and sample[1::2].count(0) > 0.4 * len(sample):
        return "utf-16-le"
    if len(sample) > 8 and sample[::2].count(0) > 0.4 * len(sample):
        return "utf-16-be"
    try:
        content[: len(content) - 3].decode("utf-8")
    except UnicodeDecodeError as error:
        # a letter cut in two at the end is no sign of another encoding
        return "utf-8" if error.start > len(content) - 8 else "latin-1"
    return "utf-8"
