"""The name of every effect found, and the posterior of what may stand in its place."""

from collections.abc import Callable, Sequence

import numpy as np

from ...model.term import Term
from ..fit.line import is_slope
from ..fit.regression import Regression, predicted
from ..read.earth import ROTATION, can_be_earth
from . import confounding
from .catalogue import Candidate
from .selection import Found

_OF_POSE = ("linear-acceleration", "squared-acceleration")


def name_found(
    regression: Regression,
    straight: Sequence[Term],
    found: list[Found],
    pool: list[Candidate],
    bends: int,
    passes: Callable[[Candidate, Sequence[Term]], bool],
) -> None:
    """Make each effect, in place, the likeliest of the candidates in its place that pass.

    bends: how many at the start stay what they are, with none but the catalogue's beside them;
    passes: whether a candidate may be deployed beside terms.
    """
    for i, f in enumerate(found):
        if any(is_slope(t) for t in f.candidate.terms):
            continue  # beside it there is no line
        others = [t for j, g in enumerate(found) if j != i for t in g.candidate.terms]
        rest = [*straight, *others]
        some = [c for c in pool if c.family == "catalogue"] if i < bends else pool
        ratios = regression.gains(rest, [c.terms for c in some]).sum(axis=1)
        near = confounding.posterior(regression, rest, f.candidate, some, ratios)
        own = f.candidate
        best, nats = next((c, n) for c, n in near if c is own or (i >= bends and passes(c, others)))
        f.candidate = _named(regression, rest, best)
        called, beside = confounding.label(f.candidate), dict(f.rivals)
        for c, n in near:
            beside.setdefault(confounding.label(_named(regression, rest, c)), n - nats)
        f.rivals = {name: n for name, n in beside.items() if name != called}


def _named(regression, rest, candidate):
    fit = regression.fit([*rest, *candidate.terms])
    return confounding.named(candidate, fit.coefficients[len(rest) :])


def name_earth(found: list, terms: list, coefficients: np.ndarray, sessions: list) -> None:
    """Add Earth's rotation to what an effect of acceleration is confounded with, where it can be.

    found: `select.Found`; terms, coefficients (terms, 3) dps per unit: all that is deployed.
    """
    if any(s.earth is None for s in sessions):
        return
    unknown = max(s.earth.unknown_dps for s in sessions)
    for f in found:
        if f.candidate.kind in _OF_POSE:
            rows = np.array([coefficients[terms.index(t)] for t in f.candidate.terms])
            effect = [predicted(f.candidate.terms, rows, s)[s.available] for s in sessions]
            if can_be_earth(np.vstack(effect), unknown):
                f.rivals[ROTATION] = 0.0  # it turns with the pose alike
