"""What a batch of samples must be before anything learns from it."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from ..errors import BadRecording
from .recording import ACCEL, COLUMNS, GYRO, TIME, Columns

GAP = -(2**31)
"""Stands for a missing value of an extra channel when gaps are kept, and when they are written."""

_LIMIT = 2**31 - 1
_SORT = "sort or cut the recording there (one recording is one power-on)"
#: Between two samples, beyond which time that goes backwards is no counter that ran over.
_LONGEST_PAUSE_US = 10_000_000


def check_names(names: list[str], path: Path) -> None:
    """Raise BadRecording if a needed column is missing, or a name comes twice or is no line."""
    broken = next((name for name in names if not name.isprintable()), None)
    if broken is not None:
        raise BadRecording(path, f"column name {broken!r} is not printable", do="rename it")
    missing = [name for name in (TIME, *GYRO) if name not in names]
    if missing:
        suffix = ".parquet" if path.suffix == ".parquet" else ".csv"
        do = f"turn it into a recording: zerorate import {path} --out imported{suffix}"
        words = "column {} is missing" if len(missing) == 1 else "columns {} are missing"
        raise BadRecording(path, words.format(", ".join(missing)), do=do)
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise BadRecording(path, f"column {twice} comes twice", do="rename or drop one")
    accel = [name for name in ACCEL if name in names]
    if accel and len(accel) < 3:
        have = ", ".join(accel)
        raise BadRecording(path, f"of ax ay az only {have} is there", do="give all three or none")


def arrow_schema(names: list[str], path: Path) -> pa.Schema:
    """Of columns to be written. Raises BadRecording as `check_names`."""
    check_names(names, path)
    return pa.schema([(name, pa.int64() if name == TIME else pa.int32()) for name in names])


def arrow_batch(columns: Mapping[str, Any], schema: pa.Schema) -> pa.RecordBatch:
    """Equally long columns to be written: where an extra channel is GAP it has no value."""
    gaps = {name: np.asarray(columns[name]) == GAP for name in schema.names if _is_extra(name)}
    arrays = [pa.array(columns[f.name], f.type, mask=gaps.get(f.name)) for f in schema]
    return pa.RecordBatch.from_arrays(arrays, schema=schema)


class BatchChecker:
    """Turns Arrow batches into integer columns, refusing what is no recording.

    keep_gaps: missing values of extra channels become GAP instead of an error.
    """

    def __init__(self, path: Path, keep_gaps: bool = False) -> None:
        self._path, self._keep_gaps = path, keep_gaps
        self._rows, self._last_us = 0, None

    def columns(self, batch: pa.RecordBatch) -> Columns:
        """Columns of one batch: t_us int64, the others int32. Raises BadRecording."""
        out = {name: self._integers(name, batch.column(name)) for name in batch.schema.names}
        self._check_time(out[TIME])
        self._rows += batch.num_rows
        return out

    def finish(self) -> None:
        """Raise BadRecording if no batch had a row."""
        if self._rows == 0:
            raise BadRecording(self._path, "no data row", do="record again, or name another file")

    def _integers(self, name: str, values: pa.Array) -> np.ndarray:
        if pa.types.is_floating(values.type) and _is_extra(name):
            values = _whole(values)
        if not pa.types.is_integer(values.type):
            self._refuse_type(name, values)
        if values.null_count:
            values = self._without_gaps(name, values)
        wide = values.to_numpy(zero_copy_only=False)
        if name == TIME:
            self._check_range(name, wide, 2**63 - 1, "64")
            return wide.astype(np.int64, copy=False)
        self._check_range(name, wide, _LIMIT, "32")
        return wide.astype(np.int32, copy=False)

    def _without_gaps(self, name: str, values: pa.Array) -> pa.Array:
        extra = _is_extra(name)
        if extra and self._keep_gaps:
            return pc.fill_null(values.cast(pa.int64()), GAP)
        row = self._row(int(np.argmax(values.is_null().to_numpy(zero_copy_only=False))))
        do = f"fill the gaps or drop column {name}" if extra else "drop the row"
        raise BadRecording(self._path, f"{name} has no value", row=row, do=do)

    def _check_range(self, name: str, wide: np.ndarray, most: int, bits: str) -> None:
        outside = (wide > most) | (wide < -most - 1)
        if outside.any():
            at = int(np.argmax(outside))
            problem = f"{name} is {wide[at]}, more than {bits} bits"
            raise BadRecording(self._path, problem, row=self._row(at), do="scale the column")

    def _refuse_type(self, name: str, values: pa.Array) -> None:
        if pa.types.is_floating(values.type) and not _is_extra(name):
            bad = ~np.isfinite(values.to_numpy(zero_copy_only=False))
            if bad.any():
                at = int(np.argmax(bad))
                problem = f"{name} is {values[at].as_py()}"
                raise BadRecording(self._path, problem, row=self._row(at), do="drop the row")
        do = "give raw LSB as integers, or convert with `zerorate import`"
        raise BadRecording(self._path, f"column {name} holds {values.type}, not integers", do=do)

    def _check_time(self, t_us: np.ndarray) -> None:
        if not len(t_us):
            return
        before = t_us[0] if self._last_us is None else self._last_us
        backwards = np.diff(t_us, prepend=before) < 0
        if backwards.any():
            at = int(np.argmax(backwards))
            earlier = t_us[at - 1] if at else before
            problem = f"time goes backwards, from {earlier} to {t_us[at]} us"
            do = _wrapped(int(earlier), int(t_us[at])) or _SORT
            raise BadRecording(self._path, problem, row=self._row(at), do=do)
        self._last_us = t_us[-1]

    def _row(self, at: int) -> int:
        return self._rows + at + 1


def _is_extra(name: str) -> bool:
    return name not in COLUMNS


def _whole(values: pa.Array) -> pa.Array:
    """Floats that are all whole or NaN, as tables with gaps come to be, as integers with gaps; any
    others as they are."""
    gaps = pc.if_else(pc.is_nan(values), None, values)
    try:
        return gaps.cast(pa.int64())
    except pa.ArrowInvalid:
        return values


def _wrapped(earlier: int, later: int) -> str:
    """What to do where a counter of microseconds ran over; empty where none seems to have."""
    for bits in (30, 31, 32):
        if earlier < 1 << bits and 0 < later + (1 << bits) - earlier < _LONGEST_PAUSE_US:
            return f"a clock of {bits} bits ran over: add {1 << bits} to it from there on"
    return ""
