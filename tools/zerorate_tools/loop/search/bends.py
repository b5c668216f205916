"""Curvature in temperature from one recording alone.

One course of temperature cannot tell a bent bias from smooth drift; the part's data sheet can:
every bias bends. So here, and only here, no noise steeper than a random walk is allowed, and what
decides is how well pieces of the recording are predicted from the others. Such a bend is never more
than tentative.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Protocol

import numpy as np

from ...model.term import Term
from ..fit.single import LEAST_NATS
from .catalogue import Candidate
from .decide import LEVEL, Decision, family_p
from .refine import refined

KINDS = ("temperature-quadratic", "temperature-cubic", "temperature-curve", "temperature-kink")
#: Of likelihood ratio, by which a kink, which has a place to choose, must beat a curve.
_KINK_PAYS = 10.0
#: Nats that pieces left out must gain of what is no bend: not every part has it.
LEAST_OF_OTHERS = 2.0


class JudgedOnPieces(Protocol):
    """What an effect gains on pieces of a recording that are left out; `reason` of a refusal."""

    reason: str

    def __call__(
        self, straight: Sequence[Term], found: Sequence[Term], candidate: Sequence[Term]
    ) -> np.ndarray:
        """(folds,) nats by which each piece is better predicted with the candidate."""


@dataclass
class Bends:
    """The bend found, if any, with what was said of it, and kinds refused with the reason.

    curve: one of two powers, whether or not pieces left out speak for it alone.
    """

    found: list[tuple[Candidate, Decision]] = field(default_factory=list)
    refused: list[tuple[str, str]] = field(default_factory=list)
    curve: tuple[Term, ...] = ()


def find_bends(regression, judged: JudgedOnPieces, straight, pool) -> Bends:
    """The likeliest bend that predicts the pieces left out, if one does.

    pool: candidates, of which those of other kinds are passed over.
    """
    every, bends = with_curve([c for c in pool if c.kind in KINDS]), Bends()
    bends.curve = next((c.terms for c in every if c.kind == "temperature-curve"), ())
    regression.steep = False
    significant = sorted(_significant(regression, straight, every), key=_worth, reverse=True)
    regression.steep = True
    for candidate, decision in significant:
        if candidate.kind == "temperature-kink":
            candidate = refined(regression, straight, candidate)
        said = on_pieces(decision, judged, straight, (), candidate.terms)
        if said.accepted:
            bends.found.append((candidate, said))
            break
        bends.refused.append((candidate.kind, said.reason))
    return bends


def on_pieces(
    decision: Decision,
    judged: JudgedOnPieces,
    straight,
    found,
    candidate,
    least: float = LEAST_NATS,
) -> Decision:
    """A decision for a candidate, unless pieces left out do not speak for it by so many nats."""
    gain = judged(straight, found, candidate)
    accepted = bool(gain.sum() > least)
    reason = "" if accepted else judged.reason
    return replace(decision, accepted=accepted, session_gains=gain, reason=reason)


def _significant(regression, straight, bends) -> list[tuple[Candidate, Decision]]:
    """The likeliest of every kind that passes the first lock."""
    ratios = regression.gains(straight, [c.terms for c in bends]).sum(axis=1)
    best: dict[str, tuple[Candidate, Decision]] = {}
    for candidate, ratio in sorted(zip(bends, ratios), key=lambda pair: -pair[1]):
        p = family_p(float(ratio), 3 * len(candidate.terms), _tried(candidate, bends))
        if p <= LEVEL["catalogue"]:
            decision = Decision(True, p, float(ratio), 1.0, np.array([]))
            best.setdefault(candidate.kind, (candidate, decision))
    return list(best.values())


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
