"""What an effect does to the plain error of sessions left out, deployed as it would be.

Likelihoods look where the noise is small, which for slow noise is at quick changes; a pair of slow
columns that all but cancel may then be huge and opposite. What counts in the end is the error
itself, with the line over temperature as the board learns it.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...model.term import Term
from ..fit.left_out import spread_of
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
    best = np.array([fit.base.coefficients[a, c] for a, c in enumerate(fit.base.best)])
    spread = spread_of(best, slice(len(every) - last, len(every)))
    total = 0.0
    for s, session in enumerate(regression.sessions):
        others = [o for i, o in enumerate(regression.sessions) if i != s]
        fitted = _fitted_without(regression, g, fit, s, spread)[len(straight) : len(every)]
        model = predicted(effects, fitted, session)
        if straight:
            line = ordinary(straight, others, effects, fitted)
            model += predicted(straight, line, session)
        left = (session.rate_dps - model)[session.available]
        total += float(((left - left.mean(axis=0)) ** 2).sum())
    return total


def _fitted_without(regression, g, fit, session, spread):
    """(columns, 3) dps per unit by generalised least squares on the other sessions."""
    others = np.arange(len(g.count)) != session
    turned = []
    for a, colour in enumerate(fit.base.best):
        w = regression.scale[others, a] ** -2.0
        zz = np.tensordot(w, g.zz[others, colour], 1)
        variance = fit.base.rss[a, colour] / g.count.sum()
        zz = zz + np.diag(variance / spread**2)
        zy = w @ g.zy[others, colour, :, a]
        turned.append(np.linalg.lstsq(zz, zy, rcond=1e-12)[0])
    return np.linalg.solve(regression.axes, np.array(turned)).T
