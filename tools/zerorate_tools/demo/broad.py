"""Trials of the public BROAD data set and the gyroscope's true bias in each, from the optics.

BROAD, D. Laidig et al., CC BY 4.0. The true bias: over spans of one second the gyroscope less a
bias, through a 3 x 3 matrix (scale, and the alignment of the frames), is integrated and compared
with the optical relative rotation; bias and matrix come from least squares over all spans, those
at rest and those in motion each weighted by what their residuals are.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import CannotFetch, ZerorateError
from ..peers import first_seconds, given, vqf_default
from ..recordings import Recording, Scales
from ..replay import AT_REST_ALONE, replay
from ..runtimes.runtime import cache_folder
from ..simulate.device import counts

Array = NDArray[np.float64]
_G = 9.81
_SCALES = {"gyro_lsb_per_dps": 32.8, "accel_lsb_per_g": 2048.0}
_SPAN_S = 1.0
#: In motion alone: the optics' errors count less in a longer span, but fewer are seen at both ends.
_MOTION_SPAN_S = 4.0
CREDIT = "BROAD, D. Laidig et al., Data 6(7):72, 2021, CC BY 4.0, github.com/dlaidig/broad"
NAME = "02_undisturbed_slow_rotation_B"
COMMIT = "7e2f8189bb4a3ac91eae32c69b6bc87f08a6e2ad"
FOLDER_URL = f"https://raw.githubusercontent.com/dlaidig/broad/{COMMIT}/data_mat/"
SHA256 = "2ab69f86aab5fcc018399068baaabc725bb4b53862aefbef70eaf0256da1930a"
#: Without a byte, and for all of it.
_SILENT_S, _LIMIT_S = 15, 120


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
        return self.part(slice(at[0], at[-1] + 1))

    def part(self, span: slice) -> Trial:
        """Of its samples."""
        fields = ("rate_dps", "accel_g", "attitude", "moving")
        return replace(self, **{name: getattr(self, name)[span] for name in fields})

    def recording(self) -> Recording:
        """The trial in raw LSB at +-1000 dps and +-16 g."""
        t_us = np.round(np.arange(len(self.rate_dps)) * 1e6 / self.hz).astype(np.int64)
        columns = {"t_us": t_us, **counts("g", self.rate_dps * _SCALES["gyro_lsb_per_dps"])}
        columns |= counts("a", self.accel_g * _SCALES["accel_lsb_per_g"])
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
    both, both_sigma, matrix, _ = _solve(trial, starts, moving, n)
    motion, motion_sigma, *_ = _solve(trial, starts[moving], moving[moving], n)
    return TrueBias(both, both_sigma, motion, motion_sigma, matrix)


def bias_in_motion(trial: Trial) -> tuple[Array, Array]:
    """The gyroscope's bias while it moves, by the optical attitude alone, and its one sigma (3,).

    The optics' clock leads the sensor's, by 5.8 ms in BROAD: what a hand turns meanwhile is fitted.
    """
    n, lead_s = round(_MOTION_SPAN_S * trial.hz), 0.0
    for _ in range(3):  # first order: little is left after the nearest sample
        in_time = _led(trial, round(lead_s * trial.hz))
        starts = _seen(in_time, n, n // 2)
        moving = trial.moving[starts] & trial.moving[starts + n]
        starts, moving = starts[moving], moving[moving]
        bias, sigma, _, more_s = _solve(in_time, starts, moving, n, led=True)
        lead_s = round(lead_s * trial.hz) / trial.hz + more_s
    return bias, sigma * np.sqrt(2.0)  # every moment is in two spans


def _led(trial: Trial, samples: int) -> Trial:
    """The trial with its optical attitude so many samples later."""
    attitude = np.roll(trial.attitude, samples, axis=0)
    attitude[: max(samples, 0)] = np.nan
    attitude[len(attitude) + min(samples, 0) :] = np.nan
    return replace(trial, attitude=attitude)


def _seen(trial: Trial, n: int, step: int | None = None) -> NDArray[np.int64]:
    """First samples of the spans at whose ends the optics saw the device."""
    starts = np.arange(0, len(trial.rate_dps) - n - 1, step or n)
    seen = np.asarray(np.isfinite(trial.attitude).all(axis=1))
    return starts[seen[starts] & seen[starts + n]]


def _solve(
    trial: Trial, starts: NDArray[np.int64], moving: NDArray[np.bool_], n: int, led: bool = False
) -> tuple[Array, Array, Array, float]:
    """Bias, its one sigma, the matrix, and where `led` the seconds by which the optics lead."""
    unknowns = 13 if led else 12
    bias, matrix = np.zeros(3), np.eye(3)
    weight = np.ones(len(starts))
    for _ in range(6):
        residual, slopes = _compare(trial, starts, n, bias, matrix)
        rows = np.sqrt(weight)[:, None, None]
        slopes = slopes[..., :unknowns]
        a, y = (slopes * rows).reshape(-1, unknowns), (residual * rows[..., 0]).reshape(-1)
        step, *_ = np.linalg.lstsq(a, y, rcond=None)
        bias, matrix = bias + step[:3], matrix + step[3:12].reshape(3, 3)
        left = residual - slopes @ step
        for group in (moving, ~moving):
            if group.any():
                # the median holds off spans in which the optics slipped
                weight[group] = 1 / np.median(np.square(left[group]))
        size = np.abs(left).max(axis=1) * np.sqrt(weight)
        weight = np.where(size < 8, weight, weight * 1e-6)
    covariance = np.linalg.pinv(a.T @ a) * np.square(a @ step - y).mean()
    return bias, np.sqrt(np.diag(covariance)[:3]), matrix, float(step[-1]) if led else 0.0


def _compare(
    trial: Trial, starts: NDArray[np.int64], n: int, bias: Array, matrix: Array
) -> tuple[Array, Array]:
    """Each span's optical rotation beyond the integrated one, rad, and its slopes."""
    from scipy.spatial.transform import Rotation

    dt = 1 / trial.hz
    attitude = Rotation.identity(len(starts))
    slopes = np.zeros((len(starts), 3, 13))
    for k in range(n):
        rate = np.radians(trial.rate_dps[starts + k] - bias)
        turned = attitude.as_matrix()
        slopes[:, :, :3] -= turned @ matrix * np.radians(dt)
        slopes[:, :, 3:12] += np.einsum("nij,nk->nijk", turned, rate * dt).reshape(-1, 3, 9)
        attitude = attitude * Rotation.from_rotvec(rate @ matrix.T * dt)
    ends = [Rotation.from_quat(trial.attitude[at][:, [1, 2, 3, 0]]) for at in (starts, starts + n)]
    first, last = (np.radians(trial.rate_dps[at] - bias) @ matrix.T for at in (starts, starts + n))
    slopes[:, :, 12] = attitude.apply(last) - first
    return (ends[0].inv() * ends[1] * attitude.inv()).as_rotvec(), slopes


