"""Named arrays as a table, out of MATLAB's .mat, HDF5, NumPy's .npy and .npz, Parquet and Feather.

An array `name` of n samples by k, in this order or the other, becomes columns name[0] ...
name[k-1], a field of a structure `name.field`. The longer side has the samples.
"""

import re
from collections.abc import Iterator
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from ...errors import BadRecording
from ...recordings.parquet_format import batches, open_file
from ..columns.names import gyro_groups
from ..tables.sniffing import MOST_WORDS
from ..tables.table import Chunk, Table, one_after_the_other

#: Bytes that MATLAB writes before its HDF5, whose arrays have their axes in turned order.
_MATLAB_BYTES = 512
_RATE = re.compile(r"(?:.*[._ ])?(?:fs|sr|odr|hz|(?:sampl\w*[_ ]?)?(?:rate|freq\w*))", re.I)


def matlab(path: Path) -> Table:
    """A .mat up to version 7; 7.3 is HDF5. Raises BadRecording."""
    import scipy.io

    do = "objects, tables and timetables only MATLAB reads: save plain arrays, by save -v7"
    found = scipy.io.loadmat(path)
    found.pop("None", None)  # what an object of MATLAB's own comes as
    return table_of_arrays(found, path, do)


def hdf5(path: Path) -> Table:
    """Its data sets. Raises BadRecording, ModuleNotFoundError."""
    import h5py

    found: dict[str, Any] = {}
    with h5py.File(path) as file:
        turned = file.userblock_size == _MATLAB_BYTES

        def take(name: str, part: Any) -> None:
            if isinstance(part, h5py.Dataset) and part.ndim in (1, 2):
                values = part[()]
                fields = getattr(values.dtype, "names", None)
                found["" if fields else name] = values.T if turned else values

        file.visititems(take)
    return table_of_arrays(found, path, "write its table as a CSV, as pandas does by to_csv")


def numpy_file(path: Path) -> Table:
    """The arrays of an .npy or .npz, without what is pickled in them. Raises BadRecording."""
    do = "write its arrays by numpy.savez(..., t_s=..., gyro_dps=...), without objects in them"
    with open(path, "rb") as file:
        packed = file.read(2) == b"PK"
    if not packed:
        return table_of_arrays({"": np.load(path, allow_pickle=False)}, path, do)
    found: dict[str, object] = {}
    with np.load(path, allow_pickle=False) as arrays:
        for name in arrays.files:
            with suppress(ValueError):  # a pickle
                found[name] = arrays[name]
    return table_of_arrays(found, path, do)


def table_of_arrays(found: dict[str, Any], path: Path, do: str) -> Table:
    """The arrays of as many rows as those that are called rates, else of the most. do: what to do
    where there is none of numbers.

    Raises BadRecording.
    """
    numeric = {
        name: np.atleast_2d(value.T).T
        for name, value in _flat(found).items()
        if not name.startswith("__")
        and isinstance(value, np.ndarray)
        and value.dtype.kind in "fiub"
        and value.ndim <= 2
    }
    numeric = {n: v.T if v.shape[0] < v.shape[1] else v for n, v in numeric.items()}
    by_rows: dict[int, dict[str, np.ndarray]] = {}
    for name, value in numeric.items():
        columns = by_rows.setdefault(len(value), {})
        for k in range(value.shape[1]):
            columns[name if value.shape[1] == 1 else f"{name}[{k}]"] = value[:, k]
    every = [by_rows[rows] for rows in sorted(by_rows, reverse=True) if rows]
    if not every:
        raise BadRecording(path, "no array of numbers", do=do)
    columns = next((one for one in every if gyro_groups(list(one))), every[0])
    chunks = partial(one_after_the_other, [columns])
    return Table(list(columns), chunks, said_hz=rate_said(found))


def rate_said(found: dict[str, Any]) -> float | None:
    """Samples a second, where one number is called as such: fs, frequency, sample_rate."""
    said = [v for n, v in found.items() if _RATE.fullmatch(n) and np.size(v) == 1]
    numbers = [float(np.ravel(v)[0]) for v in said if np.asarray(v).dtype.kind in "fiu"]
    return next((hz for hz in numbers if hz > 0), None)


def _flat(found: dict[str, object]) -> dict[str, object]:
    """The fields of structures as arrays of their own: imu.gyro."""
    out: dict[str, object] = {}
    for name, value in found.items():
        if isinstance(value, np.ndarray) and value.dtype.names:
            one = value.dtype.hasobject and value.size == 1
            fields = {field: value[field] for field in value.dtype.names}
            named = {f"{name}.{f}".lstrip("."): v.item() if one else v for f, v in fields.items()}
            out |= _flat(named)
        else:
            out[name] = value
    return out


#: Cells of a batch: 32 MB of numbers.
_CELLS, _ROWS = 4_194_304, 65_536


def columnar(path: Path) -> Table:
    """Its numbers, times, and columns of few words. Raises BadRecording."""
    with open(path, "rb") as file:
        feather = file.read(6) == b"ARROW1"
    source: Any = pa.ipc.open_file(pa.memory_map(str(path))) if feather else open_file(path)
    schema = source.schema if feather else source.schema_arrow
    twice = next((name for name in schema.names if schema.names.count(name) > 1), None)
    if twice is not None:
        raise BadRecording(path, f"the column {twice!r} is there twice", do="give it another name")
    kinds = {field.name: field.type for field in schema}
    rows = min(_ROWS, max(1, _CELLS // max(1, len(kinds))))

    def every() -> Iterator[pa.RecordBatch]:
        if not feather:
            yield from batches(source, path, rows, list(kinds))
            return
        for number in range(source.num_record_batches):
            batch = source.get_batch(number)
            yield from (batch.slice(at, rows) for at in range(0, batch.num_rows, rows))

    dates = frozenset(name for name, kind in kinds.items() if pa.types.is_timestamp(kind))
    first = next(every(), None)
    words = _words(first) if first is not None else {}
    names = [n for n, kind in kinds.items() if _is_number(kind) or n in dates or n in words]

    def chunks(wanted: list[str]) -> Iterator[Chunk]:
        place = 0
        for batch in every():
            columns = {n: _floats(batch.column(n), n in dates, words.get(n)) for n in wanted}
            yield Chunk(np.arange(place, place + batch.num_rows), columns)
            place += batch.num_rows

    return Table(names, chunks, calendar=dates, words=words)


def _words(batch: pa.RecordBatch) -> dict[str, list[str]]:
    out = {}
    for name, column in zip(batch.schema.names, batch.columns):
        if pa.types.is_dictionary(column.type):
            column = column.cast(column.type.value_type)
        if pa.types.is_string(column.type) or pa.types.is_large_string(column.type):
            found = [word for word in column.unique().to_pylist() if word]
            if 2 <= len(found) <= MOST_WORDS:
                out[name] = found
    return out


def _is_number(kind: pa.DataType) -> bool:
    return pa.types.is_integer(kind) or pa.types.is_floating(kind) or pa.types.is_boolean(kind)


def _floats(values: pa.Array, is_date: bool, words: list[str] | None = None) -> np.ndarray:
    if words is not None:
        text = values.cast(pa.string())
        return _floats(pc.index_in(text, value_set=pa.array(words, pa.string())), False)
    if is_date:
        since = pc.cast(values, pa.timestamp("ns", values.type.tz), safe=False)
        return _floats(pc.cast(since, pa.int64()), False) * 1e-9
    return pc.cast(values, pa.float64(), safe=False).to_numpy(zero_copy_only=False)
