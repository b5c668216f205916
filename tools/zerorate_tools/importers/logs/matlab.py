"""MATLAB .mat files up to version 7; 7.3 is HDF5."""

from pathlib import Path

from ..tables.table import Table
from .arrays import table_of_arrays

KIND = ".mat file"


def read(path: Path, instance: int = 0) -> Table:
    """The variables that share the most rows. Raises BadRecording."""
    import scipy.io

    do = "objects, tables and timetables only MATLAB reads: save plain arrays, by save -v7"
    found = scipy.io.loadmat(path)
    found.pop("None", None)  # what an object of MATLAB's own comes as
    return table_of_arrays(found, path, do)
