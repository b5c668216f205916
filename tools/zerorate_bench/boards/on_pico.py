"""Sent to an emulated Pico with a call of `run` behind it: frames through a corrector.

Frames come and rates go through the window of pico.mjs, which counts the cycles of each call.
"""

import gc
from array import array

from machine import mem32
from uctypes import addressof
from zerorate import Corrector, Sensor

_MARK = 0x40070004
_LENGTH = 0x40070008
_FILL = 0x4007000C
_TAKE = 0x40070010


def fill(words: "array[int]") -> None:
    mem32[_LENGTH] = 4 * len(words)
    mem32[_FILL] = addressof(words)


def give(words: "array[int]") -> None:
    """Words to the host."""
    mem32[_LENGTH] = 4 * len(words)
    mem32[_TAKE] = addressof(words)


def one_by_one(corrector: Corrector, count: int) -> None:
    """Each sample in a call: its rates to the host."""
    take = corrector.update
    dt_us = array("i", [0])
    sample = array("i", [0] * 7)
    for _ in range(count):
        fill(dt_us)
        fill(sample)
        dt = dt_us[0]
        mem32[_MARK] = 1
        take(sample, dt)
        mem32[_MARK] = 0
        give(sample)


def by_kernel(corrector: Corrector, count: int) -> None:
    """As one_by_one, but without the object: what the kernels cost, called as it calls them."""
    from zerorate.native.rest import step

    state, settings = addressof(corrector.state), addressof(corrector.settings)
    dt_us = array("i", [0])
    sample = array("i", [0] * 7)
    for _ in range(count):
        fill(dt_us)
        fill(sample)
        dt = dt_us[0]
        mem32[_MARK] = 1
        step(state, settings, sample, dt)
        mem32[_MARK] = 0
        give(sample)


def by_bursts(corrector: Corrector, count: int, at_once: int) -> None:
    """at_once samples in a call: their frames to the host."""
    from zerorate.bursts import Bursts

    take = Bursts(corrector).update
    frames = array("i", [0] * (8 * at_once))
    for _ in range(count // at_once):
        fill(frames)
        mem32[_MARK] = 1
        take(frames, at_once)
        mem32[_MARK] = 0
        give(frames)


def run(
    options: dict[str, object], sensor: tuple[float, ...], count: int, at_once: int, model: bytes
) -> None:
    """at_once: samples a call, 0 for the kernels without the object."""
    for _ in range(3):  # what the marks themselves cost
        mem32[_MARK] = 1
        mem32[_MARK] = 0
    corrector = Corrector(Sensor(*sensor), **options)
    fill(corrector.state)
    if model:
        from zerorate.model import EffectModel

        effects = EffectModel()
        effects.load(model, corrector.sensor)
        effects.refine()
        corrector.use_model(effects)
    gc.collect()
    if at_once > 1:
        by_bursts(corrector, count, at_once)
    elif at_once:
        one_by_one(corrector, count)
    else:
        by_kernel(corrector, count)
    c = corrector
    for words in (c.settings, c.motion_settings, c.gravity_settings, c.motion, c.gravity, c.state):
        if words is not None:
            give(words)
