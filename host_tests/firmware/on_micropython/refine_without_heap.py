"""Refinement with the heap locked; writes the whole array. Argument: plain or viper."""

import sys
from array import array

from micropython import heap_lock, heap_unlock
from zerorate.model import EffectModel
from zerorate.settings import Sensor

if sys.argv[1] == "viper":
    from zerorate.viper.effect_refine import attend
else:
    from zerorate.effect_refine import attend

model = EffectModel()
assert model.load_file("model.bin", Sensor(2.0)) == 0
model.refine()
state = array("i", [0] * 64)
state[46] = 1  # still
settings = array("i", [0] * 52)
settings[4], settings[5] = 6, 1  # a segment of one window of 64 samples


def drive():
    e = model.e
    for n in range(120):
        for slot in range(e[0]):
            e[112 + 40 * slot + 39] = (n * (slot + 3) * 7919 >> 2) % 40001 * 400 - 8000000
        for axis in range(3):
            state[42 + axis] = n * (axis + 5) * 104729 % 60013 - 20000
        state[47] = n * 31 - 2000
        state[17] = 0  # the window has just ended
        attend(state, settings, e)
        state[17] = 1
        while e[582]:
            attend(state, settings, e)


heap_lock()
drive()
heap_unlock()
with open("out.bin", "wb") as file:
    file.write(model.e)
