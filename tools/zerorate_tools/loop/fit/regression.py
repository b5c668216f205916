"""The sessions of one device made ready for fits: residual and columns prepared, axes perhaps
turned; and their noise, with the floor below which it lets no correction go.
"""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import median_filter

from ...allan import Noise
from ...model.term import Term, Terms
from ..read.sessions import Session, block_basis
from .cross_products import CrossProducts, Whitener, WhiteWhitener, cross_products, whitener
from .likelihood import Base, fit_base, ratios, session_scale
from .noise import GRID, IS_STEEP

#: Times the usual distance from the median of so many neighbours.
OUTLIER, _NEAR = 6.0, 9
#: Standard deviation, before anything is seen, of what an acceleration of 1 g adds: dps, by the
#: data sheets of MEMS gyroscopes. At rest it varies little, and follows what else it likes.
_PER_G = 0.1
#: By how much squares of acceleration are shrunk, of their own whitened squares: at rest their sum
#: is gravity's, a constant, and beside acceleration nothing but noise tells its coefficient.
_SUM_OF_SQUARES = 1e-3

#: Further nuisances: blocks of each session, or these prepared.
Events = list[list[np.ndarray]]


@dataclass
class Fit:
    """Terms fitted together. coefficients: (terms, 3) dps per unit, in the sensor's axes; colour:
    (A,) grid index.
    """

    coefficients: np.ndarray
    base: Base
    total: float


