"""NumPy's .npy and .npz, without what is pickled in them."""

from pathlib import Path

import numpy as np

from ..tables.table import Table
from .arrays import table_of_arrays

KIND = "NumPy file"


def read(path: Path, instance: int = 0) -> Table:
    """The arrays that share the most rows. Raises BadRecording."""
    do = "write its arrays by numpy.savez(..., t_s=..., gyro_dps=...), without objects in them"
    with open(path, "rb") as file:
        packed = file.read(2) == b"PK"
    if not packed:
        return table_of_arrays({"": np.load(path, allow_pickle=False)}, path, do)
    found: dict[str, object] = {}
    with np.load(path, allow_pickle=False) as arrays:
        for name in arrays.files:
            try:
                found[name] = arrays[name]
            except ValueError:  # a pickle
                continue
    return table_of_arrays(found, path, do)
