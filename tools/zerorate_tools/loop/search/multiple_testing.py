"""What a candidate must reach: each pays for all that are tried beside it. And the smallest effect
of each kind that would have reached it.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.stats import norm

from ...model.term import Term, Terms
from ..fit.cross_products import CrossProducts
from ..fit.likelihood import LEAST_OWN, Base
from ..fit.regression import Regression
from ..read.sessions import Session, block_basis
from .catalogue import Candidate
from .decide import WEIGHT, effective, smallest_ratio

_POWER = 0.9


@dataclass
class MultipleTesting:
    """Of the candidates of one search.

    straight, bend: the nuisances beside which they are tried.
    """

    regression: Regression
    pool: list[Candidate]
    straight: tuple[Term, ...]
    bend: tuple[Term, ...]
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

    def least_ratio(self, c: Candidate) -> float:
        """The likelihood ratio below which a candidate is not looked at."""
        return smallest_ratio(c.family, 3 * len(c.terms), self.tried(c))

    def needed(self, c: Candidate) -> float:
        """The likelihood ratio at which one column is found, where the noise is as it seems."""
        return smallest_ratio(c.family, 3, self.tried(c))


def smallest_dps(
    regression: Regression,
    nuisances: Terms,
    pool: Sequence[Candidate],
    needed: Callable[[Candidate], float],
) -> dict[str, float]:
    """Kind -> RMS in dps over the blocks, equal on the three axes, that would be found nine times
    in ten.

    needed: function of a candidate, the likelihood ratio that it needs. What offset, straight line
    and bend take is not counted. The best of a kind's grid is named. Kinds that the sessions cannot
    show are absent.
    """
    single = [c for c in pool if len(c.terms) == 1]
    if not single:
        return {}
    g = regression.cross_products(nuisances, [c.terms for c in single])
    base = regression.fit(nuisances).base
    information = _information(g, base, regression.scale)
    out: dict[str, float] = {}
    for c, info in zip(single, information):
        if info <= 0:
            continue
        need = (np.sqrt(needed(c)) + norm.ppf(_POWER)) ** 2
        size = np.sqrt(need / info) * _own_rms(c.terms[0], nuisances, regression.sessions)
        out[c.kind] = min(out.get(c.kind, np.inf), float(size))
    return out


def _information(g: CrossProducts, base: Base, scale: np.ndarray) -> np.ndarray:
    """(K,) sum over axes of what a unit coefficient adds to the likelihood ratio, at the fitted
    noise.
    """
    total = np.zeros(g.xx.shape[2])
    for a, i in enumerate(base.best):
        w = scale[:, a] ** -2.0
        xz, xx = np.tensordot(w, g.xz[:, i].squeeze(2), 1), w @ g.xx[:, i].squeeze((2, 3))
        left = xx - np.einsum("ki,ij,kj->k", xz, base.inverse[a][i], xz)
        total += np.where(left > LEAST_OWN * xx, left, 0.0) / base.variance[a]
    return total


def _own_rms(term: Term, nuisances: Terms, sessions: Sequence[Session]) -> float:
    """RMS over the blocks of what offsets and nuisances cannot take of a term."""
    stacks = [
        np.column_stack([block_basis(t, s)[s.available] for t in [term, *nuisances]])
        for s in sessions
    ]
    whole = np.vstack([m - m.mean(axis=0) for m in stacks])
    scale = whole.std(axis=0)
    whole = whole / np.where(scale > 0, scale, 1.0)
    left = whole[:, 0] - whole[:, 1:] @ np.linalg.lstsq(whole[:, 1:], whole[:, 0], rcond=1e-10)[0]
    return float(left.std() * scale[0])
