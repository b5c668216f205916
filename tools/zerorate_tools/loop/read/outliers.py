"""Single blocks that stand out of their neighbours: held at the neighbours' median and counted."""

import numpy as np
from scipy.ndimage import median_filter

_LIMIT = 6.0
_WINDOW = 9


def held(residual: np.ndarray) -> tuple[np.ndarray, int]:
    """(n, A) residual with outlying blocks replaced by the running median of nine, and how many
    there were.
    """
    out, count = residual.copy(), 0
    for a in range(residual.shape[1]):
        column = residual[:, a]
        good = np.isfinite(column)
        if good.sum() < _WINDOW:
            continue
        middle = median_filter(column[good], _WINDOW, mode="nearest")
        off = column[good] - middle
        bad = np.abs(off) > _LIMIT * max(1.4826 * np.median(np.abs(off)), 1e-12)
        out[np.flatnonzero(good)[bad], a] = middle[bad]
        count += int(bad.sum())
    return out, count
