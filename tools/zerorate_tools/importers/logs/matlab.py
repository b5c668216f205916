"""MATLAB .mat files as tables: an (n, k) variable `name` becomes columns name[0] ... name[k-1], a
field of a structure `name.field`."""

from collections import Counter
from functools import partial
from pathlib import Path

import numpy as np

from ...errors import BadRecording
from ..tables.table import Table
from .streams import one_after_the_other

KIND = ".mat file"


def read(path: Path, instance: int = 0) -> Table:
    """The variables that share the most rows. Raises BadRecording."""
    import scipy.io

    try:
        found = scipy.io.loadmat(path)
    except NotImplementedError as error:
        do = "save it in MATLAB with -v7"
        raise BadRecording(path, "a .mat of version 7.3 (HDF5)", do=do) from error
    return _table(found, path)


def _table(found: dict[str, object], path: Path) -> Table:
    numeric = {
        name: np.atleast_2d(value.T).T
        for name, value in _flat(found).items()
        if not name.startswith("__")
        and isinstance(value, np.ndarray)
        and value.dtype.kind in "fiub"
        and value.ndim <= 2
    }
    numeric = {n: v.T if v.shape[0] == 1 and v.shape[1] > 1 else v for n, v in numeric.items()}
    rows = max(Counter(len(v) for v in numeric.values()), default=0)
    columns: dict[str, np.ndarray] = {}
    for name, value in numeric.items():
        if rows and len(value) == rows:
            for k in range(value.shape[1]):
                columns[name if value.shape[1] == 1 else f"{name}[{k}]"] = value[:, k]
    if not columns:
        do = "tables and timetables only MATLAB reads: write one with writetable as a CSV"
        raise BadRecording(path, "no variable of numbers", do=do)
    return Table(list(columns), partial(one_after_the_other, [columns]))


def _flat(found: dict[str, object]) -> dict[str, object]:
    """The fields of structures as variables of their own: imu.gyro."""
    out: dict[str, object] = {}
    for name, value in found.items():
        if isinstance(value, np.ndarray) and value.dtype.names and value.size == 1:
            fields = {f"{name}.{field}": value[field].item() for field in value.dtype.names}
            out |= _flat(fields)
        else:
            out[name] = value
    return out
