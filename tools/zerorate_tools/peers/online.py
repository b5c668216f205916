"""Ways that begin anew at each power-on: the first ten seconds, PyPI's `imufusion` and `vqf`.

Each returns the sessions' biases (n, 3) in dps as they come; nothing outlives a power-on.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from zerorate import Corrector
from zerorate.effects.model_file import LOADED, REASONS
from zerorate.model import EffectModel

from ..errors import ZerorateError
from ..model import Model, encoded
from ..recordings import Recording
from ..replay.engines import engine
from ..replay.replaying import corrector_for
from ..replay.samples import frames_in_batches

SECONDS = 10.0
_G = 9.80665
_ROWS = 200_000
RAISED = {"biasClip": 25.0, "biasSigmaInit": 8.0}


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


def first_seconds(sessions: Sequence[Given]) -> list[NDArray[np.float64]]:
    """The mean of the first ten seconds, as most small drivers take it; known from the start on."""
    return [np.broadcast_to(_mean(one), one.rate_dps.shape) for one in sessions]


def _mean(one: Given) -> NDArray[np.float64]:
    samples = max(1, round(SECONDS * one.odr_hz))
    return one.rate_dps[:samples].mean(axis=0)


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
    return [_biases(one, {}) for one in sessions]


def vqf_clip_raised(sessions: Sequence[Given]) -> list[NDArray[np.float64]]:
    """The same with clip 25 dps and initial sigma 8 dps."""
    return [_biases(one, RAISED) for one in sessions]


def _biases(one: Given, settings: dict[str, float]) -> NDArray[np.float64]:
    from vqf import VQF

    if one.accel_g is None:
        return np.full(one.rate_dps.shape, np.nan)
    the_filter = VQF(1 / one.odr_hz, **settings)
    rates, forces = np.radians(one.rate_dps), one.accel_g * _G
    parts = []
    for start in range(0, len(rates), _ROWS):
        end = start + _ROWS
        state = the_filter.updateBatchFullState(
            np.ascontiguousarray(rates[start:end]), np.ascontiguousarray(forces[start:end])
        )
        parts.append(np.degrees(state["bias"]))
    return np.concatenate(parts)


def given(recording: Recording, still: NDArray[np.bool_] | None = None) -> Given:
    """A recording in physical units; still: all of it unless said otherwise."""
    scales, rate = recording.scales, recording.gyro_dps()
    accel = recording.accel_g() if scales.accel_lsb_per_g and recording.has_accel else None
    temp = recording.temp_degc() if scales.temp_lsb_per_degc and recording.has_temp else None
    everywhere = np.ones(len(rate), bool)
    return Given(recording, rate, accel, temp, everywhere if still is None else still)


_STRETCH_S = 10.0


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
            found.append(_run(corrector, one, "bias_q8")[0])
        return found

    return biases


class Decision:
    """As `firmware`, one power-on a session; options: keywords of zerorate.Corrector.

    model: the effects that are taken out first; the bias is what is left of the rate then.
    After a call `within` holds, for each axis at the end of every stretch of ten seconds in which
    it had a bias, whether the truth given in `truth_dps` lay within two sigma.
    """

    def __init__(self, model: Model | None = None, **options: object) -> None:
        self.model, self.options = model, options
        self.truth_dps: Sequence[NDArray[np.float64]] | None = None
        self.within: list[bool] = []

    def __call__(self, sessions: Sequence[Given]) -> list[NDArray[np.float64]]:
        """Run every session from nothing."""
        self.within = []
        return [self._biases(number, one) for number, one in enumerate(sessions)]

    def states(self, one: Given) -> list[NDArray[Any]]:
        """Bias and its one sigma, dps, and the source, each (n, 3), from nothing.

        Raises ZerorateError for a model that the firmware refuses.
        """
        corrector = corrector_for(one.recording, dict(self.options))
        if self.model is not None:
            effects = EffectModel()
            reason = effects.load(encoded(self.model), corrector.sensor)
            if reason != LOADED:
                raise ZerorateError(f"the firmware refuses the model: {REASONS[reason]}")
            corrector.use_model(effects)
        return _run(corrector, one, "bias_q8", "quality_q8", "source")

    def _biases(self, number: int, one: Given) -> NDArray[np.float64]:
        bias, sigma, source = self.states(one)
        if self.truth_dps is not None:
            known = source > 0
            inside = np.abs(bias - self.truth_dps[number]) < 2 * sigma
            ends = slice(round(_STRETCH_S * one.odr_hz) - 1, None, round(_STRETCH_S * one.odr_hz))
            self.within += inside[ends][known[ends]].tolist()
        return bias


def within_two_sigma(
    sessions: Sequence[Given], truth_dps: NDArray[np.float64], first_s: float
) -> tuple[float, float]:
    """Shares of the last session's axes and samples whose truth lies within two sigma.

    Of all in which there was a bias, and of those of the first `first_s` seconds.
    """
    corrector = corrector_for(sessions[0].recording, {})
    for one in sessions:
        corrector.power_on()
        bias, sigma, source = _run(corrector, one, "bias_q8", "quality_q8", "source")
    inside = np.where(source > 0, np.abs(bias - truth_dps) < 2 * sigma, np.nan)
    first = inside[: round(first_s * sessions[-1].odr_hz)]
    return float(np.nanmean(inside)), float(np.nanmean(first))


def _run(corrector: Corrector, one: Given, *names: str) -> list[NDArray[Any]]:
    """What of its outcomes is named, each (n, 3), those in LSB Q8 in dps."""
    outcomes = list(engine("native").run(corrector, frames_in_batches(one.recording)))
    lsb = 256 * one.recording.scales.gyro_lsb_per_dps
    every = [np.concatenate([getattr(outcome, name) for outcome in outcomes]) for name in names]
    return [of / lsb if name.endswith("_q8") else of for name, of in zip(names, every)]
