"""Runs on a MicroPython: frames.bin through the firmware's kernels, state.bin and out.bin back."""

from array import array

from zerorate.corrector import EFFECT_Q8, OUT_Q8, QUALITY_Q8, SOURCE
from zerorate.kernels import step

_ROWS = 256


def whole(name):
    with open(name, "rb") as file:
        return array("i", file.read())


settings = whole("settings.bin")
state = whole("state.bin")
frame = array("i", [0] * 7)
out = array("i", [0] * 17)
take = step.step
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
            out[0] = take(state, settings, frame, rows[8 * i])
            for axis in range(3):
                out[1 + axis] = state[OUT_Q8 + axis] + state[EFFECT_Q8 + axis]
                out[4 + axis] = state[SOURCE + axis]
                out[7 + axis] = state[QUALITY_Q8 + axis]
            for k in range(7):
                out[10 + k] = frame[k]
            target.write(out)
with open("state.bin", "wb") as target:
    target.write(state)
