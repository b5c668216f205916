"""Steps in the bias: listed with time and size, taken as nuisances, never corrected."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2, gamma

from ..fit.cross_products import gram
from ..fit.likelihood import fit_base, ratios
from .decide import LEVEL

MOST_PER_SESSION = 4
_COARSE = 200  # places tried in a session before the best one's surroundings
_AWAY = 15  # blocks from a step at which a step beside it no longer shows it
_EDGE = 5  # blocks at either end where a step cannot be told from the offset


@dataclass
class Step:
    """A step: session index, first block after it, sizes in dps per axis, and how sure."""

    session: int
    block: int
    size_dps: np.ndarray
    ratio: float
    p_value: float


def strongest(regression, terms) -> Step | None:
    """The step of the largest likelihood ratio in any session, or None where sessions are too
    short.
    """
    best, tried, every = None, 0, []
    for s, session in enumerate(regression.sessions):
        last = session.blocks - _EDGE
        tried += max(0, last + 1 - _EDGE)
        stride = max(1, session.blocks // _COARSE)
        ground = _ground(session)
        at = np.arange(_EDGE, last + 1, stride)
        at = at[ground[at]]
        if not len(at):
            continue
        coarse = _scores(regression, terms, s, at)
        every.append((s, at, coarse))
        middle = at[coarse.argmax()]
        near = np.arange(max(_EDGE, middle - stride), min(last, middle + stride) + 1)
        near = near[ground[near]]
        score = _scores(regression, terms, s, near)
        i = int(score.argmax())
        if best is None or score[i] > best.ratio:
            best = Step(s, int(near[i]), np.zeros(3), float(score[i]), 1.0)
    if best:
        best.p_value = min(1.0, _survival(best, every, regression.y[0].shape[1]) * tried)
    return best


def _ground(session) -> np.ndarray:
    """(n,) bool: where a step may be: in motion a scale factor's error leaps, not the bias."""
    moved = session.moved
    return ~(moved | np.r_[False, moved[:-1]])


def _survival(best: Step, every: list, axes: int) -> float:
    """Chance of a ratio at one place, by the ratios at the places away from each session's largest,
    which may be a step, too.

    On real noise they have a higher mean and a longer tail than chi-squared: a gamma distribution
    of their mean and variance takes its place where that is longer.
    """
    away = [r[np.abs(at - at[r.argmax()]) > _AWAY] for _, at, r in every]
    ratios = np.concatenate(away)
    if len(ratios) < _EDGE:
        return float(chi2.sf(best.ratio, axes))
    mean = max(float(ratios.mean()), axes)
    variance = max(float(ratios.var()), 2 * mean**2 / axes)
    return float(gamma.sf(best.ratio, mean**2 / variance, scale=variance / mean))


def is_event(step: Step | None) -> bool:
    """Whether a step is beyond the level at which one may be listed."""
    return step is not None and step.p_value < LEVEL["step"]


def column(regression, step: Step) -> list[np.ndarray]:
    """(n,) 0 before and 1 after it in its session, 0 in the others."""
    out = [np.zeros(s.blocks) for s in regression.sessions]
    out[step.session][step.block :] = 1.0
    return out


def find_all(regression, terms) -> list[Step]:
    """Every step beside the terms, strongest first; they stay in the regression as nuisances."""
    steps: list[Step] = []
    regression.set_events([])
    while len(steps) < MOST_PER_SESSION * len(regression.sessions):
        step = strongest(regression, terms)
        if step is None or not is_event(step):
            break
        steps.append(step)
        regression.set_events([column(regression, s) for s in steps])
    fit = regression.fit(terms)
    values = np.array([fit.base.coefficients[a, g] for a, g in enumerate(fit.base.best)])
    sizes = np.linalg.solve(regression.axes, values[:, len(terms) :]).T
    for step, size in zip(steps, sizes):
        step.size_dps = size
    return steps


def _scores(regression, terms, s, at, chunk=256):
    w, n = regression.whiteners[s], regression.sessions[s].blocks
    z = regression.stack(terms)
    out = []
    for i in range(0, len(at), chunk):
        heaviside = (np.arange(n)[:, None] >= at[None, i : i + chunk]).astype(float)
        x = [np.zeros((len(v), heaviside.shape[1])) for v in z]
        x[s] = w.prepare(heaviside)
        g = _sparse_gram(regression, z, x, s)
        out.append(
            ratios(
                g,
                fit_base(g, regression.scale, regression.steep),
                regression.scale,
                regression.steep,
            ).sum(axis=1)
        )
    return np.concatenate(out)


def _sparse_gram(regression, z, x, s):
    # Only one session has anything in x: its products alone are worth computing.
    own = gram([regression.whiteners[s]], [regression.y[s]], [z[s]], [x[s]])
    rest = gram(regression.whiteners, regression.y, z)
    rest.xy, rest.xz, rest.xx = (np.zeros((len(z), *v.shape[1:])) for v in (own.xy, own.xz, own.xx))
    rest.xy[s], rest.xz[s], rest.xx[s] = own.xy[0], own.xz[0], own.xx[0]
    return rest
