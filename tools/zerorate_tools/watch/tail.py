"""New rows of a CSV that somebody else is writing."""

import io
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.csv

from ..errors import BadRecording
from ..recordings import csv_format
from ..recordings.checks import check_names
from ..recordings.recording import TIME, Columns
from ..recordings.unfinished import unfinished_of

_MOST_BYTES = 1 << 20


def growing_file(path: Path) -> Path:
    """The file to follow for a recording of this name.

    While `zerorate record` makes it, it is the CSV beside (recordings.growing). Raises BadRecording
    for what cannot be followed.
    """
    if not path.is_file() and (unfinished := unfinished_of(path)):
        return unfinished[-1]
    if path.name.endswith(".parquet"):
        problem = "a Parquet file has its index at its end, so it cannot be read while it grows"
        raise BadRecording(path, problem, do="record to .csv, or use `zerorate replay` afterwards")
    if path.name.endswith(".gz"):
        problem = "gzip holds rows back until a block of them is full"
        raise BadRecording(path, problem, do="record to .csv, or use `zerorate replay` afterwards")
    if not path.is_file():
        do = "name a .csv that is being written, a board's port or /dev/i2c-N"
        raise BadRecording(path, "no such file", do=do)
    return path


class CsvTail:
    """Reads the rows of a growing CSV, each once; the last one only when its line has ended.

    scales, column_names: as of OpenRecording; bad_rows: rows left out because they are no rows of
    integers; restarts: times that the file became shorter and was read from its beginning.
    """

    def __init__(self, path: Path) -> None:
        self.path = growing_file(path)
        self.name = path.name
        self.column_names = csv_format.read_header(self.path).names
        check_names(self.column_names, self.path)
        self.scales = csv_format.read_scales(self.path, self.column_names)
        self.bad_rows = self.restarts = 0
        self._begin()

    def _begin(self) -> None:
        self._offset, self._rest, self._is_header = 0, b"", True

    def read(self) -> Columns | None:
        """Columns of the rows that came since, at most a megabyte of them; None without any.

        Raises BadRecording when the file is gone.
        """
        data = self._new_bytes()
        whole, end, self._rest = data.rpartition(b"\n")
        if self._is_header and end:
            _, _, whole = whole.partition(b"\n")
            self._is_header = False
        return self._columns(whole) if whole else None

    def _new_bytes(self) -> bytes:
        try:
            with self.path.open("rb") as file:
                if file.seek(0, io.SEEK_END) < self._offset:
                    self.restarts += 1
                    self._begin()
                file.seek(self._offset)
                data = file.read(_MOST_BYTES)
        except FileNotFoundError as error:
            raise BadRecording(self.path, "the file is gone", do="watch another") from error
        self._offset += len(data)
        return self._rest + data

    def _columns(self, rows: bytes) -> Columns | None:
        try:
            return _parsed(rows, self.column_names)
        except pa.ArrowInvalid:
            good = [row for row in rows.splitlines() if self._is_row(row)]
            return _parsed(b"\n".join(good), self.column_names) if good else None

    def _is_row(self, row: bytes) -> bool:
        cells = [cell.strip().lstrip(b"-+") for cell in row.split(b",")]
        good = len(cells) == len(self.column_names) and all(cell.isdigit() for cell in cells)
        self.bad_rows += not good and bool(row.strip())
        return good


def _parsed(rows: bytes, names: list[str]) -> Columns:
    table = pyarrow.csv.read_csv(
        io.BytesIO(rows),
        read_options=pyarrow.csv.ReadOptions(column_names=names, use_threads=False),
        convert_options=pyarrow.csv.ConvertOptions(
            column_types={name: pa.int64() for name in names}, null_values=[]
        ),
    )
    types = {name: np.int64 if name == TIME else np.int32 for name in names}
    return {name: table[name].to_numpy().astype(types[name]) for name in names}
