"""What a candidate must reach: each pays for all that are tried beside it."""

from dataclasses import dataclass, field

import numpy as np
from scipy.stats import chi2

from ...model.term import Term
from ..fit.regression import Regression
from . import drift_test
from .catalogue import Candidate
from .decide import LIKELY, WEIGHT, effective, smallest_ratio


@dataclass
class MultipleTesting:
    """Of the candidates of one search.

    straight, bend: the nuisances beside which they are tried; power_ons: whether the sessions are
    several power-ons, at each of which what follows time must come again.
    """

    regression: Regression
    pool: list[Candidate]
    straight: tuple[Term, ...]
    bend: tuple[Term, ...]
    power_ons: bool
    _paid: dict[str, float] = field(default_factory=dict, init=False)

    def tried(self, candidate: Candidate) -> float:
        """Candidates paid for: every kind of a family has its share of the family's level, split
        over as many as the kind's grid amounts to.
        """
        if not self._paid:
            self._paid = {kind: self.grid(kind) for kind in {c.kind for c in self.pool}}
        kinds = {c.kind for c in self.pool if c.family == candidate.family}
        shares = sum(WEIGHT.get(kind, 1.0) for kind in kinds)
        return shares / WEIGHT.get(candidate.kind, 1.0) * self._paid.get(candidate.kind, 1.0)

    def grid(self, kind: str) -> float:
        """As how many a kind's candidates count, beside the line and the bend."""
        like_it = [c.terms for c in self.pool if c.kind == kind]
        if len(like_it) == 1 or len(like_it[0]) > 1:
            return float(len(like_it))
        beside = [*self.straight, *(self.bend if kind != "temperature-quadratic" else ())]
        x = self._stacked([t[0] for t in like_it])
        z = self._stacked(beside)
        return effective(x - z @ np.linalg.lstsq(z, x, rcond=1e-10)[0])

    def _stacked(self, terms: list[Term]) -> np.ndarray:
        r = self.regression
        columns = [
            [r.columns(t)[i] for t in terms] or [np.zeros(len(y))] for i, y in enumerate(r.y)
        ]
        return np.vstack([np.column_stack(of) for of in columns])

    def is_by_time(self, c: Candidate) -> bool:
        """Whether it follows time alone and there are power-ons at which it must come again."""
        return self.power_ons and drift_test.follows_time(c)

    def least_ratio(self, c: Candidate) -> float:
        """The likelihood ratio below which a candidate is not looked at."""
        if self.is_by_time(c):
            return float(chi2.isf(LIKELY, 3))
        return smallest_ratio(c.family, 3 * len(c.terms), self.tried(c))

    def needed(self, c: Candidate) -> float:
        """The likelihood ratio at which one column is found, where the noise is as it seems."""
        if self.is_by_time(c):
            sessions = len(self.regression.sessions)
            return drift_test.smallest_square(self.tried(c), 3, sessions)
        return smallest_ratio(c.family, 3, self.tried(c))
