"""Does a candidate predict sessions that its fit did not see?"""

import numpy as np

#: Of coefficients about zero, over their size in all sessions: wide, so that only what the other
#: sessions all but fail to show is held back.
_SPREAD = 3.0


def spread_of(coefficients: np.ndarray, own: slice) -> np.ndarray:
    """(J,) about zero of the (A, J) coefficients fitted on all sessions; infinite but for the own
    ones of a candidate.
    """
    out = np.full(coefficients.shape[1], np.inf)
    size = np.sqrt((coefficients[:, own] ** 2).mean(axis=0))
    out[own] = _SPREAD * np.maximum(size, 1e-300)
    return out


def fitted_without(g, s: int, a: int, c: int, variance, scale: np.ndarray, spread=None):
    """(J,) coefficients of an axis at a colour, fitted on the other sessions than s; arguments as
    for `session_misfit`, variance of this axis.
    """
    others = np.arange(len(g.count)) != s
    w = scale[others, a] ** -2.0
    zz = np.tensordot(w, g.zz[others, c], 1)
    if spread is not None:
        zz = zz + np.diag(variance / spread**2)
    return np.linalg.lstsq(zz, w @ g.zy[others, c, :, a], rcond=1e-12)[0]


def session_misfit(g, s: int, colour, variance, scale: np.ndarray, spread=None) -> float:
    """Weighted squares of session s left by coefficients fitted on the other sessions.

    colour: (A,) grid index and variance: (A,) dps^2 at which every fit is weighted; scale: (S, A);
    spread: (J,) of coefficients about zero, known before the fit, infinite where it is not.
    """
    total = 0.0
    for a, c in enumerate(colour):
        b = fitted_without(g, s, a, c, variance[a], scale, spread)
        rss = g.yy[s, c, a] - 2 * g.zy[s, c, :, a] @ b + b @ g.zz[s, c] @ b
        total += scale[s, a] ** -2.0 * rss / variance[a]
    return float(total)


def gains(regression, terms, candidate) -> np.ndarray:
    """(S,) nats by which each session, left out, is better predicted with the candidate than
    without.

    The noise is the one fitted with the candidate in, the same for both, so that only the
    prediction differs. A column of the candidate that the other sessions do not show is worth
    nothing there, not anything: its coefficients are of the size that all sessions give.
    """
    full = regression.fit([*terms, *candidate]).base
    spread = spread_of(full.fitted, slice(len(terms), len(terms) + len(candidate)))
    misfit = []
    for chosen, known in ((terms, None), ([*terms, *candidate], spread)):
        g = regression.cross_products(chosen)
        each = range(len(g.count))
        misfit.append(
            [session_misfit(g, s, full.best, full.variance, regression.scale, known) for s in each]
        )
    return 0.5 * (np.array(misfit[0]) - np.array(misfit[1]))
