"""Does a candidate predict sessions that its fit did not see?"""

from __future__ import annotations

import numpy as np


def session_misfit(g, s: int, colour, variance, scale: np.ndarray) -> float:
    """Weighted squares of session s left by coefficients fitted on the other sessions of a Gram.

    colour: (A,) grid index and variance: (A,) dps^2 at which every fit is weighted; scale: (S, A).
    """
    others = np.arange(len(g.count)) != s
    total = 0.0
    for a, c in enumerate(colour):
        w = scale[:, a] ** -2.0
        zz = np.tensordot(w[others], g.zz[others, c], 1)
        zy = w[others] @ g.zy[others, c, :, a]
        b = np.linalg.lstsq(zz, zy, rcond=1e-12)[0]
        rss = g.yy[s, c, a] - 2 * g.zy[s, c, :, a] @ b + b @ g.zz[s, c] @ b
        total += w[s] * rss / variance[a]
    return float(total)


def gains(regression, terms, candidate) -> np.ndarray:
    """(S,) nats by which each session, left out, is better predicted with the candidate than
    without.

    The noise is the one fitted with the candidate in, the same for both, so that only the
    prediction differs.
    """
    full = regression.fit([*terms, *candidate])
    colour = full.base.best
    count = sum(w.coefficients for w in regression.whiteners)
    variance = np.array([full.base.rss[a, c] / count for a, c in enumerate(colour)])
    misfit = []
    for chosen in (terms, [*terms, *candidate]):
        g = regression.gram(chosen)
        misfit.append(
            [session_misfit(g, s, colour, variance, regression.scale) for s in range(len(g.count))]
        )
    return 0.5 * (np.array(misfit[0]) - np.array(misfit[1]))
