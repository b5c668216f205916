"""Trials of the public BROAD data set and the gyroscope's true bias in each, from the optics.

BROAD, D. Laidig et al., CC BY 4.0. The true bias: over spans of one second the gyroscope less a
bias, through a 3 x 3 matrix (scale, and the alignment of the frames), is integrated and compared
with the optical relative rotation; bias and matrix come from least squares over all spans, those
at rest and those in motion each weighted by what their residuals are.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import ZerorateError
from ..recordings import Recording, Scales

Array = NDArray[np.float64]
_G = 9.81
_SCALES = {"gyro_lsb_per_dps": 32.8, "accel_lsb_per_g": 2048.0}
_SPAN_S = 1.0


@dataclass(frozen=True)
class Trial:
    """rate_dps, accel_g (n, 3); attitude (n, 4) wxyz, NaN where not seen; moving (n,) bool."""

    name: str
    hz: float
    rate_dps: Array
    accel_g: Array
    attitude: Array
    moving: NDArray[np.bool_]

    def in_motion(self) -> Trial:
        """The trial from the first to the last moving sample."""
        at = np.flatnonzero(self.moving)
        part = slice(at[0], at[-1] + 1)
        return replace(
            self,
            rate_dps=self.rate_dps[part],
            accel_g=self.accel_g[part],
            attitude=self.attitude[part],
            moving=self.moving[part],
        )

    def recording(self) -> Recording:
        """The trial in raw LSB at +-1000 dps and +-16 g."""
        t_us = np.round(np.arange(len(self.rate_dps)) * 1e6 / self.hz).astype(np.int64)
        columns = {"t_us": t_us}
        for letter, values, scale in (
            ("g", self.rate_dps, _SCALES["gyro_lsb_per_dps"]),
            ("a", self.accel_g, _SCALES["accel_lsb_per_g"]),
        ):
            words = np.clip(np.round(values * scale), -32768, 32767).astype(np.int64)
            columns.update({letter + axis: words[:, i] for i, axis in enumerate("xyz")})
        named: dict[str, Any] = {**_SCALES, "temp_lsb_per_degc": 0, "temp_offset_degc": 0}
        scales = Scales("aktos-t", self.hz, **named)
        return Recording(columns, scales, self.name)


def trials(folder: Path) -> Iterator[Trial]:
    """Every trial of a folder of BROAD's .mat files, by name. Raises ZerorateError without one."""
    from scipy.io import loadmat

    paths = sorted(folder.glob("*.mat"))
    if not paths:
        raise ZerorateError(f"no BROAD trial (.mat) in {folder}; name its folder with --data")
    for path in paths:
        m = loadmat(path, squeeze_me=True)
        yield Trial(
            path.stem,
            float(m["sampling_rate"]),
            np.degrees(m["imu_gyr"]),
            m["imu_acc"] / _G,
            m["opt_quat"],
            m["movement"].astype(bool),
        )


@dataclass(frozen=True)
class TrueBias:
    """bias_dps and its one sigma (3,); the same from the spans in motion alone; the matrix."""

    bias_dps: Array
    sigma_dps: Array
    motion_dps: Array
    motion_sigma_dps: Array
    matrix: Array


def rms_mdps(error_dps: NDArray[np.float64]) -> float:
    """Root of the mean square over samples and axes, mdps."""
    return float(np.sqrt(np.mean(np.square(error_dps))) * 1000)


def true_bias(trial: Trial) -> TrueBias:
    """The gyroscope's bias by the optical attitude."""
    n = round(_SPAN_S * trial.hz)
    starts = _seen(trial, n)
    moving = trial.moving[starts[:, None] + np.arange(n)].any(axis=1)
    both, both_sigma, matrix = _solve(trial, starts, moving, n)
    motion, motion_sigma, _ = _solve(trial, starts[moving], moving[moving], n)
    return TrueBias(both, both_sigma, motion, motion_sigma, matrix)


def _seen(trial: Trial, n: int) -> NDArray[np.int64]:
    """First samples of the spans at whose ends the optics saw the device."""
    starts = np.arange(0, len(trial.rate_dps) - n - 1, n)
    seen = np.asarray(np.isfinite(trial.attitude).all(axis=1))
    return starts[seen[starts] & seen[starts + n]]


def _solve(
    trial: Trial, starts: NDArray[np.int64], moving: NDArray[np.bool_], n: int
) -> tuple[Array, Array, Array]:
    bias, matrix = np.zeros(3), np.eye(3)
    weight = np.ones(len(starts))
    for _ in range(6):
        residual, slopes = _compare(trial, starts, n, bias, matrix)
        rows = np.sqrt(weight)[:, None, None]
        a, y = (slopes * rows).reshape(-1, 12), (residual * rows[..., 0]).reshape(-1)
        step, *_ = np.linalg.lstsq(a, y, rcond=None)
        bias, matrix = bias + step[:3], matrix + step[3:].reshape(3, 3)
        left = residual - slopes @ step
        for group in (moving, ~moving):
            if group.any():
                # the median holds off spans in which the optics slipped
                weight[group] = 1 / np.median(np.square(left[group]))
        size = np.abs(left).max(axis=1) * np.sqrt(weight)
        weight = np.where(size < 8, weight, weight * 1e-6)
    covariance = np.linalg.pinv(a.T @ a) * np.square(a @ step - y).mean()
    return bias, np.sqrt(np.diag(covariance)[:3]), matrix


def _compare(
    trial: Trial, starts: NDArray[np.int64], n: int, bias: Array, matrix: Array
) -> tuple[Array, Array]:
    """Each span's optical rotation beyond the integrated one, rad, and its slopes."""
    from scipy.spatial.transform import Rotation

    dt = 1 / trial.hz
    attitude = Rotation.from_quat(np.zeros((len(starts), 4)) + [0, 0, 0, 1])
    slopes = np.zeros((len(starts), 3, 12))
    for k in range(n):
        rate = np.radians(trial.rate_dps[starts + k] - bias)
        turned = attitude.as_matrix()
        slopes[:, :, :3] -= turned @ matrix * np.radians(dt)
        slopes[:, :, 3:] += np.einsum("nij,nk->nijk", turned, rate * dt).reshape(-1, 3, 9)
        attitude = attitude * Rotation.from_rotvec(rate @ matrix.T * dt)
    ends = [Rotation.from_quat(trial.attitude[at][:, [1, 2, 3, 0]]) for at in (starts, starts + n)]
    return (ends[0].inv() * ends[1] * attitude.inv()).as_rotvec(), slopes
