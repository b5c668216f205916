"""Is what follows time since power-on alone more than the noise's own walk?

Over one power-on a slow walk looks like a drift, and a noise's colour that is free for every axis
can stand for any. Two questions that hardly depend on each other tell them apart: whether the drift
is more than a noise that is alike on the three axes makes, and whether it comes again at every
power-on. Both chances are taken together (R. A. Fisher, Statistical Methods for Research Workers,
4th edition 1932, paragraph 21.1).
"""

import numpy as np
from scipy.optimize import brentq
from scipy.stats import chi2, f

from ...model.term import Terms
from ..fit.common_cause import RARE
from ..fit.cross_products import CrossProducts
from ..fit.left_out import gains
from ..fit.regression import Regression
from .catalogue import Candidate
from .decide import Decision

#: By how much the lowest frequencies' share of the noise differs between the axes of one part: the
#: scale of Student's t, in nats of variance.
_SPREAD = 0.7
#: Its degrees of freedom; and as many slopes as the noise's colour, known from all other
#: frequencies, is worth beside the slopes themselves: moderated variance (Smyth 2004, Stat. Appl.
#: Genet. Mol. Biol. 3, 3).
_DOF = 4
_LOWEST = 2


def follows_time(candidate: Candidate) -> bool:
    """Whether a candidate needs no channel but the clock."""
    return all(t.source in ("one", "time") and not t.second for t in candidate.terms)


def considered(
    regression: Regression, terms: Terms, candidate: Candidate, ratio: float, tried: float
) -> Decision:
    """What both questions say of a candidate of one term beside the terms. ratio: its likelihood
    ratio; tried: candidates paid for.
    """
    p = min(1.0, chance(regression, terms, candidate.terms) * tried)
    gain = gains(regression, terms, candidate.terms)
    reason = "no more than the noise's own walk, power-on by power-on" if p > RARE else ""
    return Decision(not reason, p, ratio, 1.0, gain, reason, tried)


def comes_again(whole: Regression, terms: Terms, candidate: Candidate, tried: float) -> bool:
    """Whether it is there by all power-ons together, those held out among them (`whole`).

    Noise steeper than a random walk drifts alike at three power-ons by chance, and hardly at four:
    they must pass the level of the fitted ones squared.
    """
    return chance(whole, terms, candidate.terms) * tried <= RARE**2


def chance(regression: Regression, terms: Terms, candidate: Terms) -> float:
    """That noise alone answers both questions as well, for one candidate."""
    axes = regression.y[0].shape[1]
    of_size = chi2.sf(ratio_with_common_colour(regression, terms, candidate), axes)
    mean, spread = repeats(regression, terms, candidate)
    free = axes * (len(regression.sessions) - 1)
    between = (spread + _DOF) / (free + _DOF)
    return together(of_size, f.sf(mean / axes / between, axes, free + _DOF))


def together(*chances: float) -> float:
    """One chance for several that do not depend on each other (Fisher)."""
    return float(chi2.sf(-2.0 * np.log(np.maximum(chances, 1e-300)).sum(), 2 * len(chances)))


def ratio_with_common_colour(regression: Regression, terms: Terms, candidate: Terms) -> float:
    """Likelihood ratio of a candidate with noises that are alike on the three axes."""
    longest = max(regression.whiteners, key=lambda w: w.coefficients)
    low = lowness(longest.spectrum)
    with_it = common_colour(regression.fit([*terms, *candidate]).base.loglik, low)
    return max(0.0, 2.0 * (with_it - common_colour(regression.fit(terms).base.loglik, low)))


def lowness(spectrum: np.ndarray) -> np.ndarray:
    """(G,) nats by which the lowest frequencies of (G, N) spectra stand above their mean."""
    log = np.log(spectrum)
    return log[:, :_LOWEST].mean(axis=1) - log.mean(axis=1)


def common_colour(loglik: np.ndarray, low: np.ndarray) -> float:
    """Log likelihood of all axes at the best colours, one lowness common to them but for their
    spread. loglik: (A, G); low: (G,).
    """
    common = np.linspace(low.min(), low.max(), 31)
    off = (low[None] - common[:, None]) / _SPREAD
    penalty = 0.5 * (_DOF + 1) * np.log1p(off**2 / _DOF)
    return float((loglik[:, None, :] - penalty).max(axis=2).sum(axis=0).max())


def repeats(regression: Regression, terms: Terms, candidate: Terms) -> tuple[float, float]:
    """Squares of a term's mean coefficient and of the power-ons' deviations from it, each in its
    own variance by the fitted noise, summed over the axes: chi-squared of A and A (S - 1) degrees
    of freedom where there is nothing but that noise.
    """
    g = regression.cross_products(terms, [candidate])
    base = regression.fit([*terms, *candidate]).base
    mean = spread = 0.0
    for a, colour in enumerate(base.best):
        along, size = _by_session(g, colour, a, regression.scale[:, a] ** -2.0)
        variance = base.variance[a]
        common = along.sum() / max(size.sum(), 1e-300)
        each = along - common * size
        mean += common**2 * size.sum() / variance
        spread += float((each**2 / np.maximum(size, 1e-12 * size.sum())).sum()) / variance
    return float(mean), spread


def _by_session(
    g: CrossProducts, colour: int, a: int, weight: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """(S,) products of what the nuisances leave of a column with what they leave of the residual,
    and with itself."""
    xx, xy = g.xx[:, colour].squeeze((1, 2, 3)), g.xy[:, colour, ..., a].squeeze((1, 2))
    xz, zy, zz = g.xz[:, colour].squeeze((1, 2)), g.zy[:, colour, :, a], g.zz[:, colour]
    inverse = np.linalg.pinv(np.tensordot(weight, zz, 1))
    of_x, of_y = inverse @ (weight @ xz), inverse @ (weight @ zy)
    along = xy - xz @ of_y - zy @ of_x + (zz @ of_y) @ of_x
    return weight * along, weight * (xx - 2 * xz @ of_x + (zz @ of_x) @ of_x)


def smallest_square(tried: float, axes: int, sessions: int) -> float:
    """Square of the mean of so many sessions in its own variance that passes by them, and with one
    more, where the power-ons' spread is noise."""
    alone = _square(RARE / tried, axes, sessions)
    held_out = _square(RARE**2 / tried, axes, sessions + 1)
    return max(alone, held_out * sessions / (sessions + 1))


def _square(level: float, axes: int, sessions: int) -> float:
    free = axes * (sessions - 1) + _DOF

    def excess(square: float) -> float:
        chances = chi2.sf(square, axes), f.sf(square / axes, axes, free)
        return np.log(together(*chances) / level)

    return float(brentq(excess, 1.0, 500.0))
