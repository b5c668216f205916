"""Whether what is left of the three axes moves together: the mark of one cause, recorded or not."""

import numpy as np
from scipy.stats import chi2

from ...model.term import Terms
from .regression import Fit, Regression

_LOWEST = (3, 6, 12, 24)
#: A chance below which something is said to be there.
RARE = 1e-3


def coherence(regression: Regression, terms: Terms) -> tuple[float, np.ndarray]:
    """(p, direction): p of the lowest frequencies' correlation between axes, and their common
    direction in dps.

    Bartlett's test of independence of the axes' lowest DCT coefficients, each scaled by its noise;
    Bonferroni over the numbers of coefficients tried. Sessions with gaps are tested on their
    contrasts' smoothest part.
    """
    fit = regression.fit(terms)
    residual = regression.left(terms, fit)
    p, at = 1.0, _LOWEST[0]
    for lowest in _LOWEST:
        rows = np.vstack([_scaled(regression, fit, i, r)[:lowest] for i, r in enumerate(residual)])
        if len(rows) <= 3:  # so few lie in a plane, whatever they are
            continue
        logdet = np.linalg.slogdet(np.corrcoef(rows.T) + 1e-9 * np.eye(3))[1]
        this = chi2.sf(-(len(rows) - 1 - 11 / 6) * logdet, 3) * len(_LOWEST)
        if this < p:
            p, at = this, lowest
    low = np.vstack([r[:at] / regression.scale[i] for i, r in enumerate(residual)])
    return min(p, 1.0), low.T @ low / len(low)


def _scaled(regression: Regression, fit: Fit, i: int, residual: np.ndarray) -> np.ndarray:
    spectrum = regression.whiteners[i].spectrum
    own = np.column_stack([spectrum[g] for g in fit.base.best])[: len(residual)]
    return residual / np.sqrt(own) / regression.scale[i]


def turned_axes(regression: Regression, terms: Terms) -> np.ndarray:
    """(3, 3) axes scaled to equal white noise, the first along what is common to the lowest
    frequencies.
    """
    variance = regression.fit(terms).base.variance
    if not (variance > 0).all():  # columns all but alike explain everything
        return np.eye(3)
    white = np.sqrt(variance)
    _, covariance = coherence(regression, terms)
    values, vectors = np.linalg.eigh(covariance / np.outer(white, white))
    return vectors[:, ::-1].T / white
