"""The smallest effect of each kind that these sessions could have shown."""

import numpy as np
from scipy.stats import norm

from ..read.sessions import block_basis

_POWER = 0.9


def smallest_dps(regression, nuisances, pool, needed) -> dict[str, float]:
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


def _information(g, base, scale):
    """(K,) sum over axes of what a unit coefficient adds to the likelihood ratio, at the fitted
    noise.
    """
    total = np.zeros(g.xx.shape[2])
    for a, i in enumerate(base.best):
        w = scale[:, a] ** -2.0
        xz, xx = np.tensordot(w, g.xz[:, i].squeeze(2), 1), w @ g.xx[:, i].squeeze((2, 3))
        left = xx - np.einsum("ki,ij,kj->k", xz, base.inverse[a][i], xz)
        total += np.where(left > 1e-6 * xx, left, 0.0) / base.variance[a]
    return total


def _own_rms(term, nuisances, sessions):
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
