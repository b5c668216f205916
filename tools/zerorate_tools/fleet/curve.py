"""One device's bias over temperature: a parabola through its still blocks, and how sure it is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

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
        return [t for t, least in zip(TERMS, _LEAST_SPAN_DEGC) if least == 0 or span >= least]

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
    low, high = _span(sessions, warm)
    return Curve(information, score, low, high, len(rates))


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
    told = product / np.maximum((left**2).sum(axis=0), 1e-30)
    alike = np.clip(told + (1 + 3 * told + fitted) / len(left), 0, _MOST_CORRELATION)
    return variance * (1 + alike) / (1 - alike)


def _span(sessions: Sequence[Session], warm: np.ndarray) -> tuple[float, float]:
    if not all("temp" in s.sources for s in sessions):
        return float("nan"), float("nan")
    degc = warm / PER_DEGC + CENTRE_DEGC
    return float(degc.min()), float(degc.max())
