"""The name of every effect found, and of what ties with it."""

from __future__ import annotations

from collections.abc import Sequence

from . import confounding
from .alike import all_but_same
from .basis import Term
from .catalogue import Candidate
from .regression import Regression
from .selection import Found


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
        others = [t for j, g in enumerate(found) if j != i for t in g.candidate.terms]
        rest = [*straight, *others]
        near = _near(regression, rest, f.candidate, pool)
        if i < bends:
            beside = [c for c in near if c is not f.candidate and c.family == "catalogue"]
            near = [f.candidate, *beside]
        f.candidate = _named(regression, rest, near[0])
        names = [confounding.label(_named(regression, rest, c)) for c in near[1:]]
        own = confounding.label(f.candidate)
        f.confounded_with = [n for n in dict.fromkeys(names) if n != own]


def _near(regression, rest, chosen, pool):
    ratios = regression.gains(rest, [c.terms for c in pool]).sum(axis=1)
    near = confounding.rivals(regression, rest, chosen, pool, ratios)
    sessions = regression.sessions
    return [c for c in near if c is chosen or not all_but_same(c.terms, rest, sessions)]


def _named(regression, rest, candidate):
    fit = regression.fit([*rest, *candidate.terms])
    return confounding.named(candidate, fit.coefficients[len(rest) :])
