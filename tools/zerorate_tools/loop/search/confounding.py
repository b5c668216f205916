"""What may stand in the place of a found effect: the posterior over the groups of candidates."""

from dataclasses import replace

import numpy as np
from scipy.special import logsumexp

from ...model.effects import is_free, of_any_channel
from ..fit.free_curve import parts
from .catalogue import Candidate
from .decide import LEVEL
from .refine import drawn, refined

#: Nats behind the likeliest beyond which a group is not refined: its grid is coarse.
_WORTH_REFINING = 15.0


def posterior(regression, terms, chosen, candidates, ratios) -> list[tuple[Candidate, float]]:
    """Every group that may stand in the chosen one's place, its best candidate refined, and the
    nats of its posterior; the likeliest first.

    A group's likelihood is the mean over its grid, whose best point is refined. Its prior odds are
    the level of its family, and every coefficient costs a nat (Akaike): a group of many fits more.
    ratios: (K,) of the candidates beside the same terms.
    """
    groups: dict[str, list[int]] = {label(chosen): []}
    for i in np.argsort(-ratios):
        groups.setdefault(label(candidates[i]), []).append(int(i))
    least = regression.gains(terms, [chosen.terms]).sum() - 2 * _WORTH_REFINING
    out = []
    for name, grid in groups.items():
        if name == label(chosen):
            best = chosen
        elif ratios[grid[0]] > least:
            best = drawn(regression, terms, refined(regression, terms, candidates[grid[0]]))
        else:
            continue
        top = regression.gains(terms, [best.terms]).sum()
        mean = logsumexp(np.r_[top, ratios[grid[1:]]] / 2) - np.log(max(len(grid), 1))
        out.append((best, float(mean - _coefficients(best) + np.log(LEVEL[best.family]))))
    return sorted(out, key=lambda pair: -pair[1])


def _coefficients(c: Candidate) -> int:
    """Fitted numbers: three a slot, and the form of a curve that was drawn."""
    form = len(parts(c.terms[0])) - 1 if is_free(c.terms[0]) else 0
    return 3 * len(c.terms) + form


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
        kinds = ("cross-axis", "scale-factor+cross-axis", "scale-factor")
        return replace(c, kind=kinds[int(share >= 0.1) + int(share > 0.9)])
    return c
