"""MATLAB .mat files as tables: an (n, k) variable `name` becomes columns name[0] ... name[k-1]."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import BadRecording


def load_matlab(path: Path) -> dict[str, Any]:
    """Variables of a .mat up to version 7.2. Raises BadRecording."""
    import scipy.io

    try:
        return scipy.io.loadmat(path)
    except NotImplementedError as error:
        do = "save it in MATLAB with -v7"
        raise BadRecording(path, "a .mat of version 7.3 (HDF5)", do=do) from error
    except Exception as error:  # SciPy raises whatever its parser stumbles over
        raise BadRecording(path, "no .mat file, or cut off", do="copy the file again") from error


def variable_names(path: Path) -> set[str]:
    """Names of a .mat's variables; none where it cannot be read."""
    import scipy.io

    try:
        return {name for name, *_ in scipy.io.whosmat(path)}
    except Exception:  # SciPy raises whatever its parser stumbles over
        return set()


def read_matlab(path: Path) -> dict[str, np.ndarray]:
    """Float columns of the variables that share the commonest length. Raises BadRecording."""
    numeric = {
        name: np.atleast_2d(value.T).T
        for name, value in load_matlab(path).items()
        if isinstance(value, np.ndarray) and value.dtype.kind in "fiub" and value.ndim <= 2
    }
    numeric = {n: v.T if v.shape[0] == 1 and v.shape[1] > 1 else v for n, v in numeric.items()}
    if not numeric:
        raise BadRecording(path, "no numeric variable", do="name another file")
    rows = max(Counter(len(v) for v in numeric.values()).items(), key=lambda item: item[0])[0]
    columns: dict[str, np.ndarray] = {}
    for name, value in numeric.items():
        if len(value) == rows:
            single = value.shape[1] == 1
            for k in range(value.shape[1]):
                columns[name if single else f"{name}[{k}]"] = value[:, k].astype(float)
    return columns
