"""Recordings read whole, or in batches without ever holding the whole."""

from collections.abc import Callable, Iterable, Iterator
from functools import partial
from os import PathLike
from pathlib import Path

import numpy as np
import pyarrow as pa

from ..errors import BadRecording, refuse_odd_name
from . import csv_format, parquet_format
from .checks import BatchChecker, check_names
from .csv_format import unfinished_of
from .drafts import settle
from .guarded import read_in_safety
from .recording import Columns, Recording, in_order
from .scales import Scales

_MOST_BYTES = 400_000_000


class OpenRecording:
    """A recording on disk: `scales`, `column_names`, and its samples in batches.

    n_samples: number of samples where the format knows it beforehand (Parquet), else None.
    """

    def __init__(self, path: str | PathLike[str], keep_gaps: bool = False) -> None:
        self.path = Path(path)
        self.name = recording_name(self.path)
        self.n_samples: int | None = None
        self._keep_gaps = keep_gaps
        self._read_header()

    scales: Scales
    column_names: list[str]
    _batches: Callable[[int], Iterator[pa.RecordBatch]]

    def batches(self, rows: int = 65536) -> Iterator[Columns]:
        """Yield dicts of int arrays, each at most `rows` long. Raises BadRecording."""
        checker = BatchChecker(self.path, self._keep_gaps)
        for batch in self._batches(rows):
            for start in range(0, batch.num_rows, rows):
                yield checker.columns(batch.slice(start, rows))
        checker.finish()

    def _read_header(self) -> None:
        refuse_odd_name(self.path)
        settle(self.path.parent)
        if not self.path.is_file():
            what = "is a folder" if self.path.is_dir() else "no such file"
            raise BadRecording(self.path, what, do=_instead_of(self.path))
        if self.path.name.endswith(csv_format.SUFFIXES):
            header = csv_format.read_header(self.path)
            self.column_names = list(header.names)
            check_names(self.column_names, self.path)
            self.scales = csv_format.read_scales(self.path, self.column_names)
            self._batches = lambda rows: csv_format.batches(self.path, header)
        elif self.path.name.endswith(parquet_format.SUFFIXES):
            read_in_safety(self.path)
            file = parquet_format.open_file(self.path)
            self.column_names = list(file.schema_arrow.names)
            check_names(self.column_names, self.path)
            self.scales = parquet_format.read_scales(file, self.path)
            self.n_samples = file.metadata.num_rows
            self._batches = partial(parquet_format.batches, file, self.path)
        else:
            do = f"turn it into a recording: zerorate import {self.path} --out imported.parquet"
            raise BadRecording(self.path, "neither .csv, .csv.gz nor .parquet", do=do)


def _instead_of(path: Path) -> str:
    if unfinished := unfinished_of(path):
        return f"{unfinished[-1]} is there: zerorate record --recover {unfinished[-1]}"
    return "name a recording (.csv, .csv.gz or .parquet)"


def open_recording(path: str | PathLike[str], *, keep_gaps: bool = False) -> OpenRecording:
    """Open a recording for streaming; its header and scales are read and checked now.

    keep_gaps: missing values of extra channels become `checks.GAP` instead of an error.
    Raises BadRecording.
    """
    return OpenRecording(path, keep_gaps)


def read_recording(path: str | PathLike[str], *, keep_gaps: bool = False) -> Recording:
    """Read a recording whole: .csv or .csv.gz with .json beside, or .parquet (design.md).

    Raises BadRecording, naming file, row (1-based) and what to do.
    """
    opened = open_recording(path, keep_gaps=keep_gaps)
    columns = whole(opened.batches(), in_order(opened.column_names), opened.path)
    return Recording(columns, opened.scales, opened.name, opened.path)


def whole(batches: Iterable[Columns], names: list[str], path: Path) -> Columns:
    """All batches as one, which must not take more than 400 MB. Raises BadRecording."""
    parts: dict[str, list[np.ndarray]] = {name: [] for name in names}
    size = 0
    for batch in batches:
        size += sum(values.nbytes for values in batch.values())
        if size > _MOST_BYTES:
            problem = f"too long to be held in memory: more than {_MOST_BYTES // 10**6} MB"
            raise BadRecording(path, problem, do="read it in batches, with open_recording")
        for name in names:
            parts[name].append(batch[name])
    # one column after the other, so that nothing but one is there twice
    return {name: np.concatenate(parts.pop(name)) for name in names}


def recording_name(path: Path) -> str:
    """The file's name without its suffixes."""
    name = path.name
    for suffix in (".gz", ".csv", ".parquet"):
        name = name.removesuffix(suffix)
    return name
