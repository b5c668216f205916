"""Who is compared with whom: every way to a bias by name, and how each is run.

The cubic fits over temperature are made offline from session 1 with the true rests given. They are
written from the descriptions in flight stacks' documentation: PX4 filters by a median of 31, takes
2000 steps of temperature and fits order 3; ArduPilot takes the means of 0.5 degC steps and fits
order 3 about 35 degC. Both hold the value at the ends of the fitted range. A Source is one of the
firmware's two sources that need no rest, on its own; a Decision is the firmware's choice of them.
"""

import ctypes
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import NDArray
from scipy.ndimage import median_filter
from zerorate.effects.model_file import LOADED, REASONS
from zerorate.gravity.gravity_settings import gravity_settings, gravity_state
from zerorate.model import EffectModel
from zerorate.motion.motion_settings import motion_settings, motion_state
from zerorate_tools.errors import ZerorateError
from zerorate_tools.kernels.library import address, library
from zerorate_tools.layout import GRAVITY, MOTION
from zerorate_tools.model import Model, encoded
from zerorate_tools.peers import (
    Given,
    Peer,
    firmware,
    first_seconds,
    fusion,
    outcomes_of,
    vqf_biases,
    vqf_default,
)
from zerorate_tools.replay.replaying import corrector_for

_STRETCH_S = 10.0
_ORDER = 3
_MEDIAN = 31
_STEPS = 2000
_STEP_DEGC = 0.5
_ABOUT_DEGC = 35.0
_MOTION_WORDS = MOTION.MOTION_BIAS_Q8, MOTION.MOTION_QUALITY_Q8
_GRAVITY_WORDS = GRAVITY.GRAVITY_BIAS_Q8, GRAVITY.GRAVITY_QUALITY_Q8


Array = NDArray[np.float64]
Points = Callable[[Array, Array], tuple[Array, Array]]


def _fitted_on_the_first(sessions: Sequence[Given], points: Points) -> list[Array]:
    """Each session's bias (n, 3), dps."""
    first = sessions[0]
    temp, rates = np.empty(0), np.empty((0, 3))
    if first.temp_degc is not None:
        temp, rates = points(first.temp_degc[first.still], first.rate_dps[first.still])
    if len(temp) <= _ORDER:
        return [np.full(one.rate_dps.shape, np.nan) for one in sessions]
    curves = [Polynomial.fit(temp - _ABOUT_DEGC, axis, _ORDER) for axis in rates.T]
    temps = (np.asarray(one.temp_degc) for one in sessions)
    held = [np.clip(degc, temp.min(), temp.max()) - _ABOUT_DEGC for degc in temps]
    return [np.stack([curve(degc) for curve in curves], axis=1) for degc in held]


def _px4_points(temp: Array, rates: Array) -> tuple[Array, Array]:
    filtered = median_filter(rates, size=(_MEDIAN, 1), mode="nearest")
    edges = np.linspace(temp.min(), temp.max(), _STEPS + 1)
    return _step_means(temp, filtered, np.clip(np.digitize(temp, edges) - 1, 0, _STEPS - 1))


def _ardupilot_points(temp: Array, rates: Array) -> tuple[Array, Array]:
    # a step is taken when the temperature reaches it, so only while it rises
    rising = temp >= np.maximum.accumulate(temp) - _STEP_DEGC
    steps = np.floor((temp - temp.min()) / _STEP_DEGC).astype(int)
    return _step_means(temp[rising], rates[rising], steps[rising])


def _step_means(temp: Array, rates: Array, steps: NDArray[np.int64]) -> tuple[Array, Array]:
    counts = np.bincount(steps)
    filled = counts > 0
    means = [np.bincount(steps, values)[filled] / counts[filled] for values in (temp, *rates.T)]
    return means[0], np.stack(means[1:], axis=1)


class Judged(ABC):
    """A peer that also says how sure it is; calling it returns each session's bias (n, 3), dps.

    Every session begins from nothing. After a call, `within` holds for every judged value and axis
    whether the truth given in `truth_dps` lay within two sigma; `learned` counts what was learned,
    `wrong` what of it had an axis beyond four sigma.
    """

    truth_dps: Sequence[Array] | None = None

    def __call__(self, sessions: Sequence[Given]) -> list[Array]:
        self.within: list[bool] = []
        self.learned = self.wrong = 0
        return [self._biases(number, one) for number, one in enumerate(sessions)]

    @abstractmethod
    def _biases(self, number: int, one: Given) -> Array:
        """The bias of a session by its number."""


