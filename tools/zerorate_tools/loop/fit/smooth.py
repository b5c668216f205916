"""Curves as smooth as the recordings say.

By least squares many bends follow the noise. Here a curve is a straight line and a smooth deviation
from it, as a Gaussian process of Matern's covariance (5/2) has it: how large and how long its waves
are, and the colour of the noise, is weighed by what the recordings make of it (restricted
likelihood), and the curve is the mean over all of them, not the likeliest (`fit/shrunk.py`;
Rasmussen and Williams, Gaussian Processes for Machine Learning, 2006, 2.7 and 4.2.1).
A curve of any form over one source has the nine points that the board holds.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...model.model import TABLE_POINTS
from ...model.term import Term, Terms
from ..read.sessions import Session, block_basis
from .likelihood import TINY
from .regression import Regression
from .shrunk import shrink

#: Lengths of the waves, of the range of the curve.
LENGTHS = (0.05, 0.1, 0.2, 0.4, 0.8)
#: Share of the variance of a curve that the parts by which it is looked for carry.
_MOST = 0.9


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


def parts(term: Term) -> tuple[Term, ...]:
    """The term with one of several curves, each in turn: coefficients that are alike in size and
    independent make of them the line and the waves of every length. Those that carry most of the
    variance alone: chance pays for each. None adds an offset."""
    at = np.linspace(-1.0, 1.0, TABLE_POINTS)
    centred = np.eye(TABLE_POINTS) - 1.0 / TABLE_POINTS
    waves = np.mean([matern(at, length) for length in LENGTHS], axis=0)
    variance, forms = np.linalg.eigh(centred @ (np.outer(at, at) + waves) @ centred)
    least = np.searchsorted(np.cumsum(variance), (1.0 - _MOST) * variance.sum())
    tables = (forms * np.sqrt(np.maximum(variance, 0.0))).T[least:]
    return tuple(replace(term, table=tuple(table.tolist())) for table in tables)


def of_any_form(terms: Terms) -> Terms:
    """Terms by which a curve is looked for, as those of any form at the points of the board."""
    if not is_curve(terms):
        return terms
    forms = np.eye(TABLE_POINTS)[1:]
    return tuple(replace(terms[0], table=tuple(form.tolist())) for form in forms)


def is_curve(terms: Terms) -> bool:
    """Whether terms are the parts of one curve that is still to be told."""
    return len(terms) > 1 and all(t.table for t in terms)


def draw(regression: Regression, beside: Terms, term: Term) -> tuple[Term, float]:
    """The term with the curve that the recordings tell beside other terms, in one form for all
    axes; and the share of the squares that is lost where these follow curves of different forms."""
    each = [replace(term, table=tuple(point.tolist())) for point in np.eye(TABLE_POINTS)]
    with regression.in_sensor_axes():
        every, at = [*beside, *each], np.linspace(-1.0, 1.0, TABLE_POINTS)
        fitted = averaged(regression, every, len(beside), at, np.eye(TABLE_POINTS), alike=False)
    values = fitted[len(beside) :]
    squares, axes = np.linalg.eigh(values.T @ _products(each, regression.sessions) @ values)
    form = values @ axes[:, -1]
    least, most = form.min(), form.max()
    if not most > least:
        return term, 0.0
    table = np.clip((2 * form - least - most) / (most - least), -1, 1)
    return replace(term, table=tuple(table.tolist())), float(squares[:-1].sum() / squares.sum())


def _products(each: Terms, sessions: Sequence[Session]) -> np.ndarray:
    """(points, points) of what 1 at each point adds to the blocks, offsets aside."""
    rows = [np.column_stack([block_basis(t, s) for t in each]) for s in sessions]
    added = np.vstack([s.less_offsets(r, s.available)[s.available] for r, s in zip(rows, sessions)])
    return added.T @ added
