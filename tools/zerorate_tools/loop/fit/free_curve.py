"""A curve of any form over one source, as smooth as the recordings say.

It is told at the nine points that the board holds (`fit/smooth.py`).
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...model.model import TABLE_POINTS
from ...model.term import Term, Terms
from ..read.sessions import Session, block_basis
from .regression import Regression
from .smooth import LENGTHS, averaged, matern

#: Share of the variance of a curve that the parts by which it is looked for carry.
_MOST = 0.9


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
