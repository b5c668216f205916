"""Curves as smooth as the recordings say.

By least squares many bends follow the noise. Here a curve is a straight line and a smooth deviation
from it, as a Gaussian process of Matern's covariance (5/2) has it: how large and how long its waves
are, and the colour of the noise, is weighed by what the recordings make of it (restricted
likelihood), and the curve is the mean over all of them, not the likeliest (`fit/shrunk.py`;
Rasmussen and Williams, Gaussian Processes for Machine Learning, 2006, 2.7 and 4.2.1).
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...model.term import Terms
from .likelihood import TINY
from .regression import Regression
from .shrunk import shrink

#: Lengths of the waves, of the range of the curve.
LENGTHS = (0.05, 0.1, 0.2, 0.4, 0.8)


def curve_of(terms: Terms) -> list[int]:
    """Which terms are one slope and its bends, two and more; whoever makes such puts the bends at
    even distances."""
    bent = [i for i, t in enumerate(terms) if t.knot is not None and np.isfinite(t.lo)]
    for first, slope in enumerate(terms):
        own = [i for i in bent if replace(terms[i], knot=None) == slope]
        if len(own) > 1:
            return [first, *own]
    return []


def smooth(regression: Regression, terms: Terms, own: Sequence[int]) -> np.ndarray:
    """(terms, 3) dps per unit, those of a slope and its bends (`curve_of`) by a curve between its
    corners."""
    knots = terms[own[0]].centre + np.array([terms[i].knot for i in own[1:]])
    apart = knots[1] - knots[0]
    corners = np.r_[knots[0] - apart, knots, knots[-1] + apart]
    slopes = np.diff(np.eye(len(corners)), axis=0) / apart
    order = [*(i for i in range(len(terms)) if i not in own), *own]
    some, first = [terms[i] for i in order], len(terms) - len(own)
    out = np.empty((len(terms), 3))
    out[order] = averaged(
        regression, some, first, corners, np.vstack([slopes[:1], np.diff(slopes, axis=0)])
    )
    return out


def averaged(
    regression: Regression,
    terms: Terms,
    first: int,
    at: np.ndarray,
    by: np.ndarray,
    alike: bool = True,
) -> np.ndarray:
    """(terms, A) coefficients; those from the first on are of one curve.

    by: (terms of the curve, points) coefficients of them, for a curve of 1 at one of its points at
    (points,) and 0 at the others; alike: whether its waves are of one size on all axes.
    """
    g, own = regression.cross_products(terms), slice(first + 1, first + 1 + len(at))
    columns = [*terms[:first], *[terms[first]] * (1 + len(at))]
    told, fitted = [], []
    for length in LENGTHS:
        root = by @ np.column_stack([at, np.linalg.cholesky(matern(at, length))])
        said = shrink(g.mapped(first, root), regression.scale, columns, own, alike)
        told.append(said.nats)
        waves = said.coefficients[first : first + root.shape[1]]
        fitted.append(np.vstack([said.coefficients[:first], root @ waves]))
    return by_likelihood(told, fitted)


def by_likelihood(nats: Sequence[float], curves: Sequence[np.ndarray]) -> np.ndarray:
    """The mean of curves of one shape by the likelihood of each."""
    weight = np.exp(np.array(nats) - max(nats))
    return np.tensordot(weight / weight.sum(), curves, 1)


def matern(at: np.ndarray, length: float) -> np.ndarray:
    """(points, points) covariance of waves of a length, with 1 on the diagonal."""
    apart = np.sqrt(5.0) * np.abs(at[:, None] - at) / (length * (at[-1] - at[0]))
    return (1.0 + apart + apart**2 / 3.0) * np.exp(-apart) + TINY * np.eye(len(at))
