"""When a candidate counts as found: several locks, each of which must open."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from scipy.stats import chi2

from ...model.term import Terms
from ..fit.left_out import gains
from ..fit.noise import NATS
from ..fit.regression import Regression
from ..fit.resampling import null_ratios
from ..fit.single import PiecesByLine
from ..fit.smooth import of_any_form
from .catalogue import Candidate

#: Family-wise levels: the chance that anything of the family passes the first lock on a device
#: with nothing in it.
#: Forms of any channel are many, most of them slow and without physics behind them: they pay more.
LEVEL = {"catalogue": 2.5e-3, "generic": 5e-5, "step": 2e-3}
#: Shares of a family's level that a kind gets where it is not one. What follows time alone is shown
#: worst by any recording, for the noise's walk looks alike: it gets more of what others, found at
#: half its size, can spare (weighted Bonferroni: Genovese, Roeder and Wasserman 2006, Biometrika
#: 93, 509).
WEIGHT = {"time-drift": 6.0, "power-on-transient": 6.0}


@dataclass
class Decision:
    """What the locks said of a candidate."""

    accepted: bool
    p_value: float
    ratio: float
    inflation: float = 1.0
    session_gains: np.ndarray = field(default_factory=lambda: np.zeros(0))
    reason: str = ""

    def on_pieces(
        self, judged: PiecesByLine, straight: Terms, found: Terms, candidate: Terms
    ) -> Decision:
        """The same, unless pieces left out do not speak for the candidate."""
        gain = judged(straight, found, candidate)
        accepted = bool(gain.sum() > NATS)
        reason = "" if accepted else judged.reason
        return replace(self, accepted=accepted, session_gains=gain, reason=reason)


def family_p(ratio: float, dof: int, tried: float) -> float:
    """Chance of a likelihood ratio this large anywhere in a family of `tried` candidates."""
    return float(min(1.0, chi2.sf(ratio, dof) * tried))


def smallest_ratio(family: str, dof: int, tried: float) -> float:
    """The likelihood ratio that a family's level asks for."""
    return float(chi2.isf(LEVEL[family] / tried, dof))


def decide(
    regression: Regression,
    nuisances: Terms,
    candidate: Candidate,
    ratio: float,
    tried: float,
    pool: Terms,
) -> Decision:
    """All locks on a candidate whose ratio beside the nuisances is known.

    pool: terms to make surrogates from. One session alone has no other to predict it.
    """
    dof = 3 * len(candidate.terms)
    level = LEVEL[candidate.family]
    p = family_p(ratio, dof, tried)
    if p > level:
        return Decision(False, p, ratio, reason="not significant")
    # what a curve's few parts leave of it must not pass for noise
    null = null_ratios(regression, nuisances, of_any_form(candidate.terms), pool)
    p, d = min(1.0, null.survival(ratio, len(candidate.terms)) * tried), null.inflation
    if p > level:
        reason = "no better than irrelevant channels on this noise"
        return Decision(False, p, ratio, d, reason=reason)
    if len(regression.sessions) == 1:
        return Decision(True, p, ratio, d)
    gain = gains(regression, nuisances, candidate.terms)
    enough = bool(gain.sum() > NATS)
    reason = "" if enough else "does not predict the sessions left out"
    return Decision(enough, p, ratio, d, gain, reason)


def effective(columns: np.ndarray) -> float:
    """How many independent tests (n, K) columns that are much alike amount to, 1..K.

    By the eigenvalues of their correlations (Galwey 2009, Genetic Epidemiology 33, 559).
    """
    scale = np.linalg.norm(columns, axis=0)
    unit = columns[:, scale > 0] / scale[scale > 0]
    if unit.shape[1] < 2:
        return 1.0
    values = np.clip(np.linalg.eigvalsh(unit.T @ unit), 0.0, None)
    return float(np.sqrt(values).sum() ** 2 / values.sum())
