"""What an effect does to the plain error of sessions left out, deployed as it would be.

Likelihoods look where the noise is small, which for slow noise is at quick changes; a pair of slow
columns that all but cancel may then be huge and opposite. What counts in the end is the error
itself, with the line over temperature as the board learns it.
"""

from collections.abc import Sequence

import numpy as np

from ...model.term import Term
from ..fit.left_out import fitted_without, precision_of
from ..fit.line import ordinary
from ..fit.regression import predicted


def ols_holdout_ratio(
    regression, straight: Sequence[Term], terms: Sequence[Term], candidate: Sequence[Term]
) -> float:
    """RMS error of the sessions, each left out in turn, with a candidate beside the terms over that
    without it; 1 where there are no two sessions.
    """
    if len(regression.sessions) < 2:
        return 1.0
    without = _square(regression, straight, terms)
    beside = _square(regression, straight, [*terms, *candidate], len(candidate))
    return float(np.sqrt(beside / without))


def _square(regression, straight, effects, last=0):
    """Sum over sessions, blocks and axes. last: how many of the effects are the candidate's."""
    every = [*straight, *effects]
    fit = regression.fit(every)
    g = regression.cross_products(every)
    own = slice(len(every) - last, len(every))
    precision = precision_of(regression, g, fit.base, every, own)
    total = 0.0
    for s, session in enumerate(regression.sessions):
        others = [o for i, o in enumerate(regression.sessions) if i != s]
        fitted = _fitted_without(regression, g, fit.base, s, precision)[len(straight) : len(every)]
        model = predicted(effects, fitted, session)
        if straight:
            line = ordinary(straight, others, effects, fitted)
            model += predicted(straight, line, session)
        left = (session.rate_dps - model)[session.available]
        total += float(((left - left.mean(axis=0)) ** 2).sum())
    return total


def _fitted_without(regression, g, base, session, precision):
    """(columns, 3) dps per unit by generalised least squares on the other sessions."""
    turned = [
        fitted_without(g, session, a, colour, regression.scale, precision[a])
        for a, colour in enumerate(base.best)
    ]
    return np.linalg.solve(regression.axes, np.array(turned)).T
