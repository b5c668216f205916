"""Foreign tables (CSV, TSV, Parquet, .mat) as float columns."""

from __future__ import annotations

import csv
import gzip
import zlib
from pathlib import Path

import numpy as np

from ..errors import BadRecording


def read_table(path: Path) -> dict[str, np.ndarray]:
    """Float columns of a CSV, TSV, Parquet or .mat; cells that are no number become NaN."""
    name = path.name.lower()
    if name.endswith(".mat"):
        from .matlab import read_matlab

        return read_matlab(path)
    if name.endswith(".parquet"):
        return _read_parquet(path)
    return _read_delimited(path)


def _read_parquet(path: Path) -> dict[str, np.ndarray]:
    import pyarrow as pa
    import pyarrow.parquet as pq

    try:
        frame = pq.read_table(path)
    except (pa.ArrowInvalid, OSError) as error:
        raise BadRecording(path, "no Parquet file, or cut off", do="copy the file again") from error
    numeric = [
        field.name
        for field in frame.schema
        if pa.types.is_integer(field.type) or pa.types.is_floating(field.type)
    ]
    return {name: frame[name].to_numpy().astype(float) for name in numeric}


def _read_delimited(path: Path) -> dict[str, np.ndarray]:
    import pandas

    header, delimiter = _header(path)
    try:
        frame = pandas.read_csv(
            path, sep=delimiter, skipinitialspace=True, comment=None, low_memory=False
        )
    except (EOFError, zlib.error, gzip.BadGzipFile) as error:
        raise _damaged(path) from error
    except (pandas.errors.ParserError, UnicodeDecodeError, ValueError) as error:
        raise BadRecording(path, f"no table: {error}", do="name its kind with --layout") from error
    frame.columns = [str(name).strip() for name in frame.columns]
    if frame.empty:
        raise BadRecording(path, "no data row", do="name another file")
    return {
        name: pandas.to_numeric(frame[name], errors="coerce").to_numpy(dtype=float)
        for name in frame.columns
    }


def _header(path: Path) -> tuple[str, str]:
    line = first_line(path)
    if not line.strip():
        raise BadRecording(path, "empty file", do="name another file")
    try:
        return line, csv.Sniffer().sniff(line, delimiters=",;\t").delimiter
    except csv.Error:
        return line, ","


def first_line(path: Path) -> str:
    """The first line of a text file, gzip or plain. Raises BadRecording."""
    open_it = gzip.open if path.name.endswith(".gz") else open
    try:
        with open_it(path, "rt", encoding="utf-8-sig", errors="replace") as file:
            return file.readline(65536)
    except (EOFError, zlib.error, gzip.BadGzipFile) as error:
        raise _damaged(path) from error


def _damaged(path: Path) -> BadRecording:
    return BadRecording(path, "the gzip data is cut off or damaged", do="copy the file again")
