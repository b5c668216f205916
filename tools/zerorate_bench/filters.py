"""Attitude filters on BROAD: the heading error of each with its own bias estimation and without,
fed by zerorate, and fed the true bias.

Heading error: what is left about the vertical between the filter's attitude and the optical one,
less its median over the last seconds before the first motion, as a filter without a magnetometer
begins anywhere. No magnetometer is used. The optics show that this gyroscope's axes lie up to 1.7
degrees off the frame of the optics; so each is also run on rates turned by the matrix that the
optics tell (`broad.true_bias`), where little but the bias and the filter itself is left.
"""

from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from zerorate_tools.demo.broad import Trial, trials, true_bias
from zerorate_tools.peers import firmware, first_seconds, given

from .public_data import data_folder
from .tables import table

Array = NDArray[np.float64]
_G = 9.80665
_BEFORE_S = 2.0
#: A filter's sample is the mean of so many, 95 a second: what fits a board, and a Python loop.
_MEAN_OF = 3
OFF, OWN, FIRST, FED, TRUE = (
    "as they come",
    "as they come, its own estimation on",
    "less the mean of the first 10 s",
    "fed by zerorate",
    "less the true bias, by the optics",
)
FEEDS = (OFF, OWN, FIRST, FED, TRUE)
#: (rate rad/s, acceleration g, hz, own bias estimation on) -> attitude (n, 4) wxyz
Filter = Callable[[Array, Array, float, bool], Array]


def madgwick(rate: Array, accel: Array, hz: float, own: bool) -> Array:
    """PyPI `ahrs`, gain 0.033 as by default; it estimates no bias."""
    from ahrs.filters import Madgwick

    return Madgwick(gyr=rate, acc=accel * _G, frequency=hz).Q


def mahony(rate: Array, accel: Array, hz: float, own: bool) -> Array:
    """PyPI `ahrs`; k_P 0.1 for 1: with that shaking alone turns the heading by tens of degrees."""
    from ahrs.filters import Mahony

    # the integral is its bias; 0 is refused
    return Mahony(gyr=rate, acc=accel * _G, frequency=hz, k_P=0.1, k_I=0.03 if own else 1e-9).Q


def vqf(rate: Array, accel: Array, hz: float, own: bool) -> Array:
    """PyPI `vqf`, as by default."""
    from vqf import VQF

    filter = VQF(1 / hz, motionBiasEstEnabled=own, restBiasEstEnabled=own)
    rate, accel = np.ascontiguousarray(rate), np.ascontiguousarray(accel * _G)
    return filter.updateBatch(rate, accel)["quat6D"]


def fusion(rate: Array, accel: Array, hz: float, own: bool) -> Array:
    """PyPI `imufusion`; gain 0.1 for 0.5, for the reason that Mahony's is lower."""
    import imufusion

    ahrs, bias = imufusion.Ahrs(), imufusion.Bias()
    of_ahrs, of_bias = imufusion.AhrsSettings(), imufusion.BiasSettings()
    of_ahrs.sample_rate = of_bias.sample_rate = hz
    of_ahrs.gain = 0.1
    ahrs.set_settings(of_ahrs)
    bias.set_settings(of_bias)
    degrees, found = np.degrees(rate), np.empty((len(rate), 4))
    for i in range(len(rate)):
        ahrs.update_no_magnetometer(bias.update(degrees[i]) if own else degrees[i], accel[i])
        found[i] = ahrs.get_quaternion()
    return found


FILTERS: dict[str, Filter] = {"Madgwick": madgwick, "Mahony": mahony, "VQF": vqf, "Fusion": fusion}
_NO_BIAS = "Madgwick"
_WITH_GOOD_BIAS = ("VQF", "Fusion")


def run(data: Path | None = None, advance: Callable[[float], None] = lambda n: None) -> dict:
    """trial -> "rates" and "turned rates" -> filter -> feed -> degrees RMS over the motion.

    Raises ZerorateError without BROAD's folder.
    """
    folder = data or (data_folder() or Path()) / "broad"
    found = {}
    for trial in trials(folder):
        found[trial.name] = on_trial(trial)
        advance(1)
    return found


