"""Curvature in temperature from one recording alone.

One course of temperature cannot tell a bent bias from smooth drift; the part's data sheet can:
every bias bends. So here, and only here, no noise steeper than a random walk is allowed, and what
decides is how well pieces of the recording are predicted from the others. Such a bend is never more
than tentative.
"""

from __future__ import annotations

from .catalogue import Candidate
from .decide import LEAST_GAIN, LEVEL, Decision, family_p
from .single import bend_gains

KINDS = ("temperature-quadratic", "temperature-cubic", "temperature-curve", "temperature-kink")
MOST = 3
#: Of likelihood ratio, by which a kink, which has a place to choose, must beat a curve.
_KINK_PAYS = 10.0


def find_bends(regression, folds, straight, pool) -> list[tuple[Candidate, Decision]]:
    """Bends one after another while each predicts the pieces left out. folds: the pieces.

    pool: candidates, of which those of other kinds are passed over.
    """
    bends = with_curve([c for c in pool if c.kind in KINDS])
    found: list[tuple[Candidate, Decision]] = []
    regression.steep = False
    while len(found) < MOST:
        terms = [*straight, *(t for c, _ in found for t in c.terms)]
        left = [c for c in bends if not any(t in terms for t in c.terms)]
        ratios = regression.gains(terms, [c.terms for c in left]).sum(axis=1)
        passing = []
        for candidate, ratio in zip(left, ratios):
            p = family_p(float(ratio), 3 * len(candidate.terms), _tried(candidate, bends))
            if p > LEVEL["catalogue"]:
                continue
            gain = bend_gains(folds, terms, candidate.terms)
            if gain.sum() > LEAST_GAIN and 2 * (gain > 0).sum() > len(gain):
                passing.append((candidate, Decision(True, p, float(ratio), 1.0, gain)))
        if not passing:
            break
        found.append(max(passing, key=_worth))
    regression.steep = True
    return found


def with_curve(bends: list[Candidate]) -> list[Candidate]:
    """With quadratic and cubic as one: either alone may be hidden by the other.

    Beside a quadratic a cubic is the same about any centre: the first stands for all.
    """
    first = {c.kind: c for c in reversed(bends) if c.kind in KINDS[:2]}
    bends = [c for c in bends if first.get(c.kind, c) is c]
    powers = [first[kind].terms[0] for kind in KINDS[:2] if kind in first]
    curve = [Candidate("temperature-curve", tuple(powers), "catalogue")] if len(powers) == 2 else []
    return [*bends, *curve]


def _tried(candidate: Candidate, bends: list[Candidate]) -> int:
    """Every kind of bend has an equal share of the level, split over the kind's grid."""
    kinds = {c.kind for c in bends}
    return len(kinds) * sum(c.kind == candidate.kind for c in bends)


def _worth(passing: tuple[Candidate, Decision]) -> float:
    """Likelihood ratio less twice the parameters (Akaike), a kink paying for its place."""
    candidate, decision = passing
    fine = _KINK_PAYS if candidate.kind == "temperature-kink" else 0.0
    return decision.ratio - 6 * len(candidate.terms) - fine
