"""Many devices of one part: what they have in common, and how much they differ."""

# theta_i ~ N(mean, spread) is a device's own coefficients; its recordings tell them with the
# information W_i. Mean and spread by EM (Dempster, Laird, Rubin 1977; for random effects Laird and
# Ware 1982), a device's own by the posterior, which is the shrunken (empirical Bayes) estimate.

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import stats

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
        reach = stats.t.ppf(0.975, max(1, self.used.sum() - 1)) * self.mean_error
        return np.stack([self.mean - reach, self.mean + reach], axis=1)

    def p_mean(self) -> NDArray[np.float64]:
        """(k,) probability of a mean so far from 0 if the part had none."""
        ratio = np.abs(self.mean) / self.mean_error
        return 2 * stats.t.sf(ratio, max(1, self.used.sum() - 1))


def population(information: NDArray, score: NDArray) -> Population:
    """Estimate a part from what n devices say: information (n, k, k), score (n, k).

    A device that lies implausibly far from the others (p < 0.05 corrected for all devices and
    coefficients) is set aside, and mean and spread are estimated anew without it.
    """
    used = _not_far(information, score)
    for _ in range(_ROUNDS):
        mean, spread, error = _em(information[used], score[used])
        p_unusual = _p_unusual(information, score, mean, spread)
        inside = (p_unusual >= 0.05).all(axis=1)
        if (inside == used).all() or inside.sum() < LEAST_DEVICES:
            break
        used = inside
    own_covariance, own = _posterior(information, score, mean, spread)
    return Population(mean, error, spread, own, own_covariance, p_unusual, used)


def _posterior(information, score, mean, spread):
    """Covariance (n, k, k) and mean (n, k) of each device's own coefficients."""
    narrow = np.linalg.inv(spread)
    covariance = np.linalg.inv(information + narrow)
    return covariance, np.einsum("nij,nj->ni", covariance, score + narrow @ mean)


def _em(information, score):
    """Mean, spread between devices and the mean's covariance."""
    n, k = score.shape
    alone = np.linalg.solve(information, score[:, :, None])[:, :, 0]
    spread = np.diag(np.maximum(_robust_deviation(alone) ** 2, 1e-10))
    for _ in range(_MOST_STEPS):
        narrow = np.linalg.inv(spread)
        covariance = np.linalg.inv(information + narrow)
        # inverse of a device's noise and the spread together
        weight = narrow - narrow @ covariance @ narrow
        error = np.linalg.inv(weight.sum(axis=0))
        mean = error @ (narrow @ np.einsum("nij,nj->i", covariance, score))
        own = np.einsum("nij,nj->ni", covariance, score + narrow @ mean) - mean
        update = covariance.mean(axis=0) + own.T @ own / max(1, n - 1)
        change = np.abs(np.diag(update) / np.diag(spread) - 1).max()
        spread = (update + update.T) / 2 + 1e-12 * np.eye(k)
        if change < _SETTLED:
            break
    return mean, spread, error


def _robust_deviation(values: NDArray) -> NDArray:
    return stats.median_abs_deviation(values, axis=0, scale="normal")


def _not_far(information, score):
    """(n,) bool: within eight robust deviations of the median, so that none hides the others."""
    alone = np.linalg.solve(information, score[:, :, None])[:, :, 0]
    noise = np.linalg.inv(information).diagonal(axis1=1, axis2=2)
    reach = _FAR_DEVIATIONS * np.sqrt(_robust_deviation(alone) ** 2 + noise)
    near = (np.abs(alone - np.median(alone, axis=0)) <= reach).all(axis=1)
    return near if near.sum() >= LEAST_DEVICES else np.ones(len(score), bool)


def _p_unusual(information, score, mean, spread):
    noise = np.linalg.inv(information)
    alone = np.einsum("nij,nj->ni", noise, score)
    deviation = np.sqrt((noise + spread).diagonal(axis1=1, axis2=2))
    p = 2 * stats.norm.sf(np.abs(alone - mean) / deviation)
    return np.minimum(1.0, p * p.size)
