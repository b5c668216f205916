"""Attitude filters on BROAD fed by zerorate: the heading error of each, with and without.

Heading error as BROAD defines it: the rotation about the vertical that is left between the filter's
attitude and the optical one, here less its median over the first seconds, as a filter without a
magnetometer begins anywhere. RMS over the motion, in degrees.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import ZerorateError
from .broad import Trial, trials
from .peers import firmware, first_seconds, given
from .real_recordings import data_folder
from .tables import table

Array = NDArray[np.float64]
_G = 9.80665
_BEGIN_S = 5.0
FEEDS = ("as it comes", "less the mean of the first 10 s", "fed by zerorate")
Filter = Callable[[Array, Array, float, bool], Array]


def madgwick(rate: Array, accel: Array, hz: float, corrected: bool) -> Array:
    """PyPI `ahrs`, gain 0.033 as by default."""
    from ahrs.filters import Madgwick

    return Madgwick(gyr=rate, acc=accel, frequency=hz).Q


def mahony(rate: Array, accel: Array, hz: float, corrected: bool) -> Array:
    """PyPI `ahrs`; its own integral learns a bias, and is off where the bias is taken off."""
    from ahrs.filters import Mahony

    # 0 is refused
    return Mahony(gyr=rate, acc=accel, frequency=hz, **({"k_I": 1e-9} if corrected else {})).Q


def vqf(rate: Array, accel: Array, hz: float, corrected: bool) -> Array:
    """PyPI `vqf`; its own bias estimation is off where the bias is taken off."""
    from vqf import VQF

    off = {"motionBiasEstEnabled": False, "restBiasEstEnabled": False} if corrected else {}
    found = VQF(1 / hz, **off).updateBatch(np.ascontiguousarray(rate), np.ascontiguousarray(accel))
    return found["quat6D"]


def fusion(rate: Array, accel: Array, hz: float, corrected: bool) -> Array:
    """PyPI `imufusion`; its own bias estimation runs before it where nothing is taken off."""
    import imufusion

    ahrs, bias, settings = imufusion.Ahrs(), imufusion.Bias(), imufusion.BiasSettings()
    settings.sample_rate = hz
    bias.set_settings(settings)
    ahrs.set_sample_period(1 / hz)
    degrees, found = np.degrees(rate), np.empty((len(rate), 4))
    for i in range(len(rate)):
        ahrs.update_no_magnetometer(degrees[i] if corrected else bias.update(degrees[i]), accel[i])
        found[i] = ahrs.get_quaternion()
    return found


FILTERS: dict[str, Filter] = {
    "Madgwick": madgwick,
    "Mahony": mahony,
    "VQF": vqf,
    "Fusion": fusion,
}


def run(data: Path | None = None, advance: Callable[[float], None] = lambda n: None) -> dict:
    """trial -> filter -> feed -> degrees RMS. Raises ZerorateError without BROAD's folder."""
    folder = data or (data_folder() or Path()) / "broad"
    if not any(folder.glob("*.mat")):
        raise ZerorateError(f"no BROAD trial (.mat) in {folder}; name its folder with --data")
    found = {}
    for trial in trials(folder):
        found[trial.name] = on_trial(trial)
        advance(1)
    return found


def on_trial(trial: Trial) -> dict[str, dict[str, float]]:
    """filter -> feed -> RMS heading error over the motion, degrees."""
    one = given(trial.recording())
    biases = (np.zeros_like(one.rate_dps), first_seconds([one])[0], firmware()([one])[0])
    rows: dict[str, dict[str, float]] = {}
    for name, the_filter in FILTERS.items():
        rows[name] = {}
        for feed, bias in zip(FEEDS, biases):
            rate = np.radians(trial.rate_dps - bias)
            # VQF and Mahony want m/s2, Madgwick normalises, Fusion wants g
            accel = trial.accel_g if name == "Fusion" else trial.accel_g * _G
            attitude = the_filter(rate, accel, trial.hz, feed != FEEDS[0])
            rows[name][feed] = heading_error_deg(attitude, trial)
    return rows


def heading_error_deg(attitude: Array, trial: Trial) -> float:
    """RMS over the motion of what is left about the vertical; attitude: (n, 4) wxyz."""
    from scipy.spatial.transform import Rotation

    seen = np.isfinite(trial.attitude).all(axis=1) & np.isfinite(attitude).all(axis=1)
    order = [1, 2, 3, 0]
    left = (
        Rotation.from_quat(attitude[seen][:, order])
        * Rotation.from_quat(trial.attitude[seen][:, order]).inv()
    ).as_quat()
    heading = np.unwrap(2 * np.arctan2(left[:, 2], left[:, 3]))
    begin = np.median(heading[: round(_BEGIN_S * trial.hz)])
    moving = trial.moving[seen]
    return float(np.degrees(np.sqrt(np.mean(np.square(heading[moving] - begin)))))


def in_markdown(found: dict) -> str:
    """A table: a row a filter and feed, a column a trial, and the mean of the trials."""
    rows = [
        [name, feed, *(f"{found[t][name][feed]:.1f}" for t in found)]
        + [f"{np.mean([found[t][name][feed] for t in found]):.1f}"]
        for name in FILTERS
        for feed in FEEDS
    ]
    heads = ["filter", "rates", *(name.split("_")[0] for name in found), "mean"]
    return table(heads, rows)
