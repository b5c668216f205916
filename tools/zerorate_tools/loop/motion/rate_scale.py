"""Scale factor and cross-axis from motion: what the gyroscope adds in proportion to the rate.

Every run (half a minute beside a given reference, or one turn between two rests beside gravity)
gives normal equations of the matrix M, error = M rate, perhaps with nuisances of the reference.
Runs are independent of one another, so their spread says how sure M is, whatever their noise is.
"""

from dataclasses import dataclass

import numpy as np
from scipy.stats import f as fisher

from ..read.reference import Run

#: Low, as turns are not quite independent: all are integrated at one data rate, of one stand.
LEVEL = 1e-6
LEAST_RUNS = 12
#: No part's data sheet says more than this; directions that no turn shows stay near zero.
_PRIOR = 0.05
#: An accelerometer's offset and the error of its scale, both in g.
_OFFSET_G = 0.1
#: Times the median size of a run's error beyond which it is set aside.
_OUTLIER = 6.0
_TRIFLE = 0.1


@dataclass(frozen=True)
class RateScale:
    """What the turns of the training sessions say, and what those held out say of it.

    matrix: (3, 3) dps per dps, what the gyroscope adds; p_value: of no such matrix; kind:
    scale-factor, cross-axis or both; reference: what it was measured against; gains: share of the
    squared error that it removes in each session left out; before, after: RMS error of the runs
    held out, in `unit`; fastest_dps: (3,) up to which it was seen; unseen: (3, 3) bool, entries
    that the motion did not show; level: of p; share: how much of the matrix is deployed.
    """

    matrix: np.ndarray
    deviation: np.ndarray
    p_value: float
    kind: str
    reference: str
    gains: np.ndarray
    before: float
    after: float
    unit: str
    runs: int
    fastest_dps: np.ndarray
    unseen: np.ndarray | None = None
    level: float = LEVEL
    share: float = 1.0

    @property
    def found(self) -> bool:
        """Whether M is significant and every session is better predicted with it."""
        return self.p_value < self.level and bool((self.gains > 0).all())

    @property
    def deployed(self) -> np.ndarray:
        """(3, 3) of the matrix, what is taken out."""
        return self.share * self.matrix

    @property
    def confirmed(self) -> bool:
        """Whether the turns held out, of which there must be some, are better with it."""
        return self.found and bool(np.isfinite(self.after)) and self.after < self.before


def fit_rate_scale(sessions: list[list[Run]], holdout: list[Run], reference: str, unit: str):
    """RateScale of the training sessions' runs, or None where there are too few."""
    sessions = [_without_outliers(runs) for runs in sessions]
    every = [run for runs in sessions for run in runs]
    if len(every) < LEAST_RUNS:
        return None
    x = solved(every)
    covariance = _sandwich(every, x)
    p = _chance(every)
    gains = [_gain(sessions, i) for i, runs in enumerate(sessions) if runs]
    nuisances = solved(every, free=())
    return RateScale(
        x[:9].reshape(3, 3),
        np.sqrt(np.maximum(np.diag(covariance)[:9], 0.0)).reshape(3, 3),
        p,
        _kind(every, x),
        reference,
        np.array(gains),
        _rms(_without_outliers(holdout), nuisances),
        _rms(_without_outliers(holdout), x),
        unit,
        len(every),
        np.max([run.fastest for run in every], axis=0),
    )


_ALL, _SCALES = tuple(range(9)), (0, 4, 8)
_CROSSES = tuple(set(_ALL) - set(_SCALES))


def solved(runs: list[Run], free: tuple[int, ...] = _ALL) -> np.ndarray:
    """(p,) parameters by least squares with the prior; of the nine of M only `free` are not 0."""
    normal, right = _sums(runs)
    at = np.array([*free, *range(9, len(right))], int)
    x = np.zeros(len(right))
    if len(at):
        own = normal + _variance(runs) * np.diag(_prior(len(right)))
        x[at] = np.linalg.lstsq(own[np.ix_(at, at)], right[at], rcond=1e-12)[0]
    return x


def _sums(runs):
    return sum(r.normal for r in runs), sum(r.right for r in runs)


def _prior(parameters):
    """(p,) inverse variances: of M's nine, and of the nuisances, which are offsets in g."""
    return np.where(np.arange(parameters) < 9, _PRIOR**-2, _OFFSET_G**-2)


def _variance(runs):
    """Of one error with all parameters in, by the median run."""
    normal, right = _sums(runs)
    x = np.linalg.lstsq(normal, right, rcond=1e-6)[0]
    free = max(1.0 - len(x) / (2.0 * len(runs)), 0.1)
    return float(np.median([max(r.left(x), 0.0) / r.count for r in runs])) / free


def _sandwich(runs, x):
    """(p, p) covariance of the parameters from the spread of the runs' own scores."""
    normal, _ = _sums(runs)
    bread = np.linalg.pinv(normal + _variance(runs) * np.diag(_prior(len(x))), rcond=1e-12)
    scores = np.array([r.right - r.normal @ x for r in runs])
    many = len(runs) / max(len(runs) - 1, 1)
    return bread @ (scores.T @ scores * many) @ bread


def _chance(runs: list[Run], without: tuple[int, ...] = ()) -> float:
    """p of an F-test over runs, a run worth two errors: of all of the matrix against `without`."""
    bare = sum(r.left(solved(runs, free=without)) for r in runs)
    full = sum(r.left(solved(runs)) for r in runs)
    more, free = 9 - len(without), 2 * len(runs) - len(runs[0].right)
    if free < 1 or full <= 0:
        return 1.0
    return float(fisher.sf(max(bare - full, 0.0) / more / (full / free), more, free))


def _kind(runs, x):
    """By which part of the matrix the rest cannot do without and is no trifle beside the other."""
    size = np.abs(x[:9]).max()
    scale = _chance(runs, _CROSSES) < LEVEL and np.abs(x[list(_SCALES)]).max() > _TRIFLE * size
    cross = _chance(runs, _SCALES) < LEVEL and np.abs(x[list(_CROSSES)]).max() > _TRIFLE * size
    if scale == cross:
        return "scale-factor+cross-axis"
    return "scale-factor" if scale else "cross-axis"


def _gain(sessions, i):
    others = [r for j, runs in enumerate(sessions) if j != i or len(sessions) == 1 for r in runs]
    if len(others) < LEAST_RUNS // 2:
        return 0.0
    without = sum(r.left(solved(others, free=())) for r in sessions[i])
    return 1.0 - sum(r.left(solved(others)) for r in sessions[i]) / max(without, 1e-300)


def _rms(runs, x):
    """Root of the mean squared error of runs; NaN without any."""
    if not runs:
        return float("nan")
    return float(np.sqrt(sum(r.left(x) for r in runs) / sum(r.count for r in runs)))


def _without_outliers(runs: list[Run]) -> list[Run]:
    """Runs whose error is not far beyond the others': a push during a rest, a slipped stand."""
    if len(runs) < LEAST_RUNS:
        return runs
    x = solved(runs)
    size = np.array([np.sqrt(max(r.left(x), 0.0) / max(r.count, 1.0)) for r in runs])
    return [r for r, s in zip(runs, size) if s <= _OUTLIER * np.median(size) + 1e-12]
