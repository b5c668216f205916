"""Does a candidate predict sessions that its fit did not see?"""

import numpy as np

from ...model.term import Terms
from .cross_products import CrossProducts
from .likelihood import Base
from .regression import Regression
from .shrunk import has_play_operators, shrink
from .smooth import is_curve


def precision_of(
    regression: Regression, g: CrossProducts, base: Base, terms: Terms, own: slice
) -> np.ndarray:
    """(A, J) of coefficients about zero, over the white part of the noise: of the own ones of a
    candidate as large as all sessions show them; of the parts of a curve, and of play
    operators, as large as is likely.

    base: the fit of all sessions to the products g.
    """
    out = np.zeros(base.fitted.shape)
    if is_curve(terms[own]):
        out = shrink(g, regression.scale, terms, own, alike=False).precision
    else:
        size = np.sqrt((base.fitted[:, own] ** 2).mean(axis=0))
        out[:, own] = base.variance[:, None] / np.maximum(size, 1e-300) ** 2
    shrunk = of_plays(g, regression.scale, terms)
    return np.where(shrunk > 0, shrunk, out)


def of_plays(g: CrossProducts, scale: np.ndarray, terms: Terms) -> np.ndarray:
    """(A, J) precision of play operators among terms, as `precision_of`; zero of all else."""
    if not has_play_operators(terms):
        return np.zeros((scale.shape[1], g.zz.shape[-1]))
    return shrink(g, scale, terms).precision


def fitted_without(
    g: CrossProducts, s: int, a: int, c: int, scale: np.ndarray, precision: np.ndarray | None = None
) -> np.ndarray:
    """(J,) coefficients of an axis at a colour, fitted on the other sessions than s; arguments as
    for `session_misfit`, precision of this axis.
    """
    others = np.arange(len(g.count)) != s
    w = scale[others, a] ** -2.0
    zz = np.tensordot(w, g.zz[others, c], 1)
    if precision is not None:
        zz = zz + np.diag(precision)
    return np.linalg.lstsq(zz, w @ g.zy[others, c, :, a], rcond=1e-12)[0]


def session_misfit(
    g: CrossProducts,
    s: int,
    colour: np.ndarray,
    variance: np.ndarray,
    scale: np.ndarray,
    precision: np.ndarray | None = None,
) -> float:
    """Weighted squares of session s left by coefficients fitted on the other sessions.

    colour: (A,) grid index and variance: (A,) dps^2 at which every fit is weighted; scale: (S, A);
    precision: (A, J) of coefficients about zero, known before the fit (`precision_of`).
    """
    total = 0.0
    for a, c in enumerate(colour):
        own = None if precision is None else precision[a]
        b = fitted_without(g, s, a, c, scale, own)
        rss = g.yy[s, c, a] - 2 * g.zy[s, c, :, a] @ b + b @ g.zz[s, c] @ b
        total += scale[s, a] ** -2.0 * rss / variance[a]
    return float(total)


def gains(regression: Regression, terms: Terms, candidate: Terms) -> np.ndarray:
    """(S,) nats by which each session, left out, is better predicted with the candidate than
    without.

    The noise is the one fitted with the candidate in, the same for both, so that only the
    prediction differs. A column of the candidate that the other sessions do not show is worth
    nothing there, not anything: its coefficients are of the size that all sessions give.
    """
    both, own = [*terms, *candidate], slice(len(terms), len(terms) + len(candidate))
    full, whole = regression.fit(both).base, regression.cross_products(both)
    precision, misfit = precision_of(regression, whole, full, both, own), []
    for g, known in ((regression.cross_products(terms), None), (whole, precision)):
        each = range(len(g.count))
        misfit.append(
            [session_misfit(g, s, full.best, full.variance, regression.scale, known) for s in each]
        )
    return 0.5 * (np.array(misfit[0]) - np.array(misfit[1]))
