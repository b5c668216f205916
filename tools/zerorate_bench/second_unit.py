"""`zerorate bench refine`: one unit's model on another unit of the same part, as it is and refined.

The first unit's effects of temperature are known; the second unit's are from half to one and a half
times as large, axis by axis. It is carried about, at rest for a quarter of the time, through
power-ons of 40 minutes that heat and cool. The figure is the error of the bias over all samples of
the last power-on, at rest and in motion, the firmware learning online all the while.
"""

from collections.abc import Sequence

import numpy as np
from zerorate import Corrector
from zerorate.model import EffectModel
from zerorate_tools.model import Slot, build_model, encoded
from zerorate_tools.model.check import sensor_for
from zerorate_tools.model.term import Term, evaluate
from zerorate_tools.recordings import Scales
from zerorate_tools.replay.engines import NativeEngine
from zerorate_tools.replay.samples import Frames

from .tables import table

SCALES = Scales("MPU-6050", 25.0, 131.0, 16384.0, 340.0, 36.53)
RATE = Term("temp", 0.0, 70.0, 30.0, lag_s=30.0, lag_mode="rate")
HYSTERESIS = Term("temp", 0.0, 70.0, 30.0, memory="backlash", width=6.0)
FIRST_UNIT = ((0.9, -0.7, 0.5), (0.03, -0.025, 0.02))
WAYS = ("no model", "the first unit's", "refined")
_SHARES = (0.5, 1.5)
_HZ, _MINUTES, _POWER_ONS = 25, 40, 4
_NOISE_DPS, _REST_S, _CARRIED_S = 0.05, 15, 45


class SecondUnit:
    """Power-ons of a unit whose effects are `share` (2, 3) times the first unit's."""

    def __init__(self, seed: int) -> None:
        self.rng = np.random.default_rng(seed)
        self.share = self.rng.uniform(*_SHARES, (2, 3))

    def power_on(self) -> tuple[Frames, np.ndarray]:
        """Samples and the true bias (n, 3), LSB."""
        n = _HZ * 60 * _MINUTES
        temp = self._temperature(n)
        ticks = temp.reshape(-1, _HZ).mean(axis=1)
        basis = [evaluate(t, {"temp": ticks}.__getitem__, 1.0) for t in (RATE, HYSTERESIS)]
        effect = np.repeat(np.column_stack(basis) @ (self.share * FIRST_UNIT), _HZ, axis=0)
        line = np.outer(temp - 30.0, (0.01, -0.008, 0.005))
        bias = effect + line + self.rng.normal(0, 0.02, 3) + (0.8, -0.5, 0.3)
        moving = np.arange(n) // _HZ % (_REST_S + _CARRIED_S) >= _REST_S
        swing = np.sin(np.outer(np.arange(n) / _HZ, self.rng.uniform(2, 5, 3)))
        rate = bias + np.where(moving[:, None], 60.0 * swing, 0.0)
        return self._frames(temp, rate, moving, swing), bias * SCALES.gyro_lsb_per_dps

    def _temperature(self, n):
        """degC: from 25 up and down between turning points, at 1 to 4 K a minute."""
        ends = np.r_[25.0, np.where(np.arange(8) % 2, 27.0, 43.0) + self.rng.uniform(-3, 3, 8)]
        minutes = np.cumsum(np.r_[0.0, np.abs(np.diff(ends)) / self.rng.uniform(1.5, 4.0, 8) + 1])
        return np.interp(np.arange(n) / _HZ / 60, minutes, ends)

    def _frames(self, temp, rate, moving, swing):
        rng, n = self.rng, len(temp)
        gyro = rate + rng.normal(0, _NOISE_DPS, (n, 3))
        accel = (
            np.array([0.0, 0.0, 1.0]) + rng.normal(0, 0.004, (n, 3)) + 0.2 * moving[:, None] * swing
        )
        degc = (temp - SCALES.temp_offset_degc) * SCALES.temp_lsb_per_degc + rng.normal(0, 2, n)
        words = np.column_stack([accel * 16384.0, degc, gyro * SCALES.gyro_lsb_per_dps])
        dt_us = np.full(n, 1_000_000 // _HZ, np.int32)
        frames = np.round(words).astype(np.int32)
        return Frames(np.cumsum(dt_us, dtype=np.int64), frames, dt_us, np.zeros((n, 0), np.int32))


def device(way: str) -> Corrector:
    """The firmware with no model, with the first unit's, or with that one refined as it goes."""
    corrector = Corrector(sensor_for(SCALES), motion=False, gravity=False)
    if way != WAYS[0]:
        slots = [
            Slot(RATE, FIRST_UNIT[0], "thermal-rate"),
            Slot(HYSTERESIS, FIRST_UNIT[1], "thermal-hysteresis"),
        ]
        model = EffectModel()
        model.load(encoded(build_model(slots, SCALES)), corrector.sensor)
        if way == WAYS[2]:
            model.refine()
        corrector.use_model(model)
    return corrector


def errors_mdps(seed: int, ways: Sequence[str] = WAYS) -> dict[str, float]:
    """RMS error of the bias over the last power-on and the axes, mdps, by way."""
    unit, devices = SecondUnit(seed), {way: device(way) for way in ways}
    out = {}
    for _ in range(_POWER_ONS):
        frames, bias_lsb = unit.power_on()
        for way, corrector in devices.items():
            corrector.power_on()
            own = Frames(frames.t_us, frames.frames.copy(), frames.dt_us, frames.extra)
            taken = next(iter(NativeEngine().run(corrector, [own]))).bias_q8 / 256.0
            left = (taken - bias_lsb)[60 * _HZ :] / SCALES.gyro_lsb_per_dps
            out[way] = float(1e3 * np.sqrt(np.mean(left**2)))
    return out


def run(seeds: int) -> list[dict[str, float]]:
    """`errors_mdps` of so many units."""
    return [errors_mdps(seed) for seed in range(seeds)]


def in_markdown(units: list[dict[str, float]]) -> str:
    """Median and worst of the units."""
    errors = {way: [unit[way] for unit in units] for way in WAYS}
    rows = [[way, f"{np.median(of):.1f}", f"{max(of):.1f}"] for way, of in errors.items()]
    return table([f"{len(units)} units, mdps", "median", "worst"], rows)
