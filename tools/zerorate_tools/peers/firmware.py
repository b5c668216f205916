"""This project's firmware on the same samples, online and unaided."""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from ..replay.engines import engine
from ..replay.replaying import corrector_for
from ..replay.samples import frames_in_batches
from .given import Given

Peer = Callable[[Sequence[Given]], list[NDArray[np.float64]]]


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
            outcomes = engine("native").run(corrector, frames_in_batches(one.recording))
            bias_q8 = np.concatenate([outcome.bias_q8 for outcome in outcomes])
            found.append(bias_q8 / (256 * one.recording.scales.gyro_lsb_per_dps))
        return found

    return biases
