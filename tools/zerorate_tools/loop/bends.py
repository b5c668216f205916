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

KINDS = ("temperature-quadratic", "temperature-cubic", "temperature-kink")
MOST = 3
#: Nats by which a kink, which has a place to choose, must beat a power of temperature.
_KINK_NATS = 5.0


def find_bends(regression, folds, straight, pool, tried) -> list[tuple[Candidate, Decision]]:
    """Bends one after another while each predicts the pieces left out. folds: the pieces.

    pool: candidates; tried: function of a candidate, how many it pays for.
    """
    found: list[tuple[Candidate, Decision]] = []
    regression.steep = False
    while len(found) < MOST:
        terms = [*straight, *(t for c, _ in found for t in c.terms)]
        bends = [c for c in pool if c.kind in KINDS and c.terms[0] not in terms]
        ratios = regression.gains(terms, [c.terms for c in bends]).sum(axis=1)
        passing = []
        for candidate, ratio in zip(bends, ratios):
            p = family_p(float(ratio), 3, tried(candidate))
            gain = bend_gains(folds, terms, candidate.terms)
            predicts = gain.sum() > LEAST_GAIN and 2 * (gain > 0).sum() > len(gain)
            if p <= LEVEL["catalogue"] and predicts:
                passing.append((candidate, Decision(True, p, float(ratio), 1.0, gain)))
        if not passing:
            break
        found.append(max(passing, key=_worth))
    regression.steep = True
    return found


def _worth(passing: tuple[Candidate, Decision]) -> float:
    candidate, decision = passing
    fine = _KINK_NATS if candidate.kind == "temperature-kink" else 0.0
    return float(decision.session_gains.sum()) - fine
