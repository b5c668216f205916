"""MATLAB .mat files up to version 7; 7.3 is HDF5."""

from pathlib import Path

from ..tables.table import Table
from .arrays import table_of_arrays

KIND = ".mat file"


def read(path: Path, instance: int = 0) -> Table:
    """The variables that share the most rows. Raises BadRecording."""
    import scipy.io

    do = "tables and timetables only MATLAB reads: write one with writetable as a CSV"
    return table_of_arrays(scipy.io.loadmat(path), path, do)
