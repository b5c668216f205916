"""The straight line over temperature as the firmware's estimators learn it: equal weights, not the
noise's.

The loop's effects are fitted by generalised least squares; what is learned on the board is not, so
before and after are both judged with an ordinary least-squares line on the rates less the effects.
"""

from collections.abc import Callable, Collection, Sequence
from dataclasses import replace

import numpy as np

from ...model.term import Term, Terms
from ..read.sessions import Session
from .regression import Regression, predicted
from .shrunk import has_play_operators, shrink
from .smooth import curve_of, smooth


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
    first. Play operators and bends are as large as is likely, acceleration as data sheets have it
    if all that is to be explained were noise.
    """
    if len(effects):
        sessions = [
            replace(s, rate_dps=s.rate_dps - predicted(effects, coefficients, s)) for s in sessions
        ]
    shown = [s for s in sessions if s.available.any()]
    if not shown:
        return np.zeros((len(terms), 3))
    regression, curve = Regression(shown, white=True), curve_of(terms)
    regression.heed_data_sheets(())
    if curve and not len(effects):
        return smooth(regression, terms, curve)
    if has_play_operators(terms):
        return shrunk(regression, terms)
    return regression.fit(terms).coefficients


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
