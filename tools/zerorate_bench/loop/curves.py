"""What curves over temperature leave of a recording, held out as the loop is: by least squares, and
lines of several bends smooth as the loop draws them.

A cubic is the rival. The best of many curves, chosen by what is held out itself, is a floor: no
search, which may not look there, can be expected to find a curve that leaves less.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from zerorate_tools.loop.fit.line import ordinary
from zerorate_tools.loop.fit.regression import predicted
from zerorate_tools.loop.fit.single import PiecesByLine, held
from zerorate_tools.loop.search.catalogue import ranges
from zerorate_tools.loop.verify.judge import rms_dps, scored
from zerorate_tools.model.term import Term

#: No temperature of a part is so far.
_FAR_DEGC = 1e4
_POWERS, _MOST_BENDS = 7, 12


def cubic_left(analysis) -> list[NDArray[np.float64]] | None:
    """(n, 3) dps that a cubic leaves of each held-out part by the same pieces, or fitted on the
    same power-ons: held at the edges of what it was fitted to or not, whichever leaves less; NaN
    where unscored. None without temperature.
    """
    powers = _powers(analysis, 3)
    if not powers:
        return None
    left = [_left(analysis, terms) for terms in (powers, _at_edges(analysis, powers))]
    return min(left, key=lambda parts: float((rms_dps(parts) ** 2).sum()))


def best_curve_rms_dps(analysis) -> float | None:
    """RMS over the axes of what the best curve leaves: on each axis the best mean, of any weights,
    of two out of polynomials and lines with even bends, held at the edges or not. None without
    temperature.
    """
    powers = _powers(analysis, _POWERS)
    if not powers:
        return None
    curves = [powers[: n + 1] for n in range(_POWERS)]
    curves += [_bent(analysis, powers[0], bends) for bends in range(1, _MOST_BENDS + 1)]
    curves += [_at_edges(analysis, terms) for terms in curves]
    left = np.array([np.vstack(_left(analysis, terms)) for terms in curves])
    left = left[:, np.isfinite(left).all(axis=(0, 2))]
    return float(np.sqrt(np.mean([_least_mean_square(left[..., a]) for a in range(3)])))


def _powers(analysis, most: int) -> list[Term]:
    line = analysis.selection.line
    free = [replace(t, lo=-_FAR_DEGC, hi=_FAR_DEGC) for t in line]
    return [replace(free[0], power=k) for k in range(1, most + 1)] if free else []


def _bent(analysis, slope: Term, bends: int) -> list[Term]:
    lo, hi, _ = ranges(analysis.train)["temp"]
    at = np.linspace(lo, hi, bends + 2)[1:-1] - slope.centre
    return [slope, *(replace(slope, knot=float(knot)) for knot in at)]


def _at_edges(analysis, terms: list[Term]) -> list[Term]:
    return [held(replace(t, lo=-np.inf, hi=np.inf), analysis.train) for t in terms]


def _left(analysis, terms: list[Term]) -> list[NDArray[np.float64]]:
    """(n, 3) of each held-out part, NaN where unscored."""
    if analysis.single:
        return [PiecesByLine(analysis.sessions[0]).residual([], terms)]
    fitted = ordinary(terms, analysis.train)
    return [scored(s, predicted(terms, fitted, s))[0] for s in analysis.holdout]


def _least_mean_square(left: NDArray[np.float64]) -> float:
    """Least mean square of a mean of two of the (curves, n) rows."""
    e = left @ left.T / left.shape[1]
    own = np.diag(e)[:, None]
    apart = np.maximum(own - 2 * e + own.T, 1e-300)
    share = np.clip((own - e) / apart, 0.0, 1.0)
    return float((own - 2 * share * (own - e) + share**2 * apart).min())
