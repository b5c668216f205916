"""Ways to a gyroscope's bias, each a function of the sessions' samples.

A peer takes a sequence of Given, one a power-on, and returns for each the bias (n, 3) in dps that
it would have subtracted from each sample; NaN where it cannot be run (a channel is absent). What
the firmware learned outlives a power-on; the first ten seconds, PyPI's `imufusion` and `vqf` begin
anew at each.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.constants import g as G_MPS2
from zerorate import Corrector

from .recordings import Recording
from .replay.engines import engine
from .replay.replaying import corrector_for
from .replay.samples import frames_in_batches

SECONDS = 10.0
_ROWS = 200_000


@dataclass(frozen=True)
class Given:
    """rate_dps (n, 3); accel_g (n, 3) and temp_degc (n,), None where absent; still (n,) bool.

    `still` is the truth and only for peers that say they are given it.
    """

    recording: Recording
    rate_dps: NDArray[np.float64]
    accel_g: NDArray[np.float64] | None
    temp_degc: NDArray[np.float64] | None
    still: NDArray[np.bool_]

    @property
    def odr_hz(self) -> float:
        return self.recording.scales.odr_hz


Peer = Callable[[Sequence[Given]], list[NDArray[np.float64]]]


def given(recording: Recording, still: NDArray[np.bool_] | None = None) -> Given:
    """A recording in physical units; still: all of it unless said otherwise."""
    scales, rate = recording.scales, recording.gyro_dps()
    accel = recording.accel_g() if scales.accel_lsb_per_g and recording.has_accel else None
    temp = recording.temp_degc() if scales.temp_lsb_per_degc and recording.has_temp else None
    everywhere = np.ones(len(rate), bool)
    return Given(recording, rate, accel, temp, everywhere if still is None else still)


def first_seconds(sessions: Sequence[Given]) -> list[NDArray[np.float64]]:
    """The mean of the first ten seconds, as most small drivers take it; known from the start on."""
    rates = [one.rate_dps for one in sessions]
    means = [r[: round(SECONDS * one.odr_hz)].mean(axis=0) for r, one in zip(rates, sessions)]
    return [np.broadcast_to(mean, r.shape) for mean, r in zip(means, rates)]


def fusion(sessions: Sequence[Given]) -> list[NDArray[np.float64]]:
    """The offset that the stationary detector of imufusion learns."""
    return [_offsets(one) for one in sessions]


def _offsets(one: Given) -> NDArray[np.float64]:
    import imufusion

    settings = imufusion.BiasSettings()
    settings.sample_rate = one.odr_hz
    bias = imufusion.Bias()
    bias.set_settings(settings)
    rates = one.rate_dps
    found = np.empty_like(rates)
    for i in range(len(rates)):
        found[i] = rates[i] - bias.update(rates[i])
    return found


def vqf_default(sessions: Sequence[Given]) -> list[NDArray[np.float64]]:
    """The Kalman bias of vqf, at rest and in motion, with the filter's own settings."""
    return [vqf_biases(one, {}) for one in sessions]


def vqf_biases(one: Given, settings: dict[str, float]) -> NDArray[np.float64]:
    """(n, 3) bias of vqf with these settings, dps; NaN without acceleration."""
    from vqf import VQF

    if one.accel_g is None:
        return np.full(one.rate_dps.shape, np.nan)
    the_filter = VQF(1 / one.odr_hz, **settings)
    rates, forces = np.radians(one.rate_dps), one.accel_g * G_MPS2
    parts = []
    for start in range(0, len(rates), _ROWS):
        end = start + _ROWS
        state = the_filter.updateBatchFullState(
            np.ascontiguousarray(rates[start:end]), np.ascontiguousarray(forces[start:end])
        )
        parts.append(np.degrees(state["bias"]))
    return np.concatenate(parts)


def firmware(**options: object) -> Peer:
    """The peer that runs the firmware with those keywords of zerorate.Corrector.

    What it has learned outlives a power-on as it does on a board with a store.
    """

    def biases(sessions: Sequence[Given]) -> list[NDArray[np.float64]]:
        corrector = corrector_for(sessions[0].recording, dict(options))
        found = []
        for number, one in enumerate(sessions):
            if number:
                corrector.power_on()
            found.append(outcomes_of(corrector, one, "bias_q8")[0])
        return found

    return biases


def outcomes_of(corrector: Corrector, one: Given, *names: str) -> list[NDArray[Any]]:
    """What of its outcomes is named, each (n, 3), those in LSB Q8 in dps."""
    outcomes = list(engine("native").run(corrector, frames_in_batches(one.recording)))
    lsb = 256 * one.recording.scales.gyro_lsb_per_dps
    every = [np.concatenate([getattr(outcome, name) for outcome in outcomes]) for name in names]
    return [of / lsb if name.endswith("_q8") else of for name, of in zip(names, every)]
