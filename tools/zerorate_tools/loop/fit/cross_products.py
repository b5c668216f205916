"""Cross products of residual, nuisances and candidates under every noise colour of the grid,
session by session.

Everything the loop asks for afterwards (likelihoods with the noise refitted, sessions left out,
surrogates) is a sum of these over sessions.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from weakref import WeakValueDictionary

import numpy as np
from scipy.linalg import block_diag, solve_triangular

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
        self.coefficients = int(available.sum()) - 1

    def prepare(self, columns: np.ndarray) -> np.ndarray:
        """(n, K) block columns to the (n - 1, K) the products are taken of."""
        return noise.transform(columns)

    def products(
        self, fixed: np.ndarray, tried: np.ndarray, size: int = 1
    ) -> tuple[np.ndarray, ...]:
        """Products under every colour of (n - 1, L) fixed columns with each other, (shapes, L, L),
        of (n - 1, K) others with them, (shapes, K, L), and of each so many others, which are tried
        together, with each other, (shapes, K / size, size, size).
        """
        groups = tried.reshape(len(tried), -1, size)
        own = self._summed(groups[:, :, :, None] * groups[:, :, None, :])
        return self._pairs(fixed, fixed), self._pairs(tried, fixed), own

    def _pairs(self, left: np.ndarray, right: np.ndarray) -> np.ndarray:
        return self._summed(left[:, :, None] * right[:, None, :])

    def _summed(self, values: np.ndarray) -> np.ndarray:
        flat = self.weight @ values.reshape(len(values), -1)
        return flat.reshape(len(self.weight), *values.shape[1:])


class GappyWhitener(Whitener):
    """The same for a session with blocks missing: the covariance of what is there, factorised per
    colour.
    """

    def __init__(self, available: np.ndarray):
        super().__init__(available)
        # (n, n - 1) without a mean: what is left of n blocks when their offset is free
        self._keep = noise.transform(np.eye(self.coefficients + 1)).T
        part = noise.transform(np.eye(self.n))[:, available] @ self._keep
        self.logdet = np.empty(len(self.spectrum))
        self.whitening = np.empty((len(self.spectrum), self.coefficients, self.coefficients))
        unit = np.eye(self.coefficients)
        for g, spectrum in enumerate(self.spectrum):
            factor = np.linalg.cholesky(part.T @ (part * spectrum[:, None]))
            self.logdet[g] = 2 * np.log(np.diag(factor)).sum()
            self.whitening[g] = solve_triangular(factor, unit, lower=True, check_finite=False)
        self._known: dict[bytes, np.ndarray] = {}

    def prepare(self, columns: np.ndarray) -> np.ndarray:
        return self._keep.T @ columns[self.available]

    def products(
        self, fixed: np.ndarray, tried: np.ndarray, size: int = 1
    ) -> tuple[np.ndarray, ...]:
        white = self._whitened(fixed)
        both = white @ white.transpose(0, 2, 1)
        shape = len(self.whitening), tried.shape[1]
        cross = np.empty((*shape, fixed.shape[1]))
        groups = np.empty((shape[0], shape[1] // size, size, size))
        for g, w in enumerate(self.whitening):
            own = (w @ tried).T
            cross[g] = own @ white[g].T
            each = own.reshape(-1, size, own.shape[1])
            groups[g] = each @ each.transpose(0, 2, 1)
        return both, cross, groups

    def _whitened(self, columns: np.ndarray) -> np.ndarray:
        """(shapes, K, N) of (N, K) columns, of which most are those of the call before."""
        keys = [c.tobytes() for c in columns.T]
        new = [i for i, key in enumerate(keys) if key not in self._known]
        if new:
            shapes, n, _ = self.whitening.shape
            made = (self.whitening.reshape(-1, n) @ columns[:, new]).reshape(shapes, n, len(new))
            self._known |= {keys[i]: made[:, :, k].copy() for k, i in enumerate(new)}
        out = np.empty((len(self.whitening), *columns.shape[::-1]))
        for i, key in enumerate(keys):
            out[:, i] = self._known[key]
        self._known = {key: self._known[key] for key in keys}
        return out


class BridgedWhitener(Whitener):
    """The same for a session with a few blocks missing: bridged by a straight line, in every column
    alike.
    """

    def prepare(self, columns: np.ndarray) -> np.ndarray:
        at, there = np.arange(self.n), np.flatnonzero(self.available)
        filled = [np.interp(at, there, c[there]) for c in columns.T]
        return noise.transform(np.column_stack(filled)) if filled else np.zeros((self.n - 1, 0))


class WhiteWhitener(Whitener):
    """The same under white noise alone: least squares, with an offset of what is there."""

    def __init__(self, available: np.ndarray):
        self.available = available
        self.coefficients = int(available.sum()) - 1
        self.spectrum = self.weight = np.ones((1, self.coefficients + 1))
        self.logdet = np.zeros(1)

    def prepare(self, columns: np.ndarray) -> np.ndarray:
        there = columns[self.available]
        return there - there.mean(axis=0)


_KNOWN: WeakValueDictionary[bytes, Whitener] = WeakValueDictionary()


def whitener(available: np.ndarray) -> Whitener:
    """The cheapest one that the gaps allow; the same again while anyone holds it."""
    key = available.tobytes()
    known = _KNOWN.get(key)
    if known is None:
        known = _KNOWN[key] = _new(available)(available)
    return known


def _new(available: np.ndarray) -> type[Whitener]:
    if available.all():
        return Whitener
    return BridgedWhitener if can_be_bridged(available) else GappyWhitener


@dataclass
class CrossProducts:
    """Cross products by (session, shape, ...). y: axes A; z: nuisances J; x: candidates K of so
    many columns P each."""

    yy: np.ndarray  # S G A
    zy: np.ndarray  # S G J A
    zz: np.ndarray  # S G J J
    xy: np.ndarray  # S G K P A
    xz: np.ndarray  # S G K P J
    xx: np.ndarray  # S G K P P
    logdet: np.ndarray  # S G
    count: np.ndarray  # S

    def of(self, keep: np.ndarray) -> CrossProducts:
        """Some sessions, by their index."""
        return CrossProducts(*(getattr(self, f)[keep] for f in self.__dataclass_fields__))

    def mapped(self, first: int, by: np.ndarray) -> CrossProducts:
        """With (P, Q) sums of nuisances in the place of P of them from the first of these on."""
        j = self.zz.shape[-1]
        whole = block_diag(np.eye(first), by, np.eye(j - first - len(by)))
        zz, xz = whole.T @ self.zz @ whole, self.xz @ whole
        return replace(self, zz=zz, zy=whole.T @ self.zy, xz=xz)


def cross_products(
    whiteners: list[Whitener],
    y: list[np.ndarray],
    z: list[np.ndarray],
    x: list[np.ndarray] | None = None,
    size: int = 1,
) -> CrossProducts:
    """Products of prepared columns, a session an entry: y (N, A), z (N, J), x (N, K); of x each so
    many are one candidate."""
    x = x or [v[:, []] for v in y]
    parts = []
    for w, ys, zs, xs in zip(whiteners, y, z, x):
        fixed = np.hstack([ys, zs])
        both, cross, xx = w.products(fixed, xs, size)
        a = ys.shape[1]
        yy = np.einsum("gaa->ga", both[:, :a, :a])
        cross = cross.reshape(len(cross), -1, size, cross.shape[2])
        parts.append((yy, both[:, a:, :a], both[:, a:, a:], cross[..., :a], cross[..., a:], xx))
    yy, zy, zz, xy, xz, xx = (np.stack(p) for p in zip(*parts))
    return CrossProducts(
        *(yy, zy, zz, xy, xz, xx),
        logdet=np.stack([w.logdet for w in whiteners]),
        count=np.array([w.coefficients for w in whiteners]),
    )
