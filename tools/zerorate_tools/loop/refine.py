"""The parameters of a candidate between the points of its grid."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.optimize import minimize_scalar

from .catalogue import REFINED, Candidate

_ROUNDS = 2


def refined(regression, terms, candidate: Candidate) -> Candidate:
    """The candidate with its lag, width, knot or centre where the likelihood is highest."""
    for _ in range(_ROUNDS if len(candidate.refine) > 1 else 1):
        for name in candidate.refine:
            candidate = _along(regression, terms, candidate, name)
    return candidate


def _along(regression, terms, candidate, name):
    term = candidate.terms[0]
    at = getattr(term, name)
    low, high, to, back = _interval(term, name, at)

    def worse(x):
        trial = replace(term, **{name: float(back(x))})
        gain = regression.gains(terms, [(trial,)]).sum()
        regression.forget(trial)
        return -gain

    found = minimize_scalar(
        worse, bounds=(to(low), to(high)), method="bounded", options={"xatol": 0.02, "maxiter": 14}
    )
    if found.fun > worse(to(at)):
        return candidate
    return replace(candidate, terms=(replace(term, **{name: float(back(found.x))}),))


def _interval(term, name, at):
    limits = REFINED[name]
    if limits:
        return max(at / 2.2, limits[0]), min(at * 2.2, limits[1]), np.log, np.exp
    span = term.hi - term.lo
    unit = span or 1.0
    return at - 0.2 * span, at + 0.2 * span, (lambda v: v / unit), (lambda v: v * unit)