class Source(Judged):
    """A source as a peer, its bias 0 while unknown; it learns by windows or intervals.

    name: in_motion or gravity; options: keywords of its settings; state: that at the end.
    """

    def __init__(self, name: str, **options: object) -> None:
        self.name, self.options = name, options

    def _biases(self, number: int, one: Given) -> Array:
        scales = one.recording.scales
        sensor = (scales.odr_hz, scales.gyro_lsb_per_dps, scales.accel_lsb_per_g)
        if self.name == "in_motion":
            degree = {"temp_lsb_per_degc": scales.temp_lsb_per_degc}
            made, state_of, at = motion_settings, motion_state, _MOTION_WORDS
        else:
            degree, made, state_of, at = {}, gravity_settings, gravity_state, _GRAVITY_WORDS
        settings = made(*sensor, **degree, **self.options)
        state = self.state = np.array(state_of(settings), np.int32)
        rows = np.ascontiguousarray(one.recording.samples(), np.int32)
        t_us = one.recording.columns["t_us"]
        dt_us = np.diff(t_us, prepend=2 * t_us[0] - t_us[1]).astype(np.int32)
        learned, words = np.zeros(len(rows), np.int8), np.zeros((len(rows), 2, 3), np.int32)
        arrays = (state, np.array(settings, np.int32), rows, dt_us)
        library().zerorate_source(
            *(ctypes.c_int32(self.name == "gravity"), *map(address, arrays)),
            *(ctypes.c_int64(len(rows)), *map(ctypes.c_int32, at), address(learned)),
            address(words),
        )
        biases = words / (256 * scales.gyro_lsb_per_dps)
        for i in np.flatnonzero(learned):
            self._judge(number, int(i), *biases[i])
        return biases[:, 0]

    def _judge(self, number: int, i: int, bias: Array, sigma: Array) -> None:
        self.learned += 1
        if self.truth_dps is None:
            return
        known = sigma < 1000
        off = np.abs(bias - self.truth_dps[number][i])
        inside = off < 2 * sigma
        self.wrong += bool(np.any(off[known] > 4 * sigma[known]))
        self.within += inside[known].tolist()


def uncorrected(sessions: Sequence[Given]) -> list[Array]:
    """No bias at all."""
    return [np.zeros_like(one.rate_dps) for one in sessions]


def vqf_clip_raised(sessions: Sequence[Given]) -> list[Array]:
    """As `vqf_default`, with clip 25 dps and initial sigma 8 dps."""
    return [vqf_biases(one, {"biasClip": 25.0, "biasSigmaInit": 8.0}) for one in sessions]


class Decision(Judged):
    """As `firmware`, one power-on a session, judged at the end of every ten seconds with a bias.

    model: the effects that are taken out first; the bias is what is left of the rate then;
    options: keywords of zerorate.Corrector.
    """

    def __init__(self, model: Model | None = None, **options: object) -> None:
        self.model, self.options = model, options

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
        return outcomes_of(corrector, one, "bias_q8", "quality_q8", "source")

    def _biases(self, number: int, one: Given) -> Array:
        bias, sigma, source = self.states(one)
        if self.truth_dps is not None:
            known = source > 0
            inside = np.abs(bias - self.truth_dps[number]) < 2 * sigma
            stretch = round(_STRETCH_S * one.odr_hz)
            ends = slice(stretch - 1, None, stretch)
            self.within += inside[ends][known[ends]].tolist()
        return bias


def within_two_sigma(
    sessions: Sequence[Given], truth_dps: Array, first_s: float
) -> tuple[float, float]:
    """Shares of the last session's axes and samples whose truth lies within two sigma.

    Of all in which there was a bias, and of those of the first `first_s` seconds.
    """
    corrector = corrector_for(sessions[0].recording, {})
    for one in sessions:
        corrector.power_on()
        bias, sigma, source = outcomes_of(corrector, one, "bias_q8", "quality_q8", "source")
    inside = np.where(source > 0, np.abs(bias - truth_dps) < 2 * sigma, np.nan)
    first = inside[: round(first_s * sessions[-1].odr_hz)]
    return float(np.nanmean(inside)), float(np.nanmean(first))


#: How a way is run -> its name in the tables -> the way.
OURS: dict[str, Peer] = {
    "US 9,354,080's rules": firmware(document=True),
    "US 9,354,080's rules, on rests": firmware(document=True, every=False),
    "zerorate": firmware(),
}
_WAYS: dict[str, dict[str, Peer]] = {
    "on the device, knowing nothing": {
        "mean of the first 10 s": first_seconds,
        "imufusion": fusion,
        "vqf": vqf_default,
        "vqf, clip 25 dps": vqf_clip_raised,
    },
    "fitted to the first power-on and its true rests": {
        "PX4-style cubic": partial(_fitted_on_the_first, points=_px4_points),
        "ArduPilot-style cubic": partial(_fitted_on_the_first, points=_ardupilot_points),
    },
    "on the device, after the first power-on": OURS,
}
PEERS = {name: peer for ways in _WAYS.values() for name, peer in ways.items()}
HOW = {name: how for how, ways in _WAYS.items() for name in ways}
