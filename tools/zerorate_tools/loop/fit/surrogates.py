"""What irrelevant channels score on this device's own noise.

A surrogate keeps the spectrum of some candidate's column in every session and loses its phase: its
DCT coefficients are multiplied by random numbers. Surrogates are scored on what the candidate under
test leaves, so a true effect does not raise them. On quiet real recordings, and wherever few slow
coefficients decide, such ratios are above theory and have longer tails: a gamma distribution of
their mean and variance takes the place of chi- squared.
"""

from __future__ import annotations

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
