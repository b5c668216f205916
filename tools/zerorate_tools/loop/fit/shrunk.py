"""Weights of play operators, as large as the recordings say.

Play operators of several widths are much alike: by least squares they fight, and follow the noise.
Here their weights are normal about zero (ridge), those of the squares by themselves. How large they
are, and the colour of the noise, is weighed by what the recordings make of it (restricted
likelihood, the sizes alike on all axes, the colour of each its own); the weights are the mean over
all sizes and colours, not the likeliest (Rasmussen and Williams, Gaussian Processes for Machine
Learning, 2006, 2.7).
"""

from dataclasses import dataclass
from itertools import product

import numpy as np

from ...model.term import Terms
from .cross_products import CrossProducts
from .likelihood import TINY
from .noise import LOG_PRIOR
from .regression import Regression

#: Variance of what all operators, or waves, add, of that of a block's white noise; and of it, up to
#: all, that of squares.
SIZES = np.r_[1e-3, 10.0 ** np.arange(-1.0, 4.1, 0.5)]


def has_play_operators(terms: Terms) -> bool:
    """Whether some terms are play operators."""
    return any(t.memory == "play" for t in terms)


@dataclass
class Shrunk:
    """coefficients: (J, A) of terms, as large as is likely; precision: (A, J) of those of the play
    operators about zero, over the white part of the noise, at the likeliest size, else zero; nats:
    by which they, of any size, are likelier than none of them."""

    coefficients: np.ndarray
    precision: np.ndarray
    nats: float


def shrink(
    g: CrossProducts, scale: np.ndarray, terms: Terms, own: slice | None = None, alike: bool = True
) -> Shrunk:
    """Terms fitted to products of them, which are the first of the columns.

    scale: (S, A) noise of each session; own: which terms are shrunk, if not the play operators;
    alike: whether they are of one size on all axes, or each axis has its own.
    """
    axes = _Axes(g, scale)
    groups = _groups(terms, axes.zz.shape[-1], own)
    spans = [axes.spans(own, np.any(groups, axis=0)) for own in groups]
    precisions, told, fitted = [], [], []
    for sizes in product(SIZES, *[SIZES[SIZES <= 1.0]] * (len(groups) - 1)):
        shares = np.cumprod(sizes)
        parts = [own * span / share for own, span, share in zip(groups, spans, shares)]
        precision = np.sum([np.zeros(axes.zz.shape[-1]), *parts], axis=0)
        precisions.append(precision)
        nats, coefficients = axes.fit(precision)
        told.append(nats)
        fitted.append(coefficients)
    likely = np.array(told)
    if alike:
        likely = np.repeat(likely.sum(axis=1, keepdims=True), scale.shape[1], axis=1)
    weight = np.exp(likely - likely.max(axis=0))
    mean = np.einsum("sa,saj->ja", weight / weight.sum(axis=0), np.array(fitted))
    nats = likely.max(axis=0) + np.log(weight.mean(axis=0)) - likely[0]
    total = float(nats.mean() if alike else nats.sum())
    return Shrunk(mean, np.array(precisions)[likely.argmax(axis=0)], total)


def _groups(terms: Terms, columns: int, own: slice | None) -> list[np.ndarray]:
    """(columns,) of zero and one: the play operators, and their squares where there are any."""
    shrunk = [t.memory == "play" for t in terms]
    if own is not None:
        shrunk = [i in range(*own.indices(len(terms))) for i in range(len(terms))]
    powers = [t.power * s for t, s in zip(terms, shrunk)] + [0] * (columns - len(terms))
    return [np.array(powers) == p for p in sorted({*powers} - {0})]


def evidence(regression: Regression, terms: Terms, candidate: Terms) -> float:
    """Nats by which a candidate of any size is likelier beside terms than none."""
    every, own = [*terms, *candidate], slice(len(terms), None)
    return shrink(regression.cross_products(every), regression.scale, every, own).nats


class _Axes:
    """Products of each axis over all sessions, by colour: (axes, colours, ...)."""

    def __init__(self, g: CrossProducts, scale: np.ndarray) -> None:
        weights = 1.0 / scale.T**2
        self.zz = np.array([np.tensordot(w, g.zz, 1) for w in weights])
        self.zy = np.array([np.tensordot(w, g.zy[..., a], 1) for a, w in enumerate(weights)])
        self.yy = np.array([w @ g.yy[..., a] for a, w in enumerate(weights)])
        self.logdet, self.count = g.logdet.sum(axis=0), g.count.sum()
        self.tiny = TINY * np.einsum("agjj->aj", self.zz) + 1e-300

    def spans(self, own: np.ndarray, plays: np.ndarray) -> float:
        """Sum of the variances of columns, less what all but play operators take of them."""
        zz = self.zz[0, 0] + np.diag(self.tiny[0])
        rest = zz[np.ix_(~plays, ~plays)]
        cross = zz[np.ix_(~plays, own)]
        taken = np.einsum("jk,jk->", cross, np.linalg.solve(rest, cross)) if len(rest) else 0.0
        return max((np.trace(zz[np.ix_(own, own)]) - taken) / self.count, 1e-300)

    def fit(self, precision: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(A,) log likelihood, and (A, J) coefficients, over all colours."""
        more = (precision + self.tiny)[:, :, None] * np.eye(len(precision))
        factor = np.linalg.cholesky(self.zz + more[:, None])
        half = np.linalg.solve(factor, self.zy[..., None])[..., 0]
        fitted = np.linalg.solve(factor.swapaxes(2, 3), half[..., None])[..., 0]
        left = np.maximum(self.yy - (half**2).sum(axis=2), 1e-300)
        shrunk = precision > 0
        free = self.count - (~shrunk).sum()
        likely = 0.5 * np.log(precision[shrunk]).sum() - 0.5 * free * np.log(left)
        likely -= np.log(np.einsum("agjj->agj", factor)).sum(axis=2) + 0.5 * self.logdet
        likely += LOG_PRIOR[: likely.shape[1]]
        top = likely.max(axis=1)
        weight = np.exp(likely - top[:, None])
        whole = weight.sum(axis=1)
        mean = np.array([w @ c for w, c in zip(weight, fitted)]) / whole[:, None]
        return top + np.log(whole), mean
