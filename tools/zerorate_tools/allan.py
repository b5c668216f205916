"""Allan deviation of a rate, and the floor below which no bias model can go.

IEEE Std 952-1997 Annex C (overlapped form after NIST SP 1065, 5.2.4). White noise falls as
tau^-1/2, flicker is flat (0.664 of the bias instability), a random walk rises as tau^1/2; the
lowest point is the floor.
"""

from dataclasses import dataclass

import numpy as np

_FLICKER_FLAT = 2 * np.log(2) / np.pi


def overlapping(
    rate: np.ndarray, period_s: float, per_octave: int = 4
) -> tuple[np.ndarray, np.ndarray]:
    """Cluster times (k,) in s and Allan deviation (k, A) of an evenly sampled (n, A) rate without
    gaps.

    Raises ValueError for fewer than 9 samples.
    """
    rate = np.asarray(rate, float).reshape(len(rate), -1)
    if len(rate) < 9:
        raise ValueError("an Allan deviation needs 9 samples or more")
    longest = len(rate) // 3
    steps = np.unique(np.geomspace(1, longest, int(per_octave * np.log2(longest))).astype(int))
    angle = np.vstack([np.zeros(rate.shape[1]), np.cumsum(rate - rate.mean(axis=0), axis=0)])
    out = []
    for m in steps:
        second = angle[2 * m :] - 2 * angle[m:-m] + angle[: -2 * m]
        out.append(np.sqrt((second**2).mean(axis=0) / 2) / m)
    return steps * period_s, np.array(out)


@dataclass(frozen=True)
class Noise:
    """Noise of one axis in blocks of `block_s`, each in dps: white and walk are standard deviations
    per block, flicker is that of the white noise which a half-order integrator turns into it.
    """

    block_s: float
    white_dps: float
    flicker_dps: float
    walk_dps: float

    def deviation(self, tau_s: np.ndarray) -> np.ndarray:
        """(k,) Allan deviation in dps that this noise has at cluster times in s."""
        m = np.asarray(tau_s, float) / self.block_s
        flat = _FLICKER_FLAT * self.flicker_dps**2
        return np.sqrt(self.white_dps**2 / m + flat + self.walk_dps**2 * m / 3)

    def floor_dps(self, longest_s: float) -> float:
        """Lowest Allan deviation at cluster times from a block to a third of `longest_s`."""
        tau = np.geomspace(self.block_s, max(longest_s / 3, 2 * self.block_s), 200)
        return float(self.deviation(tau).min())