def broad_trial(folder_url: str | None = None) -> Trial:
    """The trial, fetched into the cache where it is not there yet (3.6 MB). Raises CannotFetch.

    folder_url: a mirror's folder instead of FOLDER_URL.
    """
    path = _fetched(folder_url or FOLDER_URL)
    return next(trial for trial in trials(path.parent) if trial.name == NAME)


def kept_in() -> Path:
    return cache_folder() / "broad"


def _fetched(folder_url: str) -> Path:
    import pooch

    pooch.get_logger().setLevel("WARNING")
    file = f"{NAME}.mat"
    try:
        path = pooch.retrieve(
            folder_url + file,
            known_hash=f"sha256:{SHA256}",
            fname=file,
            path=kept_in(),
            downloader=_downloaded,
        )
    except OSError as error:  # of requests, too: its errors are OSErrors
        do = f"try again with a network, or put that file into {kept_in()}"
        raise CannotFetch(
            f"{folder_url}{file} cannot be fetched, is there a network? {do}"
        ) from error
    except ValueError as error:
        raise CannotFetch(f"{folder_url}{file} is not the file with SHA-256 {SHA256}") from error
    return Path(path)


def _downloaded(url: str, output_file: str, pooch: object) -> None:
    """A downloader of pooch that gives up on a network that brings next to nothing."""
    import requests

    until = time.monotonic() + _LIMIT_S
    answer = requests.get(url, timeout=_SILENT_S, stream=True)  # type: ignore[no-untyped-call]
    with answer, open(output_file, "wb") as out:
        answer.raise_for_status()
        for chunk in answer.iter_content(65_536):
            out.write(chunk)
            if time.monotonic() > until:
                raise TimeoutError


WAYS = (
    "uncorrected",
    "mean of the first ten seconds",
    "vqf",
    "zerorate, from rests",
    "zerorate, in motion and by gravity too",
)
WHOLE_FROM_S, MOTION_FROM_S = 10.0, 60.0


@dataclass(frozen=True)
class Real:
    """A real trial: whole_mdps, motion_mdps: way -> RMS error over axes and time, mdps.

    whole: the trial with the rests at its ends, from 10 s on; motion: as if switched on in
    mid-motion, without any rest, from 60 s on. said: the firmware's own words after the whole
    trial, every source on.
    """

    trial: Trial
    truth: TrueBias
    whole_mdps: dict[str, float]
    motion_mdps: dict[str, float]
    said: str


def real(
    trial: Trial, runtime: str = "wasm", advance: Callable[[float], None] = lambda n: None
) -> Real:
    """Run the firmware over `trial` on `runtime` and score it. Raises MissingRuntime.

    advance: called with 1 after each of the four runs. vqf is left out where it is not installed.
    """
    truth = true_bias(trial)
    rows, said = [], ""
    for part, start_s in ((trial, WHOLE_FROM_S), (trial.in_motion(), MOTION_FROM_S)):
        recording = part.recording()
        session = [given(recording)]
        mean = first_seconds(session)[0]
        biases = {WAYS[0]: np.zeros_like(mean), WAYS[1]: mean}
        if find_spec("vqf") is not None:
            biases["vqf"] = vqf_default(session)[0]
        for way, options in zip(WAYS[3:], (AT_REST_ALONE, {})):
            done = replay(recording, runtime=runtime, options=options)
            biases[way] = _biases(done.table, recording)
            advance(1)
        said = said or done.explanation
        first = round(start_s * trial.hz)
        rows.append({way: rms_mdps(bias[first:] - truth.bias_dps) for way, bias in biases.items()})
    return Real(trial, truth, rows[0], rows[1], said)


def _biases(table: Any, recording: Recording) -> NDArray[np.float64]:
    lsb = recording.scales.gyro_lsb_per_dps
    return np.stack([table[f"bias_g{axis}"].to_numpy() for axis in "xyz"], axis=1) / lsb
