"""Generalised least squares over three axes with the noise's colour refitted for every candidate.

The variance is profiled out, the colour is the best of the grid, each axis has its own of both.
"""

from dataclasses import dataclass

import numpy as np

from .cross_products import CrossProducts
from .noise import LOG_PRIOR

#: Of a diagonal, so that columns all but alike have an inverse.
TINY = 1e-10
#: Share of a column's squares that nuisances must leave.
LEAST_OWN = 1e-6


def _inverse(zz: np.ndarray) -> np.ndarray:
    """(A, G, J, J) inverses of scaled cross products, safe against a column of nothing."""
    d = np.sqrt(np.einsum("agjj->agj", zz))
    d = np.where(d > 0, d, 1.0)
    square = d[..., :, None] * d[..., None, :]
    return np.linalg.inv(zz / square + TINY * np.eye(zz.shape[-1])) / square


@dataclass
class Base:
    """The fit without candidates. rss: (A, G); loglik: (A, G); coefficients: (A, G, J); inverse:
    (A, G, J, J); count: of all values fitted on an axis.
    """

    rss: np.ndarray
    loglik: np.ndarray
    coefficients: np.ndarray
    inverse: np.ndarray
    count: int

    @property
    def best(self) -> np.ndarray:
        """(A,) index of the best colour."""
        return self.loglik.argmax(axis=1)

    @property
    def fitted(self) -> np.ndarray:
        """(A, J) coefficients at the best colour."""
        return np.array([c[g] for c, g in zip(self.coefficients, self.best)])

    @property
    def variance(self) -> np.ndarray:
        """(A,) of the white part of the noise at the best colour."""
        return np.array([r[g] for r, g in zip(self.rss, self.best)]) / self.count

    @property
    def unscaled(self) -> np.ndarray:
        """(A, J, J) covariance of the coefficients at the best colour, over that variance."""
        return np.array([i[g] for i, g in zip(self.inverse, self.best)])

    @property
    def total(self) -> float:
        """Log likelihood at the best colours."""
        return float(self.loglik.max(axis=1).sum())


def _loglik(rss: np.ndarray, logdet: np.ndarray, count: int, scale_term: float) -> np.ndarray:
    prior = LOG_PRIOR[: len(rss)].reshape(-1, *[1] * (rss.ndim - 1))
    return prior - 0.5 * count * np.log(np.maximum(rss, 1e-300) / count) - 0.5 * logdet - scale_term


def fit_base(g: CrossProducts, scale: np.ndarray) -> Base:
    """Fit of the nuisances. scale: (S, A) noise of each session."""
    count, logdet, weights = g.count.sum(), g.logdet.sum(axis=0), 1.0 / scale.T**2
    inverse = _inverse(np.array([np.tensordot(w, g.zz, 1) for w in weights]))
    zy = np.array([np.tensordot(w, g.zy[..., a], 1) for a, w in enumerate(weights)])
    b = np.einsum("agij,agj->agi", inverse, zy)
    yy = np.array([w @ g.yy[..., a] for a, w in enumerate(weights)])
    rss = yy - np.einsum("agi,agi->ag", b, zy)
    scaled = (g.count[:, None] * np.log(scale)).sum(axis=0)
    ll = [_loglik(r, logdet, count, s) for r, s in zip(rss, scaled)]
    return Base(rss, np.array(ll), b, inverse, count)


def ratios(g: CrossProducts, base: Base, scale: np.ndarray) -> np.ndarray:
    """(K, A) twice the gain in log likelihood of each candidate, per axis, noise refitted."""
    out = np.empty((g.xx.shape[2], g.yy.shape[2]))
    count, logdet = g.count.sum(), g.logdet.sum(axis=0)
    for a in range(g.yy.shape[2]):
        w = 1.0 / scale[:, a] ** 2
        xz = np.tensordot(w, g.xz, 1)
        xx0 = np.tensordot(w, g.xx, 1)
        xx = xx0 - np.einsum("gkpi,gij,gkqj->gkpq", xz, base.inverse[a], xz, optimize=True)
        along = np.einsum("gkpi,gi->gkp", xz, base.coefficients[a])
        gain = _gain(xx, xx0, np.tensordot(w, g.xy[..., a], 1) - along)
        rss = np.maximum(base.rss[a][:, None] - gain, 1e-9 * base.rss[a][:, None])
        ll = _loglik(rss, logdet[:, None], count, (g.count * np.log(scale[:, a])).sum())
        out[:, a] = 2 * (ll.max(axis=0) - base.loglik[a].max())
    return np.maximum(out, 0.0)


def _gain(xx: np.ndarray, whole: np.ndarray, xy: np.ndarray) -> np.ndarray:
    """(G, K) squares that candidates explain. xx: (G, K, P, P) products of what the nuisances leave
    of their columns, and whole: of these; xy: (G, K, P) with the residual."""
    if xx.shape[-1] == 1:
        one, own, y = xx[..., 0, 0], whole[..., 0, 0], xy[..., 0]
        return np.where(one > LEAST_OWN * own, y**2 / np.maximum(one, 1e-300), 0.0)
    size = np.sqrt(np.maximum(np.einsum("gkpp->gkp", whole), 1e-300))
    unit = xx / (size[..., :, None] * size[..., None, :]) + TINY * np.eye(xx.shape[-1])
    y = xy / size
    return (y * np.linalg.solve(unit, y[..., None])[..., 0]).sum(axis=-1)


def session_scale(g: CrossProducts) -> np.ndarray:
    """(S, A) each session's own noise level beside the others', geometric mean one; shrunk towards
    it.
    """
    s, axes = len(g.count), g.yy.shape[2]
    scale = np.ones((s, axes))
    for _ in range(3 if s > 1 else 0):
        base = fit_base(g, scale)
        for a, (i, b) in enumerate(zip(base.best, base.fitted)):
            own = (
                g.yy[:, i, a] - 2 * g.zy[:, i, :, a] @ b + np.einsum("i,sij,j->s", b, g.zz[:, i], b)
            )
            log = 0.5 * np.log(np.maximum(own, 1e-300) / g.count)
            log -= log.mean()
            scale[:, a] = np.exp(np.where(np.abs(log) > 2.5 / np.sqrt(2 * g.count), log, 0.0))
    return scale
