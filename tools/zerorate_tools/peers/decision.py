"""The firmware's one decision as a peer, with how sure it was and whether it was right."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..replay.engines import engine
from ..replay.replaying import corrector_for
from ..replay.samples import frames_in_batches
from .given import Given

_STRETCH_S = 10.0


class Decision:
    """As `firmware`, one power-on a session; options: keywords of zerorate.Corrector.

    After a call `within` holds, for each axis at the end of every stretch of ten seconds in which
    it had a bias, whether the truth given in `truth_dps` lay within two sigma.
    """

    def __init__(self, **options: object) -> None:
        self.options = options
        self.truth_dps: Sequence[NDArray[np.float64]] | None = None
        self.within: list[bool] = []

    def __call__(self, sessions: Sequence[Given]) -> list[NDArray[np.float64]]:
        """Run every session from nothing."""
        self.within = []
        return [self._biases(number, one) for number, one in enumerate(sessions)]

    def _biases(self, number: int, one: Given) -> NDArray[np.float64]:
        corrector = corrector_for(one.recording, dict(self.options))
        outcomes = list(engine("native").run(corrector, frames_in_batches(one.recording)))
        lsb = 256 * one.recording.scales.gyro_lsb_per_dps
        bias = np.concatenate([outcome.bias_q8 for outcome in outcomes]) / lsb
        if self.truth_dps is not None:
            sigma = np.concatenate([outcome.quality_q8 for outcome in outcomes]) / lsb
            known = np.concatenate([outcome.source for outcome in outcomes]) > 0
            inside = np.abs(bias - self.truth_dps[number]) < 2 * sigma
            ends = slice(round(_STRETCH_S * one.odr_hz) - 1, None, round(_STRETCH_S * one.odr_hz))
            self.within += inside[ends][known[ends]].tolist()
        return bias
