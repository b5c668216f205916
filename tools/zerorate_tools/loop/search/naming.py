"""The name of every effect found, and of what ties with it."""

from collections.abc import Sequence

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
) -> None:
    """Give each effect, in place, the simplest of the candidates that tie with it.

    bends: how many at the start stay what they are, with none but the catalogue's beside them.
    """
    for i, f in enumerate(found):
        if any(is_slope(t) for t in f.candidate.terms):
            continue  # beside it there is no line
        others = [t for j, g in enumerate(found) if j != i for t in g.candidate.terms]
        rest = [*straight, *others]
        near = _near(regression, rest, f.candidate, pool)
        if i < bends:
            beside = [c for c in near if c is not f.candidate and c.family == "catalogue"]
            near = [f.candidate, *beside]
        f.candidate = _named(regression, rest, near[0])
        names = [confounding.label(_named(regression, rest, c)) for c in near[1:]]
        names = [*f.confounded_with, *names]
        own = confounding.label(f.candidate)
        f.confounded_with = [n for n in dict.fromkeys(names) if n != own]


def _near(regression, rest, chosen, pool):
    ratios = regression.gains(rest, [c.terms for c in pool]).sum(axis=1)
    return confounding.rivals(regression, rest, chosen, pool, ratios)


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
                f.confounded_with.append(ROTATION)
