"""HDF5, and MATLAB's .mat of version 7.3, which is HDF5 with an array's axes in turned order."""

from pathlib import Path
from typing import Any

from ..tables.table import Table
from .arrays import table_of_arrays

KIND = "HDF5 file"
#: Bytes that MATLAB writes before its HDF5.
_MATLAB_BYTES = 512


def read(path: Path, instance: int = 0) -> Table:
    """The data sets that share the most rows. Raises BadRecording, ModuleNotFoundError."""
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
