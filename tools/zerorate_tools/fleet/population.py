"""Statistics of a fleet: a device's bias over temperature, and what many devices have in common."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

# theta_i ~ N(mean, spread) is a device's own coefficients; its recordings tell them with the
# information W_i. Mean and spread by EM (Dempster, Laird, Rubin 1977; for random effects Laird and
# Ware 1982), a device's own by the posterior, which is the shrunken (empirical Bayes) estimate.
from scipy import stats

from ..loop.read.sessions import Session

#: Coefficients belong to 1, u and u^2, where u is the temperature less this, in tens of degC.
CENTRE_DEGC = 25.0
PER_DEGC = 0.1
TERMS = ("level", "slope", "curvature")
UNITS = ("dps", "dps/degC", "dps/degC^2")

_LEAST_SPAN_DEGC = (0.0, 2.0, 8.0)
_LEAST_NOISE_DPS = 1e-4
_MOST_CORRELATION = 0.98
# of a block: what no block says stays all but unknown
_RIDGE = 1e-10


@dataclass(frozen=True)
class Curve:
    """What a device's recordings say of its coefficients, per axis.

    information: (3 axes, 3, 3) inverse of the estimate's covariance; score: (3, 3) information
    times estimate; so a coefficient of which nothing is known takes no special case. low_degc,
    high_degc: temperatures seen, NaN without a thermometer.
    """

    information: NDArray[np.float64]
    score: NDArray[np.float64]
    low_degc: float
    high_degc: float
    blocks: int

    @property
    def shown(self) -> list[str]:
        """The terms that this span of temperature shows."""
        span = self.high_degc - self.low_degc
        return [t for t, least in zip(TERMS, _LEAST_SPAN_DEGC) if np.nan_to_num(span) >= least]

    def to_json(self) -> dict[str, Any]:
        seen = None if np.isnan(self.low_degc) else [self.low_degc, self.high_degc]
        return {
            "information": self.information.tolist(),
            "score": self.score.tolist(),
            "degc": seen,
            "blocks": self.blocks,
        }

    @classmethod
    def from_json(cls, values: dict[str, Any]) -> Curve:
        low, high = values["degc"] or (np.nan, np.nan)
        information, score = np.array(values["information"]), np.array(values["score"])
        return cls(information, score, low, high, values["blocks"])


def curve_of(sessions: Sequence[Session]) -> Curve | None:
    """Fit the still blocks of a device's power-ons; None where there are too few.

    Each power-on has an offset of its own, and the level is their mean. Noise is what the parabola
    leaves, widened by how much neighbouring blocks resemble each other.
    """
    rates, warm, power_on = _stacked(sessions)
    number = len(sessions)
    if len(rates) < number + 4:
        return None
    basis = np.column_stack([np.eye(number)[power_on], warm, warm**2])
    inverse = np.linalg.inv(basis.T @ basis + _RIDGE * len(rates) * np.eye(number + 2))
    fitted = inverse @ basis.T @ rates
    variance = _variance(rates - basis @ fitted, power_on, number + 2)
    means = np.zeros((3, number + 2))
    means[0, :number], means[1, -2], means[2, -1] = 1 / number, 1, 1
    covariance = variance[:, None, None] * (means @ inverse @ means.T)
    if number > 1:
        covariance[:, 0, 0] += fitted[:number].var(axis=0, ddof=1) / number
    information = np.linalg.inv(covariance)
    score = np.einsum("aij,ja->ai", information, means @ fitted)
    degc = warm / PER_DEGC + CENTRE_DEGC
    warmed = all("temp" in s.sources for s in sessions)
    low, high = (degc.min(), degc.max()) if warmed else (np.nan, np.nan)
    return Curve(information, score, float(low), float(high), len(rates))


def _stacked(sessions: Sequence[Session]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(n, 3) rates in dps, (n,) scaled temperature, 0 without one, and (n,) number of power-on."""
    rates, warm, power_on = [], [], []
    for number, session in enumerate(sessions):
        there = session.available
        rates.append(session.rate_dps[there])
        temp = session.sources.get("temp")
        degc = session.block_mean(temp)[there] if temp is not None else np.nan
        warm.append(np.nan_to_num((degc - CENTRE_DEGC) * PER_DEGC) * np.ones(int(there.sum())))
        power_on.append(np.full(int(there.sum()), number))
    return np.concatenate(rates), np.concatenate(warm), np.concatenate(power_on)


def _variance(left: np.ndarray, power_on: np.ndarray, fitted: int) -> np.ndarray:
    """(3,) variance of a block that counts as independent of its neighbours.

    The correlation of neighbours is what a fit leaves of it, which is too little by about
    (1 + 3 r + coefficients) / n (Marriott and Pope 1954, Kendall 1954), so that is added.
    """
    variance = np.maximum((left**2).sum(axis=0) / (len(left) - fitted), _LEAST_NOISE_DPS**2)
    neighbours = power_on[1:] == power_on[:-1]
    product = (left[1:] * left[:-1])[neighbours].sum(axis=0)
    correlation = product / np.maximum((left**2).sum(axis=0), 1e-30)
    alike = np.clip(correlation + (1 + 3 * correlation + fitted) / len(left), 0, _MOST_CORRELATION)
    return variance * (1 + alike) / (1 - alike)


_MOST_STEPS = 500
_SETTLED = 1e-5
_ROUNDS = 5
_FAR_DEVIATIONS = 8.0
LEAST_DEVICES = 5


