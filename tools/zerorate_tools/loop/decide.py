"""When a candidate counts as found: several locks, each of which must open."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from .left_out import gains
from .surrogates import null_ratios

#: Family-wise levels: the chance that anything of the family passes the first lock on a device
#: with nothing in it.
#: Forms of any channel are many, most of them slow and without physics behind them: they pay more.
LEVEL = {"catalogue": 2.5e-3, "generic": 5e-5, "step": 5e-4}
#: Nats that left-out sessions must gain in all.
LEAST_GAIN = 3.0


@dataclass
class Decision:
    """What the locks said of a candidate."""

    accepted: bool
    p_value: float
    ratio: float
    inflation: float
    session_gains: np.ndarray
    reason: str = ""


def family_p(ratio: float, dof: int, tried: int) -> float:
    """Chance of a likelihood ratio this large anywhere in a family of `tried` candidates."""
    return float(min(1.0, chi2.sf(ratio, dof) * tried))


def smallest_ratio(family: str, dof: int, tried: int) -> float:
    """The likelihood ratio that a family's level asks for."""
    return float(chi2.isf(LEVEL[family] / tried, dof))


def decide(regression, folds, nuisances, candidate, ratio: float, tried: int, pool) -> Decision:
    """All locks on a candidate whose ratio beside the nuisances is known.

    folds: regression whose sessions are left out in turn; pool: terms to make surrogates from.
    """
    dof = 3 * len(candidate.terms)
    level = LEVEL[candidate.family]
    p = family_p(ratio, dof, tried)
    if p > level:
        return Decision(False, p, ratio, 1.0, np.array([]), "not significant")
    null = null_ratios(regression, nuisances, candidate.terms, pool)
    p, d = min(1.0, null.survival(ratio, len(candidate.terms)) * tried), null.inflation
    if p > level:
        return Decision(
            False, p, ratio, d, np.array([]), "no better than irrelevant channels on this noise"
        )
    gain = gains(folds, nuisances, candidate.terms)
    enough = gain.sum() > LEAST_GAIN and (gain > 0).sum() >= max(1, len(gain) - len(gain) // 4)
    reason = "" if enough else "does not predict the sessions left out"
    return Decision(bool(enough), p, ratio, d, gain, reason)
