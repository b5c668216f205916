"""This project's firmware on the same samples, online and unaided."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from zerorate import Corrector
from zerorate.effects.model_file import LOADED, REASONS
from zerorate.model import EffectModel

from ..errors import ZerorateError
from ..model import Model, encoded
from ..replay.engines import engine
from ..replay.replaying import corrector_for
from ..replay.samples import frames_in_batches
from .given import Given

Peer = Callable[[Sequence[Given]], list[NDArray[np.float64]]]
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
