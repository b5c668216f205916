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
        """The output data rate."""
        return self.recording.scales.odr_hz


def given(recording: Recording, still: NDArray[np.bool_] | None = None) -> Given:
    """A recording in physical units; still: all of it unless said otherwise."""
    scales, columns = recording.scales, recording.columns
    rate = _stacked(columns, "g") / scales.gyro_lsb_per_dps
    accel = temp = None
    if scales.accel_lsb_per_g and "ax" in columns:
        accel = _stacked(columns, "a") / scales.accel_lsb_per_g
    if scales.temp_lsb_per_degc and "temp" in columns:
        temp = columns["temp"] / scales.temp_lsb_per_degc + (scales.temp_offset_degc or 0.0)
    everywhere = np.ones(len(rate), bool)
    return Given(recording, rate, accel, temp, everywhere if still is None else still)


def _stacked(columns: dict[str, NDArray], letter: str) -> NDArray[np.float64]:
    return np.stack([columns[letter + axis] for axis in "xyz"], axis=1).astype(float)
