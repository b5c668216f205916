"""A line over temperature that bends often, as smooth as the recording says.

By least squares so many bends follow the noise. Here the curve is a straight line and a smooth
deviation from it, as a Gaussian process of Matern's covariance (5/2) has it: how large and how long
its waves are is weighed by what the data make of it (restricted likelihood, white noise of each
axis, the waves alike on all three), and the curve is the mean over all of them, not the likeliest
(Rasmussen and Williams, Gaussian Processes for Machine Learning, 2006, 2.7 and 4.2.1). The slots'
line is the one nearest to that curve.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...model.term import Terms
from ..read.sessions import Session, block_basis
from .likelihood import TINY
from .regression import is_of_force, of_data_sheets
from .shrunk import SIZES

#: Lengths of the waves, of the range of temperature.
LENGTHS = (0.05, 0.1, 0.2, 0.4, 0.8)
#: Points at which the curve is computed, a segment of the line.
_POINTS = 3


def curve_of(terms: Terms) -> list[int]:
    """Which terms are one slope and its bends, two and more; whoever makes such puts the bends at
    even distances."""
    bent = [i for i, t in enumerate(terms) if t.knot is not None and np.isfinite(t.lo)]
    for first, slope in enumerate(terms):
        own = [i for i in bent if replace(terms[i], knot=None) == slope]
        if len(own) > 1:
            return [first, *own]
    return []


def smooth(terms: Terms, own: Sequence[int], sessions: Sequence[Session]) -> np.ndarray:
    """(terms, 3) dps per unit by least squares, an offset a session, those of a slope and its bends
    (`curve_of`) by the curve nearest to which they are."""
    corners = _corners([terms[i] for i in own])
    at = np.linspace(corners[0], corners[-1], _POINTS * (len(corners) - 1) + 1)
    beside = [i for i in range(len(terms)) if i not in own]
    curve, others = _curve(at, [terms[i] for i in beside], sessions)
    heights = np.linalg.lstsq(_between(at, corners), curve, rcond=None)[0]
    slopes = np.diff(heights, axis=0) / np.diff(corners)[:, None]
    out = np.empty((len(terms), 3))
    out[own], out[beside] = np.vstack([slopes[:1], np.diff(slopes, axis=0)]), others
    return out


def _corners(terms: Terms) -> np.ndarray:
    """(terms + 1,) degC at which the segments begin and end."""
    knots = terms[0].centre + np.array([t.knot for t in terms[1:]])
    apart = knots[1] - knots[0]
    return np.r_[knots[0] - apart, knots, knots[-1] + apart]


def _between(degc: np.ndarray, at: np.ndarray) -> np.ndarray:
    """(n, points) shares of the points between which each temperature lies."""
    return np.column_stack([np.interp(degc, at, unit) for unit in np.eye(len(at))])


def _curve(
    at: np.ndarray, beside: Terms, sessions: Sequence[Session]
) -> tuple[np.ndarray, np.ndarray]:
    """(points, 3) dps of the straight line and a smooth deviation from it, and (terms, 3) dps per
    unit of what is beside."""
    x, y = [], []
    for s in sessions:
        degc, there = s.block_mean(s.source("temp")), s.available
        columns = [degc, *(block_basis(t, s) for t in beside), _between(degc, at)]
        x.append(s.less_offsets(np.column_stack(columns), there)[there])
        y.append(s.less_offsets(s.rate_dps, there)[there])
    every, rates, plain = np.vstack(x), np.vstack(y), 1 + len(beside)
    free = len(rates) - plain - sum(1 + len(s.steps) for s in sessions)
    scale = every[:, :plain].std(axis=0)
    scale[scale == 0] = 1.0  # nothing was seen of it
    line, shares = every[:, :plain] / scale, every[:, plain:]
    own = np.linalg.qr(line)[0]
    left, waves = (v - own @ (own.T @ v) for v in (rates, shares))
    deviation = _deviation(at, waves, left, free)
    rest = rates - shares @ deviation
    known = of_data_sheets(float(rates.var()))
    precision = np.array([0.0, *(known * is_of_force(t) for t in beside)])
    line = np.vstack([line, np.diag(np.sqrt(precision) / scale)])
    rest = np.vstack([rest, np.zeros((plain, 3))])
    fitted = np.linalg.lstsq(line, rest, rcond=1e-12)[0] / scale[:, None]
    return deviation + at[:, None] * fitted[0], fitted[1:]


def _deviation(at: np.ndarray, waves: np.ndarray, left: np.ndarray, free: int) -> np.ndarray:
    """(points, 3) dps: the mean over all lengths and sizes of the waves, by their likelihood.

    waves: (blocks, points) of what a deviation of 1 at a point adds; left: (blocks, 3) of the
    rates; free: blocks less what was fitted already.
    """
    told, curves = [], []
    for length in LENGTHS:
        root = np.linalg.cholesky(matern(at, length))
        u, d, v = np.linalg.svd(waves @ root, full_matrices=False)
        own = u.T @ left
        rest = (left**2).sum(axis=0) - (own**2).sum(axis=0)
        for size in SIZES:
            grows = 1.0 + size * d**2
            squares = rest + (own**2 / grows[:, None]).sum(axis=0)
            likely = -0.5 * np.log(grows).sum() - 0.5 * free * np.log(squares + 1e-300)
            told.append(likely.sum())
            curves.append(root @ v.T @ ((size * d / grows)[:, None] * own))
    return by_likelihood(told, curves)


def by_likelihood(nats: Sequence[float], curves: Sequence[np.ndarray]) -> np.ndarray:
    """The mean of curves of one shape by the likelihood of each."""
    weight = np.exp(np.array(nats) - max(nats))
    return np.tensordot(weight / weight.sum(), curves, 1)


def matern(at: np.ndarray, length: float) -> np.ndarray:
    """(points, points) covariance of waves of a length, with 1 on the diagonal."""
    apart = np.sqrt(5.0) * np.abs(at[:, None] - at) / (length * (at[-1] - at[0]))
    return (1.0 + apart + apart**2 / 3.0) * np.exp(-apart) + TINY * np.eye(len(at))