class Regression:
    """Residuals of some sessions and the cached columns of every term asked for.

    Axes are scaled by their noise and perhaps turned (`axes`, (3, 3): turned = rate @ axes.T), so
    that a cause common to them does not count three times. white: the noise is white, as the
    firmware's estimators have it: all that is left counts alike.
    """

    def __init__(self, sessions: list[Session], white: bool = False):
        self.sessions = sessions
        of = WhiteWhitener if white else whitener
        self.whiteners: list[Whitener] = [of(s.available) for s in sessions]
        self.rate = [s.rate_dps for s in sessions]
        self.outliers = 0
        self.axes = np.eye(3)
        self._precision: Mapping[Term, float] = {}
        self._of_data_sheets = 0.0
        self._cache: dict[Term, list[np.ndarray]] = {}
        self._extra: Events = []
        self.prepare()
        self.scale = np.ones((len(sessions), 3))
        self._known = self._of_steps()
        self._extra = list(self._known)

    def _of_steps(self) -> Events:
        """Prepared columns of the steps that the sessions are already without."""
        out = []
        for i, s in enumerate(self.sessions):
            for step in s.steps:
                own = [np.zeros(o.blocks) for o in self.sessions]
                own[i][step.block :] = 1.0
                out.append(self._prepared(own))
        return out

    def prepare(self) -> None:
        """Take the rates up anew, along the axes as they are."""
        self.y = [w.prepare(r @ self.axes.T) for w, r in zip(self.whiteners, self.rate)]

    def turn(self, axes: np.ndarray) -> None:
        """Look along other axes."""
        self.axes = axes
        self.prepare()

    @contextmanager
    def along(self, axes: np.ndarray) -> Iterator[None]:
        """Look along (3, 3) axes inside a `with`, and back."""
        before = self.axes
        self.turn(axes)
        yield
        self.turn(before)

    def in_sensor_axes(self) -> AbstractContextManager[None]:
        """Look along the sensor's own axes inside a `with`, and back."""
        return self.along(np.eye(3))

    @contextmanager
    def shrinking(self, precision: Mapping[Term, float]) -> Iterator[None]:
        """Shrink some terms inside a `with`. precision: of the weight of each about zero, over the
        variance of a block's white noise."""
        self._precision = precision
        yield
        self._precision = {}

    def columns(self, term: Term) -> list[np.ndarray]:
        """Prepared (N,) column of each session."""
        if term not in self._cache:
            self._cache[term] = self._prepared(block_basis(term, s) for s in self.sessions)
        return self._cache[term]

    def forget(self, term: Term) -> None:
        """Drop a term tried once, so that a search does not grow the cache."""
        self._cache.pop(term, None)

    def events(self) -> Events:
        """The further nuisances, prepared."""
        return list(self._extra)

    def set_events(self, columns: Events, kept: Events | None = None) -> None:
        """Replace the further nuisances by (n,) blocks of each session. kept: prepared ones that
        stay."""
        prepared = [self._prepared(blocks) for blocks in columns]
        self._extra = [*(self._known if kept is None else kept), *prepared]

    def _prepared(self, blocks: Iterable[np.ndarray]) -> list[np.ndarray]:
        """(N,) of each session's (n,) blocks."""
        return [w.prepare(b[:, None])[:, 0] for w, b in zip(self.whiteners, blocks)]

    def stack(self, terms: Terms) -> list[np.ndarray]:
        """(N, J) columns of the terms and the events, a session each."""
        columns = [self.columns(t) for t in terms] + self._extra
        return [
            np.column_stack([c[i] for c in columns]) if columns else np.zeros((len(self.y[i]), 0))
            for i in range(len(self.sessions))
        ]

    def cross_products(
        self, terms: Terms, candidates: Sequence[Terms] | None = None
    ) -> CrossProducts:
        """Products of residual, terms and candidates: tuples of equally many terms."""
        x, size = None, 1
        if candidates:
            every, size = [t for c in candidates for t in c], len(candidates[0])
            x = [
                np.column_stack([self.columns(t)[i] for t in every])
                for i in range(len(self.sessions))
            ]
        out = cross_products(self.whiteners, self.y, self.stack(terms), x, size)
        self._shrink(out.zz, terms)
        for k, c in enumerate(candidates or ()):
            self._shrink(out.xx[:, :, k], c)
        return out

    def _shrink(self, products: np.ndarray, terms: Terms) -> None:
        """Shrink terms that are the first of (S, ..., J, J), each session's share of it alike."""
        for i, term in enumerate(terms):
            if is_of_force(term) and term.power == 2:
                products[..., i, i] *= 1.0 + _SUM_OF_SQUARES
            known = self._precision.get(term, self._of_data_sheets * is_of_force(term))
            products[..., i, i] += known / len(self.sessions)

    def fit(self, terms: Terms) -> Fit:
        """Joint fit with the noise's colour refitted."""
        base = fit_base(self.cross_products(terms), self.scale)
        own = base.fitted[:, : len(terms)]
        return Fit(np.linalg.solve(self.axes, own).T, base, base.total)

    def left(self, terms: Terms, fit: Fit) -> list[np.ndarray]:
        """(N, A) prepared residual of each session beside what was fitted."""
        return [y - z @ fit.base.fitted.T for y, z in zip(self.y, self.stack(terms))]

    def settle(self, terms: Terms) -> None:
        """Hold outlying blocks at their neighbours and weigh the sessions, both given the terms."""
        coefficients = self.fit(terms).coefficients
        self.outliers = 0
        for i, s in enumerate(self.sessions):
            model = predicted(terms, coefficients, s)
            clean, count = _without_outliers(s.rate_dps - model)
            self.rate[i] = clean + model
            self.outliers += count
        self.prepare()
        self.scale = session_scale(self.cross_products(terms))
        self.heed_data_sheets(terms)

    def heed_data_sheets(self, terms: Terms) -> None:
        """Shrink all acceleration from now on, by the white noise beside the terms."""
        variance = self.fit(terms).base.variance / (self.axes**2).sum(axis=1)
        self._of_data_sheets = of_data_sheets(float(variance.mean()))

    def gains(self, terms: Terms, candidates: Sequence[Terms], chunk: int = 400) -> np.ndarray:
        """(K, A) likelihood ratio of each candidate's columns beside the terms. candidates: tuples
        of terms.
        """
        out = np.zeros((len(candidates), len(self.axes)))
        for size in {len(c) for c in candidates}:
            alike = [i for i, c in enumerate(candidates) if len(c) == size]
            for at in range(0, len(alike), chunk // size):
                part = alike[at : at + chunk // size]
                g = self.cross_products(terms, [candidates[i] for i in part])
                out[part] = ratios(g, fit_base(g, self.scale), self.scale)
        return np.maximum(out, 0.0)


def is_of_force(term: Term) -> bool:
    """Whether a term follows acceleration."""
    return term.source.startswith("acc_")


def of_data_sheets(variance: float) -> float:
    """Precision of a term of acceleration about zero, over the variance of a block, dps^2."""
    return variance / _PER_G**2


def predicted(terms: Terms, coefficients: Collection[np.ndarray], session: Session) -> np.ndarray:
    """(n, 3) dps that terms with (terms, 3) coefficients add to the bias of each block."""
    out = np.zeros((session.blocks, 3))
    for term, c in zip(terms, coefficients):
        out += np.outer(block_basis(term, session), c)
    return out


def _without_outliers(residual: np.ndarray) -> tuple[np.ndarray, int]:
    """(n, A) residual with outlying blocks replaced by the running median of nine, and how many
    there were.
    """
    out, count = residual.copy(), 0
    for a in range(residual.shape[1]):
        column = residual[:, a]
        good = np.isfinite(column)
        if good.sum() < _NEAR:
            continue
        middle = median_filter(column[good], _NEAR, mode="nearest")
        off = column[good] - middle
        bad = np.abs(off) > OUTLIER * max(1.4826 * np.median(np.abs(off)), 1e-12)
        out[np.flatnonzero(good)[bad], a] = middle[bad]
        count += int(bad.sum())
    return out, count


def noise_of(regression: Regression, terms: Terms) -> list[Noise]:
    """White, flicker and random walk of each sensor axis, by maximum likelihood over the colour
    grid.

    Steep colours are left out: they stand for causes not found, and the floor is what cannot be
    removed.
    """
    with regression.in_sensor_axes():
        base = regression.fit(terms).base
    block_s = regression.sessions[0].block_s
    out = []
    for a in range(3):
        g = int(np.where(IS_STEEP, -np.inf, base.loglik[a]).argmax())
        white = np.sqrt(base.rss[a, g] / base.count)
        shape = GRID[g]
        out.append(Noise(block_s, white, white * np.sqrt(shape.flicker), white * shape.walk))
    return out


def floor_dps(regression: Regression, terms: Terms) -> np.ndarray:
    """(3,) lowest Allan deviation of each axis' noise within a session's length."""
    longest = max(s.blocks * s.block_s for s in regression.sessions)
    return np.array([n.floor_dps(longest) for n in noise_of(regression, terms)])
