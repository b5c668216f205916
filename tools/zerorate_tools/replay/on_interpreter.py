"""Runs on a MicroPython: frames.bin through the firmware's kernels, state.bin and out.bin back."""

import sys
from array import array

from micropython import const
from zerorate.corrector import Corrector
from zerorate.model import EffectModel

_ROWS = 256
_GAP = -0x80000000
# layout: The corrector's state
_OUT_Q8 = const(62)
_EFFECT_Q8 = const(68)
_QUALITY_Q8 = const(77)
_SOURCE = const(80)
# layout: The effect model and its running state
_REFINE_ON = const(33)
_CHANNELS = const(111)
# layout: end


def whole(name):
    with open(name, "rb") as file:
        return array("i", file.read())


def store(name, words):
    with open(name, "wb") as file:
        file.write(words)


# the settings come from the host: single-precision floats would round some of them elsewhere
motion = whole("motion.bin")
gravity = whole("gravity.bin")
effects = whole("effects.bin")
corrector = Corrector(motion=len(motion) > 0, gravity=len(gravity) > 0)
corrector.settings = whole("settings.bin")
corrector.state = state = whole("state.bin")
if motion:
    corrector.motion_settings = whole("motion_settings.bin")
    corrector.motion = motion
if gravity:
    corrector.gravity_settings = whole("gravity_settings.bin")
    corrector.gravity = gravity
channels = 0
if effects:
    model = EffectModel()
    model.e = effects
    if effects[_REFINE_ON]:
        from zerorate.native.refine import attend

        model.attend = attend
    corrector.use_model(model)
    channels = int(sys.argv[1])
row_words = 8 + channels
out = array("i", bytes(68))
words = bytearray(4 * row_words * _ROWS)

with open("frames.bin", "rb") as source, open("out.bin", "wb") as target:
    while True:
        count = source.readinto(words) // (4 * row_words)
        if count == 0:
            break
        rows = array("i", words)
        for i in range(count):
            start = row_words * i
            frame = rows[start + 1 : start + 8]
            for k in range(channels):
                if rows[start + 8 + k] != _GAP:
                    effects[_CHANNELS + k] = rows[start + 8 + k]
            out[0] = corrector.update(frame, rows[start])
            for axis in range(3):
                out[1 + axis] = state[_OUT_Q8 + axis] + state[_EFFECT_Q8 + axis]
                out[4 + axis] = state[_SOURCE + axis]
                out[7 + axis] = state[_QUALITY_Q8 + axis]
            for k in range(7):
                out[10 + k] = frame[k]
            target.write(out)
store("state.bin", state)
store("motion.bin", motion)
store("gravity.bin", gravity)
store("effects.bin", effects)
store("motion_settings.bin", whole("motion_settings.bin"))
store("gravity_settings.bin", whole("gravity_settings.bin"))