@dataclass(frozen=True)
class Population:
    """One axis of a part, over k coefficients.

    mean: (k,); mean_covariance: (k, k) of that estimate; spread: (k, k) covariance between
    devices; own: (n, k) shrunken coefficients and own_covariance: (n, k, k); p_unusual: (n, k)
    probability of lying so far from the others, corrected for their number; used: (n,) bool,
    devices that mean and spread are from.
    """

    mean: NDArray[np.float64]
    mean_covariance: NDArray[np.float64]
    spread: NDArray[np.float64]
    own: NDArray[np.float64]
    own_covariance: NDArray[np.float64]
    p_unusual: NDArray[np.float64]
    used: NDArray[np.bool_]

    @property
    def deviation(self) -> NDArray[np.float64]:
        """(k,) standard deviation between devices."""
        return np.sqrt(np.diag(self.spread))

    @property
    def mean_error(self) -> NDArray[np.float64]:
        """(k,) standard error of the mean."""
        return np.sqrt(np.diag(self.mean_covariance))

    def interval(self) -> NDArray[np.float64]:
        """(k, 2) 95 % interval of the mean, by Student's t with the devices less one."""
        reach = stats.t.ppf(0.975, self.used.sum() - 1) * self.mean_error
        return np.stack([self.mean - reach, self.mean + reach], axis=1)

    def p_mean(self) -> NDArray[np.float64]:
        """(k,) probability of a mean so far from 0 if the part had none."""
        ratio = np.abs(self.mean) / self.mean_error
        return 2 * stats.t.sf(ratio, self.used.sum() - 1)


def population(information: NDArray[Any], score: NDArray[Any]) -> Population:
    """Estimate a part from what n devices say: information (n, k, k), score (n, k).

    A device that lies implausibly far from the others (p < 0.05 corrected for all devices and
    coefficients) is set aside, and mean and spread are estimated anew without it.
    """
    used = _not_far(information, score)
    for _ in range(_ROUNDS):
        mean, spread, error = _em(information[used], score[used])
        p_unusual = _p_unusual(information, score, mean, spread)
        inside = np.asarray((p_unusual >= 0.05).all(axis=1))
        if (inside == used).all() or inside.sum() < LEAST_DEVICES:
            break
        used = inside
    own_covariance, own = _posterior(information, score, mean, spread)
    return Population(mean, error, spread, own, own_covariance, p_unusual, used)


def _posterior(
    information: NDArray[Any], score: NDArray[Any], mean: NDArray[Any], spread: NDArray[Any]
) -> tuple[NDArray[Any], NDArray[Any]]:
    """Covariance (n, k, k) and mean (n, k) of each device's own coefficients."""
    narrow = np.linalg.inv(spread)
    covariance = np.linalg.inv(information + narrow)
    return covariance, np.einsum("nij,nj->ni", covariance, score + narrow @ mean)


def _em(
    information: NDArray[Any], score: NDArray[Any]
) -> tuple[NDArray[Any], NDArray[Any], NDArray[Any]]:
    """Mean, spread between devices and the mean's covariance."""
    n, k = score.shape
    alone = np.linalg.solve(information, score[:, :, None])[:, :, 0]
    spread = np.diag(np.maximum(_robust_deviation(alone) ** 2, 1e-10))
    for _ in range(_MOST_STEPS):
        narrow = np.linalg.inv(spread)
        covariance = np.linalg.inv(information + narrow)
        # inverse of a device's noise and the spread together
        weight = information @ covariance @ narrow
        error = np.linalg.inv(weight.sum(axis=0))
        mean = error @ (narrow @ np.einsum("nij,nj->i", covariance, score))
        own = np.einsum("nij,nj->ni", covariance, score + narrow @ mean) - mean
        update = covariance.mean(axis=0) + own.T @ own / (n - 1)
        change = np.abs(np.diag(update) / np.diag(spread) - 1).max()
        spread = (update + update.T) / 2 + 1e-12 * np.eye(k)
        if change < _SETTLED:
            break
    return mean, spread, error


def _robust_deviation(values: NDArray[Any]) -> NDArray[Any]:
    return stats.median_abs_deviation(values, axis=0, scale="normal")


def _not_far(information: NDArray[Any], score: NDArray[Any]) -> NDArray[Any]:
    """(n,) bool: within eight robust deviations of the median, so that none hides the others."""
    alone = np.linalg.solve(information, score[:, :, None])[:, :, 0]
    noise = np.linalg.inv(information).diagonal(axis1=1, axis2=2)
    reach = _FAR_DEVIATIONS * np.sqrt(_robust_deviation(alone) ** 2 + noise)
    near = (np.abs(alone - np.median(alone, axis=0)) <= reach).all(axis=1)
    return near if near.sum() >= LEAST_DEVICES else np.ones(len(score), bool)


def _p_unusual(
    information: NDArray[Any], score: NDArray[Any], mean: NDArray[Any], spread: NDArray[Any]
) -> NDArray[Any]:
    noise = np.linalg.inv(information)
    alone = np.einsum("nij,nj->ni", noise, score)
    deviation = np.sqrt((noise + spread).diagonal(axis1=1, axis2=2))
    p = 2 * stats.norm.sf(np.abs(alone - mean) / deviation)
    return np.minimum(1.0, p * p.size)
