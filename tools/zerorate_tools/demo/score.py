"""The error of a bias: none, the mean of the first ten seconds, and the firmware's."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import BadRecording
from ..recordings import Recording

SETTLE_S = 10.0
_BLOCK_S = 20.0


@dataclass(frozen=True)
class Score:
    """Root mean square errors over three axes in mdps, and the angle lost by the end in degrees.

    All are counted from SETTLE_S on, which the ten-second mean needs. Against a known truth every
    sample counts; of a recording at rest the means of blocks of 20 s, where the noise is averaged.
    """

    uncorrected_mdps: float
    first_ten_s_mdps: float
    firmware_mdps: float
    uncorrected_deg: float
    first_ten_s_deg: float
    firmware_deg: float
    truth: str


def score(
    recording: Recording, bias_dps: NDArray[np.float64], truth_dps: NDArray[np.float64] | None
) -> Score:
    """Score `bias_dps` (n, 3) against the true bias, or against a true rate of zero.

    Raises BadRecording where nothing is left after SETTLE_S.
    """
    t_s = seconds(recording)
    if t_s[-1] < SETTLE_S:
        problem = f"{t_s[-1]:.1f} s are too short: errors count from {SETTLE_S:.0f} s on"
        raise BadRecording(recording.name, problem, do="record a minute at rest, or longer")
    rate_dps = recording.gyro_dps()
    first = rate_dps[t_s < SETTLE_S].mean(axis=0)
    later = t_s >= SETTLE_S
    target = rate_dps if truth_dps is None else truth_dps
    errors = [target[later], target[later] - first, (target - bias_dps)[later]]
    if truth_dps is None:
        rms = [_rms(block_means(t_s[later], error)) for error in errors]
    else:
        rms = [_rms(error) for error in errors]
    steps = np.diff(t_s[later], append=t_s[-1])
    lost = [float(np.abs((error * steps[:, None]).sum(axis=0)).max()) for error in errors]
    truth = "the device rests, its rate is zero" if truth_dps is None else "the simulated bias"
    mdps = [1e3 * value for value in rms]
    return Score(mdps[0], mdps[1], mdps[2], lost[0], lost[1], lost[2], truth)


def seconds(recording: Recording) -> NDArray[np.float64]:
    """Seconds since the first sample, (n,)."""
    t_us = recording.columns["t_us"]
    return (t_us - t_us[0]) * 1e-6


def block_means(t_s: NDArray[np.float64], values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Means of `values` (n, k) over blocks of 20 s, (blocks, k)."""
    block = ((t_s - t_s[0]) // _BLOCK_S).astype(np.int64)
    count = np.bincount(block)
    sums = [np.bincount(block, values[:, k]) for k in range(values.shape[1])]
    return (np.stack(sums, axis=1) / np.maximum(count, 1)[:, None])[count > 0]


def _rms(values: NDArray[np.float64]) -> float:
    return float(np.sqrt(np.mean(np.square(values))))
