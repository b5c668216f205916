"""Chance by resampling: what irrelevant channels score on this noise, and intervals of an RMS.

A surrogate keeps the spectrum of some candidate's column in every session and loses its phase: its
DCT coefficients are multiplied by random numbers. Surrogates are scored on what the candidate under
test leaves, so a true effect does not raise them. On quiet real recordings, and wherever few slow
coefficients decide, such ratios are above theory and have longer tails: a gamma distribution of
their mean and variance takes the place of chi- squared.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.stats import gamma

from ...model.term import Terms
from .cross_products import cross_products
from .likelihood import fit_base, ratios
from .regression import Regression

#: So many that mean and variance, and with them the decision, hardly hang on the draw: 2 and 6 %.
COUNT = 1500


@dataclass(frozen=True)
class NullRatios:
    """Mean and variance of the ratios of irrelevant single-column candidates, never below chi-
    squared's.
    """

    mean: float
    variance: float
    dof: int

    @classmethod
    def of(cls, mean: float, variance: float, dof: int) -> NullRatios:
        """By those of some ratios of which none is of a true effect."""
        mean = max(mean, dof)
        return cls(mean, max(variance, 2 * mean**2 / dof), dof)

    @property
    def inflation(self) -> float:
        """>= 1: the mean beside chi-squared's."""
        return self.mean / self.dof

    def survival(self, ratio: float, columns: int = 1) -> float:
        """Chance that an irrelevant candidate of so many columns reaches a ratio."""
        scale = self.variance / self.mean
        return float(gamma.sf(ratio, columns * self.mean / scale, scale=scale))


def null_ratios(regression: Regression, terms: Terms, candidate: Terms, pool: Terms) -> NullRatios:
    """Ratios that surrogates reach on what a candidate leaves. pool: terms to make them from."""
    rng = np.random.default_rng(0)
    every = [*terms, *candidate]
    z, left = regression.stack(every), regression.left(every, regression.fit(every))
    pick = [pool[i] for i in rng.integers(0, len(pool), COUNT)]
    x = [np.column_stack([regression.columns(t)[i] for t in pick]) for i in range(len(z))]
    x = [c * rng.normal(size=c.shape) for c in x]
    g = cross_products(regression.whiteners, left, z, x)
    base = fit_base(g, regression.scale)
    found = ratios(g, base, regression.scale).sum(axis=1)
    return NullRatios.of(float(found.mean()), float(found.var()), regression.y[0].shape[1])


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
