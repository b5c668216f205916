"""What competes with a found effect within the noise, and which of the tied ones to name."""

from dataclasses import replace

import numpy as np

from ...model import effects
from ...model.effects import is_free, of_any_channel
from ..fit.free_curve import parts
from ..fit.noise import NATS
from .catalogue import Candidate
from .refine import drawn, refined

_WORTH_REFINING = 15.0


def rivals(regression, terms, chosen, candidates, ratios) -> list[Candidate]:
    """All that fit as well or nearly so in the chosen one's place, refined, the simplest first.

    The first is the one to name: the chosen, or a simpler one that ties with it.

    ratios: (K,) of the candidates beside the same terms.
    """
    best = _worth(regression, terms, chosen)
    tried = {label(chosen): (chosen, best)}
    for i in np.argsort(-ratios):
        c = candidates[i]
        if label(c) in tried or ratios[i] < best - 2 * _WORTH_REFINING:
            continue
        c = drawn(regression, terms, refined(regression, terms, c))
        tried[label(c)] = (c, _worth(regression, terms, c))
    top = max(r for _, r in tried.values())
    near = [c for c, r in tried.values() if r > top - 2 * NATS and c is not chosen]
    tied = tried[label(chosen)][1] > top - 2 * NATS
    simpler = [c for c in near if tied and complexity(c) < complexity(chosen)]
    first = min(simpler, key=complexity, default=chosen)
    rest = [chosen, *near] if first is not chosen else near
    return [first, *(c for c in rest if c is not first)]


def _worth(regression, terms, c: Candidate) -> float:
    """The likelihood ratio, less what a curve that was drawn chose its form by (Akaike)."""
    form = len(parts(c.terms[0])) - 1 if is_free(c.terms[0]) else 0
    return float(regression.gains(terms, [c.terms]).sum()) - 2 * form


def complexity(candidate) -> tuple[int, int]:
    """What a tie is broken by: a catalogue's effect before a form of any channel, these in the
    order of their rows, then fewer free parameters.
    """
    if candidate.family == "catalogue":
        return 0, len(candidate.refine)
    return 1, [row.kind for row in effects.EFFECTS].index(candidate.kind)


def label(candidate) -> str:
    """The kind, with the channels for forms of any channel."""
    if of_any_channel(candidate.kind):
        return f"{candidate.kind}({', '.join(candidate.sources)})"
    return candidate.kind


def named(c: Candidate, coefficients: np.ndarray) -> Candidate:
    """The candidate under the name that its refined parameters and (terms, 3) coefficients deserve.

    Rate and lag of temperature are one basis: below a time constant of 50 s it is called a rate. A
    matrix on the rates is a scale factor where its diagonal holds most of it.
    """
    if c.kind in ("thermal-rate", "thermal-lag"):
        slow = c.terms[0].lag_s > 50.0
        mode, kind = ("difference", "thermal-lag") if slow else ("rate", "thermal-rate")
        return replace(c, kind=kind, terms=(replace(c.terms[0], lag_mode=mode),))
    if c.kind == "rate-scale":
        diagonal = (np.diag(coefficients) ** 2).sum()
        share = diagonal / (coefficients**2).sum()
        kind = (
            "scale-factor"
            if share > 0.9
            else "cross-axis"
            if share < 0.1
            else "scale-factor+cross-axis"
        )
        return replace(c, kind=kind)
    return c
