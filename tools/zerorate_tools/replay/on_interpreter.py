"""Runs on a MicroPython: frames.bin through the firmware's kernels, state.bin and out.bin back."""

import sys
from array import array

from micropython import const
from zerorate.corrector import Corrector
from zerorate.model import EffectModel

_GAP = -0x80000000
# layout: The corrector's state
_OUT_Q8 = const(63)
_QUALITY_Q8 = const(69)
_EFFECT_Q8 = const(75)
_SOURCE = const(78)
# layout: The effect model and its running state
_REFINE_ON = const(33)
_CHANNELS = const(111)
# layout: end


def whole(name: str) -> "array[int]":
    with open(name, "rb") as file:
        return array("i", file.read())


def store(name: str, words: "array[int]") -> None:
    with open(name, "wb") as file:
        file.write(words)


# the settings come from the host: single-precision floats would round some of them elsewhere
motion = whole("motion.bin")
gravity = whole("gravity.bin")
effects = whole("effects.bin")
corrector = Corrector(motion=bool(motion), gravity=bool(gravity))
corrector.settings = whole("settings.bin")
corrector.state = state = whole("state.bin")
if motion:
    corrector.motion_settings = whole("motion_settings.bin")
    corrector.motion = motion
if gravity:
    corrector.gravity_settings = whole("gravity_settings.bin")
    corrector.gravity = gravity
if effects:
    model = EffectModel()
    model.e = effects
    if effects[_REFINE_ON]:
        from zerorate.native.refine import attend

        model.attend = attend
    corrector.use_model(model)


def out(verdict: int) -> "array[int]":
    bias, effect, source, quality = (
        state[at : at + 3] for at in (_OUT_Q8, _EFFECT_Q8, _SOURCE, _QUALITY_Q8)
    )
    total = [a + b for a, b in zip(bias, effect)]
    return array("i", [verdict] + total) + source + quality


row = array("i", bytes(4 * (8 + int(sys.argv[1]))))
with open("frames.bin", "rb") as source, open("out.bin", "wb") as target:
    while source.readinto(row):
        for k, value in enumerate(row[8:]):
            if value != _GAP:
                effects[_CHANNELS + k] = value
        frame = row[1:8]
        target.write(out(corrector.update(frame, row[0])) + frame)
store("state.bin", state)
store("motion.bin", motion)
store("gravity.bin", gravity)
store("effects.bin", effects)
store("motion_settings.bin", whole("motion_settings.bin"))
store("gravity_settings.bin", whole("gravity_settings.bin"))
