"""Recordings written whole or batch by batch, appearing only when complete."""

import json
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from os import PathLike
from os.path import isdir
from pathlib import Path

import numpy as np

from ..errors import BadRecording
from . import csv_format, parquet_format
from .atomic import check_name, check_room_for, written_beside, written_together
from .csv_format import CsvWriter
from .parquet_format import ParquetWriter
from .recording import Recording
from .scales import Scales, check_whole

_ROWS = 65_536


def write_recording(recording: Recording, path: str | PathLike[str]) -> None:
    """Write .parquet, or .csv / .csv.gz with .json beside it.

    An extra channel has no value where it is `checks.GAP`. Raises BadRecording for another suffix
    or for columns without scales.
    """
    with recording_writer(path, recording.column_names, recording.scales) as writer:
        for first in range(0, len(recording), _ROWS):
            writer.append(recording.between(first, first + _ROWS).columns)


def is_recording_name(path: Path) -> bool:
    """Whether a file of this name would be in a form of recordings."""
    return path.name.endswith((*csv_format.SUFFIXES, *parquet_format.SUFFIXES))


def check_output(path: str | PathLike[str]) -> None:
    """Raise InFile if no recording can be written there: ask before long work."""
    path = Path(path)
    if not is_recording_name(path):
        do = "end the name in .parquet, .csv or .csv.gz"
        raise BadRecording(path, "no format goes by this name", do=do)
    if not path.parent.is_dir():
        raise BadRecording(path, f"there is no folder {path.parent}", do="make it first")
    if isdir(path):  # a name that is too long is told where it is written
        raise BadRecording(path, "is a folder", do="name a file in it")
    check_room_for(path)


@contextmanager
def recording_writer(
    path: str | PathLike[str], column_names: list[str], scales: Scales
) -> Iterator[CsvWriter | ParquetWriter]:
    """Yield a writer whose `append(columns)` takes one batch (dict of int arrays) at a time.

    The file appears under its name when the block ends without an exception, else not at all.
    Raises BadRecording for another suffix or for columns without scales.
    """
    path = Path(path)
    check_output(path)
    check_whole(scales.to_json(), column_names, path)
    with ExitStack() as files:
        if path.name.endswith(csv_format.SUFFIXES):
            check_name(path)
            temporary = files.enter_context(written_together(path.parent)) / path.name
            beside = csv_format.scales_path(temporary)
            beside.write_text(json.dumps(scales.to_json(), indent=2) + "\n")
            writer: CsvWriter | ParquetWriter = CsvWriter(temporary, column_names)
        else:
            temporary = files.enter_context(written_beside(path))
            writer = ParquetWriter(temporary, column_names, scales)
        try:
            yield writer
        finally:
            writer.close()


def recording_from_columns(
    columns: Mapping[str, np.ndarray], scales: Scales, name: str = "recording"
) -> Recording:
    """A Recording out of integer arrays of any width: t_us becomes int64, the others int32.

    Raises BadRecording for a number that does not fit.
    """
    narrow = {}
    for key, values in columns.items():
        wide = np.asarray(values)
        narrow[key] = wide.astype(np.int64 if key == "t_us" else np.int32, copy=False)
        if (narrow[key] != wide).any():
            row = int(np.argmax(narrow[key] != wide))
            problem = f"{key} is {wide[row]}, which does not fit"
            raise BadRecording(name, problem, row=row + 1, do="scale the column")
    return Recording(narrow, scales, name)
