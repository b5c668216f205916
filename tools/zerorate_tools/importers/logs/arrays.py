"""Named arrays as a table: an (n, k) array `name` becomes columns name[0] ... name[k-1], a field of
a structure `name.field`."""

from collections import Counter
from functools import partial
from pathlib import Path

import numpy as np

from ...errors import BadRecording
from ..tables.table import Table
from .streams import one_after_the_other


def table_of_arrays(found: dict[str, object], path: Path, do: str) -> Table:
    """The arrays that share the most rows. do: what to do where there is none of numbers.

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
    numeric = {n: v.T if v.shape[0] == 1 and v.shape[1] > 1 else v for n, v in numeric.items()}
    rows = max(Counter(len(v) for v in numeric.values()), default=0)
    columns: dict[str, np.ndarray] = {}
    for name, value in numeric.items():
        if rows and len(value) == rows:
            for k in range(value.shape[1]):
                columns[name if value.shape[1] == 1 else f"{name}[{k}]"] = value[:, k]
    if not columns:
        raise BadRecording(path, "no array of numbers", do=do)
    return Table(list(columns), partial(one_after_the_other, [columns]))


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
