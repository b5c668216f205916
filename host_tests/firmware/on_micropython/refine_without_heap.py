"""Refinement with the heap locked; writes the whole array."""

from array import array

from micropython import const, heap_lock, heap_unlock
from zerorate.effects.effect_refine import attend
from zerorate.model import EffectModel
from zerorate.sensor import Sensor

# layout: The corrector's state
_WINDOW_N = const(17)
_STILLNESS = const(19)
_TEMP = const(22)
_SEGMENT_TOTAL = const(100)
_FIT_WEIGHTS = const(103)
# layout: The corrector's settings
_WINDOW_SHIFT = const(4)
_SEGMENT = const(5)
_SETTINGS_WORDS = const(59)
# layout: The effect model and its running state
_SLOT_COUNT = const(7)
_SLOTS = const(119)
_REFINE_WORK = const(589)
# layout: An effect slot
_SLOT_VALUE = const(39)
_SLOT_WORDS = const(40)
# layout: What a window was
_STILL = const(1)
# layout: end

model = EffectModel()
assert model.load_file("model.bin", Sensor(2.0)) == 0
model.refine()
state = array("i", [0] * _FIT_WEIGHTS)
state[_STILLNESS] = _STILL
settings = array("i", [0] * _SETTINGS_WORDS)
settings[_WINDOW_SHIFT], settings[_SEGMENT] = 6, 1  # a segment of one window of 64 samples


def drive():
    e = model.e
    for n in range(120):
        for slot in range(e[_SLOT_COUNT]):
            value = _SLOTS + _SLOT_WORDS * slot + _SLOT_VALUE
            e[value] = (n * (slot + 3) * 7919 >> 2) % 40001 * 400 - 8000000
        for axis in range(3):
            state[_SEGMENT_TOTAL + axis] = n * (axis + 5) * 104729 % 60013 - 20000
        state[_TEMP] = n * 31 - 2000
        state[_WINDOW_N] = 0  # the window has just ended
        attend(state, settings, e)
        state[_WINDOW_N] = 1
        while e[_REFINE_WORK]:
            attend(state, settings, e)


heap_lock()
drive()
heap_unlock()
with open("out.bin", "wb") as file:
    file.write(model.e)
