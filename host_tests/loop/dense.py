"""Fits written out with whole covariance matrices in float64, as a textbook has them.

Nothing here uses the loop's own algebra: no transform, no cross products, no profiled axes.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import null_space
from scipy.special import logsumexp
from zerorate_tools.loop.fit.noise import shapes
from zerorate_tools.loop.read.sessions import Session
from zerorate_tools.model.term import Term

SHAPES = shapes()
WHITE = SHAPES[:1]
#: What a grid that allows steep noise takes from it, nats an axis.
PRIOR = np.array([-3.0 if s.slope else 0.0 for s in SHAPES])
#: Of waves over the range of a curve, and of their variance, or of what play operators add.
LENGTHS = (0.05, 0.1, 0.2, 0.4, 0.8)
SIZES = [1e-3, *(10.0**e for e in np.arange(-1, 4.1, 0.5))]
SOURCES = ("a", "b", "c", "d")
A, B, C, D = (Term(name) for name in SOURCES)
#: Of the noise of three sessions, each axis its own.
SCALE = np.array([[0.5, 1.0, 1.0], [1.0, 1.0, 2.0], [2.0, 1.0, 0.5]])


def made(seed, blocks, gap=(), scale=1.0, names=SOURCES):
    """A session whose sources are noise, a block a tick; gap: blocks without a rate."""
    rng = np.random.default_rng(seed)
    sources = {name: np.cumsum(rng.normal(size=blocks)) for name in names}
    rate = scale * rng.normal(size=(blocks, 3))
    rate += np.cumsum(0.2 * scale * rng.normal(size=(blocks, 3)), axis=0)
    weight = np.ones(blocks)
    rate[list(gap)], weight[list(gap)] = np.nan, 0.0
    return Session(f"s{seed}", 20.0, 1, rate, weight, sources)


def white(seed, blocks, **sources):
    """The same, its rates of white noise alone."""
    session = made(seed, blocks)
    session.rate_dps[:] = np.random.default_rng(100 + seed).normal(size=(blocks, 3))
    return replace(session, sources={**session.sources, **sources})


def following(session, source="a", dps=3.0):
    """The session whose bias follows a source."""
    return replace(session, rate_dps=session.rate_dps + dps * session.sources[source][:, None])


def spectrum(shape, blocks):
    """(blocks - 1,) variance at each frequency of the first difference."""
    turn = 2 * np.sin(np.pi * np.arange(1, blocks) / (2 * blocks))
    power = 1 + shape.flicker / turn + (shape.walk / turn) ** 2
    return power + (shape.steep / turn) ** shape.slope if shape.slope else power


def covariance(shape, blocks):
    """(blocks, blocks) of noise of a shape, its mean aside."""
    at, k = np.arange(blocks), np.arange(1, blocks)
    waves = np.sqrt(2 / blocks) * np.cos(np.pi * (at[:, None] + 0.5) * k / blocks)
    return waves * spectrum(shape, blocks) @ waves.T


def contrasts(session):
    """(blocks, those there - 1) orthonormal, of what is there less its mean."""
    there = np.flatnonzero(session.available)
    out = np.zeros((session.blocks, len(there) - 1))
    out[there] = null_space(np.ones((1, len(there))))
    return out


@dataclass
class Problem:
    """Contrasts of all sessions one below the other. v: (shapes, N, N); x: (N, J); y: (N, 3)."""

    v: np.ndarray
    x: np.ndarray
    y: np.ndarray
    rows: list[slice]


def problem(sessions, terms, scale=None, shapes_=SHAPES):
    """The problem of an axis whose sessions have noise of these scales (S,)."""
    scale = np.ones(len(sessions)) if scale is None else scale
    q = [contrasts(s) for s in sessions]
    ends = np.cumsum([0, *(c.shape[1] for c in q)])
    rows = [slice(a, b) for a, b in zip(ends, ends[1:])]
    v = np.zeros((len(shapes_), ends[-1], ends[-1]))
    for s, c, at, size in zip(sessions, q, rows, scale):
        for g, shape in enumerate(shapes_):
            v[g, at, at] = size**2 * c.T @ covariance(shape, s.blocks) @ c
    columns = [np.column_stack([s.sources[t.source] for t in terms]) for s in sessions]
    x = np.vstack([c.T @ u for c, u in zip(q, columns)])
    y = np.vstack([c.T @ np.nan_to_num(s.rate_dps) for c, s in zip(q, sessions)])
    return Problem(v, x, y, rows)


def fitted(p: Problem, axis):
    """(shapes,) log likelihood, (shapes, J) coefficients, (shapes,) squares, (shapes, J, J)."""
    likely, told, squares, inverses = [], [], [], []
    for v, prior in zip(p.v, PRIOR):
        to = np.linalg.inv(v)
        inverse = np.linalg.inv(p.x.T @ to @ p.x)
        b = inverse @ p.x.T @ to @ p.y[:, axis]
        left = p.y[:, axis] - p.x @ b
        rss, n = left @ to @ left, len(left)
        likely.append(prior - 0.5 * n * np.log(rss / n) - 0.5 * np.linalg.slogdet(v)[1])
        told.append(b)
        squares.append(rss)
        inverses.append(inverse)
    return np.array(likely), np.array(told), np.array(squares), np.array(inverses)


def shrunk(p: Problem, groups, sizes, alike=True):
    """(nats, (J, 3)) of weights normal about zero, by the marginal covariance of the rates.

    groups: lists of columns that share a size; sizes: (size, ...) tried, each the variance of what
    a group adds over that of a block's white noise.
    """
    every = sorted(i for g in groups for i in g)
    free = [i for i in range(p.x.shape[1]) if i not in every]
    likely, curves = [], []
    for chosen in sizes:
        variance = np.zeros(p.x.shape[1])
        for group, size in zip(groups, chosen):
            variance[group] = size / span(p, group, free)
        each = [marginal(p, axis, free, every, variance) for axis in range(3)]
        likely.append([one for one, _ in each])
        curves.append([b for _, b in each])
    likely, curves = np.array(likely), np.array(curves)
    if alike:
        likely = np.repeat(likely.sum(axis=1, keepdims=True), 3, axis=1)
    weight = np.exp(likely - likely.max(axis=0))
    mean = (weight[:, :, None] * curves).sum(axis=0) / weight.sum(axis=0)[:, None]
    nats = likely.max(axis=0) + np.log(weight.mean(axis=0)) - likely[0]
    return (nats[0] if alike else nats.sum()), mean.T


def span(p: Problem, group, free):
    """Variance that the columns of a group add to a white block, less what the free ones take."""
    to = np.linalg.inv(p.v[0])  # of white noise
    taken = p.x[:, free] @ np.linalg.pinv(p.x[:, free])
    if free:
        half = np.linalg.cholesky(to).T
        taken = np.linalg.solve(half, (h := half @ p.x[:, free]) @ np.linalg.pinv(h) @ half)
    own = p.x[:, group] - taken @ p.x[:, group]
    return np.einsum("nk,nm,mk->", own, to, own) / len(p.y)


def marginal(p: Problem, axis, free, own, variance):
    """(nats, (J,)) over all colours: the own columns are noise with these variances."""
    likely, told = [], []
    priors = PRIOR if len(p.v) == len(PRIOR) else np.zeros(len(p.v))
    for v, prior in zip(p.v, priors):
        k = v + p.x[:, own] * variance[own] @ p.x[:, own].T
        to, x, y = np.linalg.inv(k), p.x[:, free], p.y[:, axis]
        b = np.linalg.solve(x.T @ to @ x, x.T @ to @ y) if free else np.zeros(0)
        left = y - x @ b
        one = prior - 0.5 * np.linalg.slogdet(k)[1]
        one -= 0.5 * np.linalg.slogdet(x.T @ to @ x)[1] if free else 0.0
        likely.append(one - 0.5 * (len(y) - len(free)) * np.log(left @ to @ left))
        whole = np.zeros(p.x.shape[1])
        whole[free] = b
        whole[own] = variance[own] * (p.x[:, own].T @ to @ left)
        told.append(whole)
    return logsumexp(likely), by_likelihood(likely, told)


def by_likelihood(nats, values):
    """The mean of values by the likelihood of each."""
    weight = np.exp(np.array(nats) - max(nats))
    return np.tensordot(weight / weight.sum(), values, 1)
