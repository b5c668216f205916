"""Cross products of residual, nuisances and candidates under every noise colour of the grid,
session by session.

Everything the loop asks for afterwards (likelihoods with the noise refitted, sessions left out,
surrogates) is a sum of these over sessions.
"""

from __future__ import annotations

from dataclasses import dataclass
from weakref import WeakValueDictionary

import numpy as np
from scipy.linalg import solve_triangular

from ..read.blocks import can_be_bridged
from . import noise


class Whitener:
    """The spectra of one session's noise, and its columns' cross products under each of them."""

    def __init__(self, available: np.ndarray):
        self.available = available
        self.n = len(available)
        self.spectrum = noise.spectra(self.n)
        self.weight = 1.0 / self.spectrum
        self.logdet = np.log(self.spectrum).sum(axis=1)
        self.coefficients = self.n - 1

    def prepare(self, columns: np.ndarray) -> np.ndarray:
        """(n, K) block columns to the (n - 1, K) the products are taken of."""
        return noise.transform(columns)

    def products(self, left: np.ndarray, right: np.ndarray) -> np.ndarray:
        """(shapes, K): left'W right for matching columns of two (n - 1, K) arrays."""
        return self.weight @ (left * right)


class GappyWhitener(Whitener):
    """The same for a session with blocks missing: the covariance of what is there, factorised per
    colour.
    """

    def __init__(self, available: np.ndarray):
        super().__init__(available)
        self.coefficients = int(available.sum()) - 1
        self._keep = _contrasts(self.coefficients + 1)
        part = noise.transform(np.eye(self.n))[:, available] @ self._keep
        self.logdet = np.empty(len(self.spectrum))
        self.whitening = np.empty((len(self.spectrum), self.coefficients, self.coefficients))
        unit = np.eye(self.coefficients)
        for g, spectrum in enumerate(self.spectrum):
            factor = np.linalg.cholesky(part.T @ (part * spectrum[:, None]))
            self.logdet[g] = 2 * np.log(np.diag(factor)).sum()
            self.whitening[g] = solve_triangular(factor, unit, lower=True, check_finite=False)

    def prepare(self, columns):
        return self._keep.T @ columns[self.available]

    def products(self, left, right):
        out = np.empty((len(self.whitening), left.shape[1]))
        for g, w in enumerate(self.whitening):
            a = w @ left
            out[g] = (a * (a if left is right else w @ right)).sum(axis=0)
        return out

    def pairs(self, left, right):
        """(G, L, R) products of every pair of columns."""
        out = np.empty((len(self.whitening), left.shape[1], right.shape[1]))
        for g, w in enumerate(self.whitening):
            a = w @ left
            out[g] = a.T @ (a if left is right else w @ right)
        return out


class BridgedWhitener(Whitener):
    """The same for a session with a few blocks missing: bridged by a straight line, in every column
    alike.
    """

    def __init__(self, available: np.ndarray):
        super().__init__(available)
        self.coefficients = int(available.sum()) - 1

    def prepare(self, columns):
        at, there = np.arange(self.n), np.flatnonzero(self.available)
        filled = [np.interp(at, there, c[there]) for c in columns.T]
        return noise.transform(np.column_stack(filled)) if filled else np.zeros((self.n - 1, 0))


def _contrasts(n: int) -> np.ndarray:
    """(n, n - 1) orthonormal columns without a mean: what is left of n blocks when their offset is
    free.
    """
    return noise.transform(np.eye(n)).T


_KNOWN: WeakValueDictionary[bytes, Whitener] = WeakValueDictionary()


def whitener(available: np.ndarray) -> Whitener:
    """The cheapest one that the gaps allow; the same again while anyone holds it."""
    key = available.tobytes()
    known = _KNOWN.get(key)
    if known is None:
        known = _KNOWN[key] = _new(available)
    return known


def _new(available):
    if available.all():
        return Whitener(available)
    return BridgedWhitener(available) if can_be_bridged(available) else GappyWhitener(available)


@dataclass
class CrossProducts:
    """Cross products by (session, shape, ...). y: axes A; z: nuisances J; x: candidates K."""

    yy: np.ndarray  # S G A
    zy: np.ndarray  # S G J A
    zz: np.ndarray  # S G J J
    xy: np.ndarray  # S G K A
    xz: np.ndarray  # S G K J
    xx: np.ndarray  # S G K
    logdet: np.ndarray  # S G
    count: np.ndarray  # S

    def of(self, keep: np.ndarray) -> CrossProducts:
        """Some sessions, by their index."""
        return CrossProducts(*(getattr(self, f)[keep] for f in self.__dataclass_fields__))


def _pairs(w: Whitener, left, right):
    """(G, L, R) products of every pair of columns."""
    if isinstance(w, GappyWhitener):
        return w.pairs(left, right)
    flat = (left[:, :, None] * right[:, None, :]).reshape(len(left), -1)
    return (w.weight @ flat).reshape(len(w.weight), left.shape[1], right.shape[1])


def cross_products(
    whiteners: list[Whitener], y: list, z: list, x: list | None = None
) -> CrossProducts:
    """Products of prepared columns, a session an entry: y (N, A), z (N, J), x (N, K)."""
    x = x if x is not None else [np.zeros((len(v), 0)) for v in y]
    parts = []
    for w, ys, zs, xs in zip(whiteners, y, z, x):
        fixed = np.hstack([ys, zs])
        both, a = _pairs(w, fixed, fixed), ys.shape[1]
        cross = _pairs(w, xs, fixed)
        yy = np.einsum("gaa->ga", both[:, :a, :a])
        parts.append(
            (
                yy,
                both[:, a:, :a],
                both[:, a:, a:],
                cross[:, :, :a],
                cross[:, :, a:],
                w.products(xs, xs),
            )
        )
    yy, zy, zz, xy, xz, xx = (np.stack(p) for p in zip(*parts))
    return CrossProducts(
        *(yy, zy, zz, xy, xz, xx),
        logdet=np.stack([w.logdet for w in whiteners]),
        count=np.array([w.coefficients for w in whiteners]),
    )