def on_trial(trial: Trial) -> dict[str, dict[str, dict[str, float]]]:
    """As `run`, of one trial."""
    one, truth = given(trial.recording()), true_bias(trial)
    nothing = np.zeros_like(one.rate_dps)
    biases = {
        OFF: nothing,
        OWN: nothing,
        FIRST: first_seconds([one])[0],
        FED: firmware()([one])[0],  # each sample's bias, known with that sample
        TRUE: nothing + truth.bias_dps,
    }
    matrices = {"rates": np.eye(3), "turned rates": truth.matrix}
    return {
        words: {
            name: {
                feed: _one(trial, the_filter, (trial.rate_dps - bias) @ matrix.T, feed == OWN)
                for feed, bias in biases.items()
                if (name, feed) != (_NO_BIAS, OWN)
            }
            for name, the_filter in FILTERS.items()
        }
        for words, matrix in matrices.items()
    }


def _one(trial: Trial, the_filter: Filter, rate_dps: Array, own: bool) -> float:
    rate, accel = np.radians(_means(rate_dps)), _means(trial.accel_g)
    attitude = the_filter(rate, accel, trial.hz / _MEAN_OF, own)
    return heading_error_deg(attitude, trial)


def _means(values: Array) -> Array:
    n = len(values) // _MEAN_OF
    return values[: n * _MEAN_OF].reshape(n, _MEAN_OF, 3).mean(axis=1)


def heading_error_deg(attitude: Array, trial: Trial) -> float:
    """RMS over the motion of what is left about the vertical; attitude: one a mean, wxyz."""
    from scipy.spatial.transform import Rotation

    at = np.arange(len(attitude)) * _MEAN_OF + _MEAN_OF - 1
    optical, moving = trial.attitude[at], trial.moving[at]
    seen = np.isfinite(optical).all(axis=1)
    order = [1, 2, 3, 0]
    left = (
        Rotation.from_quat(attitude[seen][:, order])
        * Rotation.from_quat(optical[seen][:, order]).inv()
    ).as_quat()
    heading = np.full(len(attitude), np.nan)
    heading[seen] = np.unwrap(2 * np.arctan2(left[:, 2], left[:, 3]))
    first = int(moving.argmax())
    before = np.nanmedian(heading[first - round(_BEFORE_S * trial.hz / _MEAN_OF) : first])
    return float(np.degrees(np.sqrt(np.nanmean(np.square(heading[moving] - before)))))


def in_markdown(found: dict) -> str:
    """What the figures say, and both tables: a row a filter and feed, a column a trial."""
    parts = [headline(found)]
    for words in ("rates", "turned rates"):
        rows = [
            [name, feed, *(f"{found[trial][words][name][feed]:.1f}" for trial in found)]
            for name in FILTERS
            for feed in FEEDS
            if (name, feed) != (_NO_BIAS, OWN)
        ]
        heads = ["filter", words, *(name.split("_")[0] for name in found)]
        parts.append(table(heads, rows))
    return "\n\n".join(parts)


def headline(found: dict) -> str:
    """How far a filter fed by zerorate is from the same one fed the true bias, and others."""

    def most(one: str, other: str, names=tuple(FILTERS)) -> float:
        return max(
            rows[name][one] - rows[name][other]
            for trial in found.values()
            for rows in trial.values()
            for name in names
        )

    gains = [
        trial["turned rates"][_NO_BIAS][OFF] - trial["turned rates"][_NO_BIAS][FED]
        for trial in found.values()
    ]
    return (
        f"Fed by zerorate, a filter is at most {most(FED, TRUE):.1f} degrees worse than fed the "
        f"true bias, in any trial. VQF's and Fusion's own estimation is at most "
        f"{most(OWN, FED, _WITH_GOOD_BIAS):.1f} degrees worse than zerorate, and at most "
        f"{most(FED, OWN, _WITH_GOOD_BIAS):.1f} better. Madgwick, which estimates no bias, gains "
        f"{min(gains):+.1f} to {max(gains):+.1f} degrees."
    )
