"""The name of every effect found, and the posterior of what may stand in its place."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from scipy.special import logsumexp

from ...model.effects import is_free
from ...model.term import Term, Terms
from ..fit.line import is_slope
from ..fit.regression import Regression
from ..fit.smooth import parts
from ..read.earth import ROTATION, can_be_earth
from ..read.sessions import block_basis
from .catalogue import Candidate
from .decide import LEVEL
from .refine import drawn, refined
from .selection import Found

#: Nats behind the likeliest beyond which a group is not refined: its grid is coarse.
_WORTH_REFINING = 15.0
_OF_POSE = ("linear-acceleration", "squared-acceleration")


def name_found(
    regression: Regression,
    straight: Terms,
    found: list[Found],
    pool: list[Candidate],
    bends: int,
    passes: Callable[[Candidate, Terms], bool],
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
        near = posterior(regression, rest, f.candidate, some, ratios)
        own = f.candidate
        best, nats = next((c, n) for c, n in near if c is own or (i >= bends and passes(c, others)))
        f.candidate = _named(regression, rest, best)
        called, beside = f.candidate.label, dict(f.rivals)
        for c, n in near:
            beside.setdefault(_named(regression, rest, c).label, n - nats)
        f.rivals = {name: n for name, n in beside.items() if name != called}


def _named(regression: Regression, rest: Terms, candidate: Candidate) -> Candidate:
    fit = regression.fit([*rest, *candidate.terms])
    return named(candidate, fit.coefficients[len(rest) :])


def name_earth(
    found: list[Found], terms: list[Term], coefficients: np.ndarray, regression: Regression
) -> None:
    """Add Earth's rotation to what an effect of acceleration is confounded with, where it can be.

    terms, coefficients (terms, 3) dps per unit: all that is deployed of what was fitted.
    """
    sessions = regression.sessions
    of_pose = [f for f in found if f.candidate.kind in _OF_POSE]
    unknown = [s.earth.unknown_dps for s in sessions if s.earth is not None]
    if not of_pose or len(unknown) < len(sessions):
        return
    with regression.in_sensor_axes():
        base = regression.fit(terms).base
    for f in of_pose:
        at = [terms.index(t) for t in f.candidate.terms]
        covariance = base.variance[:, None, None] * base.unscaled[:, at][..., at]
        poses = [
            np.column_stack([block_basis(t, s)[s.available] for t in f.candidate.terms])
            for s in sessions
        ]
        if can_be_earth(np.vstack(poses), coefficients[at], covariance, max(unknown)):
            f.rivals[ROTATION] = 0.0  # it turns with the pose alike


def posterior(
    regression: Regression,
    terms: Terms,
    chosen: Candidate,
    candidates: Sequence[Candidate],
    ratios: np.ndarray,
) -> list[tuple[Candidate, float]]:
    """Every group that may stand in the chosen one's place, its best candidate refined, and the
    nats of its posterior; the likeliest first.

    A group's likelihood is the mean over its grid, whose best point is refined. Its prior odds are
    the level of its family, and every coefficient costs a nat (Akaike): a group of many fits more.
    ratios: (K,) of the candidates beside the same terms.
    """
    groups: dict[str, list[int]] = {chosen.label: []}
    for i in np.argsort(-ratios):
        groups.setdefault(candidates[i].label, []).append(int(i))
    least = regression.gains(terms, [chosen.terms]).sum() - 2 * _WORTH_REFINING
    out = []
    for name, grid in groups.items():
        if name == chosen.label:
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
