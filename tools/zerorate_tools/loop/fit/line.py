"""The straight line over temperature as the firmware's estimators learn it: equal weights, not the
noise's.

The loop's effects are fitted by generalised least squares; what is learned on the board is not, so
before and after are both judged with an ordinary least-squares line on the rates less the effects.
"""

from collections.abc import Callable, Collection, Sequence

import numpy as np

from ...model.term import Term, Terms
from ..read.sessions import Session, block_basis
from .regression import Regression, is_of_force, of_data_sheets, predicted
from .shrunk import shrink
from .smooth import curve_of, smooth

#: Of the squared coefficients of play operators, in units of their columns, per block.
_RIDGE = 5e-5


def is_slope(term: Term) -> bool:
    """Whether a term with limits is the straight line over temperature itself."""
    plain = term.power == 1 and term.memory == "none" and term.lag_mode == "none"
    alone = term.second is None and term.knot is None and not term.delay_s and not term.decay_s
    return term.source == "temp" and np.isfinite(term.lo) and plain and alone


def less_slope(straight: Terms, terms: Terms) -> tuple[Term, ...]:
    """The line that is fitted beside terms: none where one of them is the slope."""
    return () if any(is_slope(t) for t in terms) else tuple(straight)


def ordinary(
    terms: Terms,
    sessions: Sequence[Session],
    effects: Terms = (),
    coefficients: Collection[np.ndarray] = (),
) -> np.ndarray:
    """(terms, 3) dps per unit by least squares over blocks, an offset a session, effects subtracted
    first; play operators, which are much alike, are shrunk a little, acceleration by data sheets as
    if all that is to be explained were noise, and bends made smooth.
    """
    curve = curve_of(terms)
    if curve and not len(effects):
        return smooth(terms, curve, sessions)
    x, y = [], []
    for s in sessions:
        there = s.available
        rate = s.rate_dps - (predicted(effects, coefficients, s) if len(effects) else 0.0)
        columns = np.column_stack([block_basis(t, s) for t in terms])
        x.append(s.less_offsets(columns, there)[there])
        y.append(s.less_offsets(rate, there)[there])
    scale = np.vstack(x).std(axis=0)
    scale[scale == 0] = 1.0  # nothing was seen of it
    rows, known = sum(map(len, x)), of_data_sheets(float(np.vstack(y).var()))
    plays = np.array([t.memory == "play" for t in terms])
    precision = plays * rows * _RIDGE * scale**2 + [known * is_of_force(t) for t in terms]
    if rows and precision.any():
        x.append(np.diag(np.sqrt(precision)))
        y.append(np.zeros((len(terms), 3)))
    return np.linalg.lstsq(np.vstack(x) / scale, np.vstack(y), rcond=1e-12)[0] / scale[:, None]


def shrunk(regression: Regression, terms: Terms) -> np.ndarray:
    """(terms, 3) dps per unit of terms with play operators among them, beside the noise's colour,
    their weights as large as is likely."""
    with regression.in_sensor_axes():
        fitted = shrink(regression.cross_products(terms), regression.scale, terms)
    return fitted.coefficients[: len(terms)]


def by_axis(
    fit: Callable[[list[Term]], np.ndarray], terms: Terms, applied: np.ndarray
) -> np.ndarray:
    """(terms, 3) dps per unit: on every axis those that are applied to it, fitted without others.

    fit: of some terms, their (terms, 3) coefficients; applied: (terms, 3) of zero and one.
    """
    out, uses = np.zeros((len(terms), 3)), np.asarray(applied, bool)
    for pattern in np.unique(uses, axis=1).T:
        own, axes = np.flatnonzero(pattern), (uses == pattern[:, None]).all(axis=0)
        if len(own):
            out[np.ix_(own, axes)] = fit([terms[int(i)] for i in own])[:, axes]
    return out


def with_line(straight: Terms, terms: Terms, applied: np.ndarray) -> np.ndarray:
    """(line and terms, 3) of zero and one: the line is applied where no slope is."""
    slopes = [row for t, row in zip(terms, applied) if is_slope(t)]
    line = np.ones(3) - np.max(slopes, axis=0, initial=0.0)
    return np.vstack([*([line] * len(straight)), applied])
