"""Runs on a MicroPython: frames.bin through the firmware's kernels, state.bin and out.bin back."""

from array import array

from zerorate.corrector import EFFECT_Q8, OUT_Q8, QUALITY_Q8, SOURCE, Corrector

_ROWS = 256


def whole(name):
    with open(name, "rb") as file:
        return array("i", file.read())


def store(name, words):
    with open(name, "wb") as file:
        file.write(words)


# the settings come from the host: single-precision floats would round some of them elsewhere
motion = whole("motion.bin")
corrector = Corrector(motion=len(motion) > 0)
corrector.settings = whole("settings.bin")
corrector.state = state = whole("state.bin")
if motion:
    corrector.motion_settings = whole("motion_settings.bin")
    corrector.motion = motion
frame = array("i", [0] * 7)
out = array("i", [0] * 17)
words = bytearray(32 * _ROWS)

with open("frames.bin", "rb") as source, open("out.bin", "wb") as target:
    while True:
        count = source.readinto(words) // 32
        if count == 0:
            break
        rows = array("i", words)
        for i in range(count):
            for k in range(7):
                frame[k] = rows[8 * i + 1 + k]
            out[0] = corrector.update(frame, rows[8 * i])
            for axis in range(3):
                out[1 + axis] = state[OUT_Q8 + axis] + state[EFFECT_Q8 + axis]
                out[4 + axis] = state[SOURCE + axis]
                out[7 + axis] = state[QUALITY_Q8 + axis]
            for k in range(7):
                out[10 + k] = frame[k]
            target.write(out)
store("state.bin", state)
store("motion.bin", corrector.motion or b"")
