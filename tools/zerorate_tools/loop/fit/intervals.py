"""Confidence intervals of an RMS over autocorrelated blocks."""

from collections.abc import Callable

import numpy as np

from .surrogates import COUNT


def block_bootstrap(
    parts: list[np.ndarray], statistic: Callable[[np.ndarray], np.ndarray]
) -> tuple[np.ndarray, np.ndarray]:
    """2.5 % and 97.5 % points of a statistic of (n, ...) rows drawn in runs of sqrt(n) rows
    (Kuensch 1989): how far the noise remembers is not known.

    parts: one array a session, rows in time order, NaN rows dropped; statistic: of the rows drawn.
    """
    rng = np.random.default_rng(0)
    rows = np.vstack([p[np.isfinite(p).all(axis=1)] for p in parts])
    length = round(len(rows) ** 0.5)
    runs = -(-len(rows) // length)
    values = []
    for _ in range(COUNT):
        start = rng.integers(0, len(rows) - length + 1, runs)
        at = (start[:, None] + np.arange(length)).ravel()[: len(rows)]
        values.append(statistic(rows[at]))
    low, high = np.quantile(np.array(values), [0.025, 0.975], axis=0)
    return low, high


def rms(rows: np.ndarray) -> np.ndarray:
    """Root mean square along the first axis."""
    return np.sqrt(np.mean(rows**2, axis=0))
