"""The firmware's two sources that need no rest, each on its own, without the decision."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from zerorate_tools.kernels.library import run_source
from zerorate_tools.layout import GRAVITY, MOTION
from zerorate_tools.peers.given import Given

_MOTION_WORDS = MOTION.MOTION_BIAS_Q8, MOTION.MOTION_QUALITY_Q8
_GRAVITY_WORDS = GRAVITY.GRAVITY_BIAS_Q8, GRAVITY.GRAVITY_QUALITY_Q8


class Source:
    """A source as a peer; calling it returns each session's bias (n, 3), dps, 0 while unknown.

    name: in_motion or gravity; options: keywords of its settings. After a call, `within` holds
    for every learned value and axis whether the truth given in `truth_dps` lay within two sigma;
    `learned` counts the windows or intervals, `wrong` those with an axis beyond four sigma.
    """

    def __init__(self, name: str, **options: object) -> None:
        self.name = name
        self.options = options
        self.truth_dps: Sequence[NDArray[np.float64]] | None = None
        self.within: list[bool] = []
        self.learned = self.wrong = 0

    def __call__(self, sessions: Sequence[Given]) -> list[NDArray[np.float64]]:
        """Run every session from nothing."""
        self.within, self.learned, self.wrong = [], 0, 0
        return [self._biases(number, one) for number, one in enumerate(sessions)]

    def _biases(self, number: int, one: Given) -> NDArray[np.float64]:
        state, settings, (bias_at, sigma_at) = self._made(one)
        lsb = 256 * one.recording.scales.gyro_lsb_per_dps
        rows = np.ascontiguousarray(one.recording.samples(), np.int32)
        t_us = one.recording.columns["t_us"]
        dt_us = np.diff(t_us, prepend=2 * t_us[0] - t_us[1])
        learned = np.zeros(len(rows), np.int8)
        words = np.zeros((len(rows), 2, 3), np.int32)
        at = bias_at, sigma_at
        run_source(self.name == "gravity", state, settings, rows, dt_us, at, learned, words)
        for i in np.flatnonzero(learned):
            self._judge(number, int(i), words[i, 0] / lsb, words[i, 1] / lsb)
        return words[:, 0] / lsb

    def _made(self, one: Given) -> tuple:
        scales = one.recording.scales
        sensor = (scales.odr_hz, scales.gyro_lsb_per_dps, scales.accel_lsb_per_g)
        if self.name == "in_motion":
            from zerorate.motion.motion_settings import motion_settings, motion_state

            degree = {"temp_lsb_per_degc": scales.temp_lsb_per_degc}
            settings = motion_settings(*sensor, **degree, **self.options)
            state, at = motion_state(settings), _MOTION_WORDS
        else:
            from zerorate.gravity.gravity_settings import gravity_settings, gravity_state

            settings = gravity_settings(*sensor, **self.options)
            state, at = gravity_state(settings), _GRAVITY_WORDS
        return np.array(state, np.int32), np.array(settings, np.int32), at

    def _judge(
        self, number: int, i: int, bias: NDArray[np.float64], sigma: NDArray[np.float64]
    ) -> None:
        self.learned += 1
        if self.truth_dps is None:
            return
        known = sigma < 1000
        off = np.abs(bias - self.truth_dps[number][i])
        inside = off < 2 * sigma
        self.wrong += bool(np.any(off[known] > 4 * sigma[known]))
        self.within += inside[known].tolist()
