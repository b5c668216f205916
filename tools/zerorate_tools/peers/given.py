"""One power-on's samples in physical units, as each peer is given them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..recordings import Recording


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


def given(recording: Recording, still: NDArray[np.bool_] | None = None) -> Given:
    """A recording in physical units; still: all of it unless said otherwise."""
    scales, rate = recording.scales, recording.gyro_dps()
    accel = recording.accel_g() if scales.accel_lsb_per_g and recording.has_accel else None
    temp = recording.temp_degc() if scales.temp_lsb_per_degc and recording.has_temp else None
    everywhere = np.ones(len(rate), bool)
    return Given(recording, rate, accel, temp, everywhere if still is None else still)
