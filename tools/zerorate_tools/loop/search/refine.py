"""The parameters of a candidate between the points of its grid."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.optimize import minimize_scalar

from ...model.effects import DELAY_STEP_S, is_free
from ...model.term import Term, Terms
from ..fit.regression import Regression
from ..fit.smooth import draw
from .catalogue import MARGIN, REFINED, Candidate

_Scale = Callable[[float], float]


def drawn(regression: Regression, beside: Terms, candidate: Candidate) -> Candidate:
    """The candidate, with its curve told by the recordings where any curve will do."""
    first = candidate.terms[0]
    if not (candidate.is_free or len(candidate.terms) == 1 and is_free(first)):
        return candidate
    return replace(candidate, terms=(draw(regression, beside, first)[0],))


def refined(regression: Regression, terms: Terms, candidate: Candidate) -> Candidate:
    """The candidate with its lag, width, knot or centre where the likelihood is highest."""
    for name in candidate.refine:
        candidate = _along(regression, terms, candidate, name)
    return candidate


def _along(regression: Regression, terms: Terms, candidate: Candidate, name: str) -> Candidate:
    term = candidate.terms[0]
    at = getattr(term, name)

    def moved(value: float) -> tuple[Term, ...]:
        change: dict[str, Any] = {name: float(value)}
        return tuple(replace(t, **change) for t in candidate.terms)

    def worse(value: float) -> float:
        trial = moved(value)
        gain = regression.gains(terms, [trial]).sum()
        for t in trial:
            regression.forget(t)
        return -gain

    best, least = at, worse(at)
    for low, high, to, back in _intervals(term, name, at):
        found = minimize_scalar(
            lambda x, back=back: worse(back(x)),
            bounds=(to(low), to(high)),
            method="bounded",
            options={"xatol": 0.02, "maxiter": 14},
        )
        if found.fun <= least:
            best, least = float(back(found.x)), found.fun
    return replace(candidate, terms=moved(best))


def _intervals(term: Term, name: str, at: float) -> Iterator[tuple[float, float, _Scale, _Scale]]:
    """Where to look, and the scale on which to: a delay also between its neighbours on the grid,
    for a channel that leaps shows it there alone.
    """
    limits = REFINED[name]
    if limits:
        yield max(at / 2.2, limits[0]), min(at * 2.2, limits[1]), np.log, np.exp
    else:
        span = term.second_hi - term.second_lo if name == "second_centre" else term.hi - term.lo
        seen = span / (1.0 + 2.0 * MARGIN)
        unit = seen or 1.0
        yield at - 0.2 * seen, at + 0.2 * seen, (lambda v: v / unit), (lambda v: v * unit)
    if name == "delay_s":
        step = DELAY_STEP_S
        yield max(at - step, 1.0), at + step, (lambda v: v / step), (lambda v: v * step)
