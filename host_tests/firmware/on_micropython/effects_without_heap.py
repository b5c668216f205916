"""Runs effect slots with the heap locked; writes what they leave."""

from array import array

from micropython import const, heap_lock, heap_unlock
from zerorate.effects.effects import sense
from zerorate.model import EffectModel
from zerorate.sensor import Sensor

# layout: The corrector's state
_EFFECT_Q8 = const(75)
# layout: end

model = EffectModel()
assert model.load_file("model.bin", Sensor(4.0), b"\x68\x00\x00\x03") == 0
state = array("i", [0] * (_EFFECT_Q8 + 3))
frame = array("i", [0] * 7)
out = array("i", [0] * 3000)


def drive(first):
    e = model.e
    for n in range(1000):
        k = first + n
        for i in range(7):
            frame[i] = (k * (i + 3) * 7919 >> 3) % 9001 - 4500
        frame[3] = 6000 - abs(k * 6 - 12000)
        model.channel("vdd_mv", 5000 + k % 97)
        sense(state, e, frame, 3000000 if k % 211 == 0 else 250000, 1 if k % 13 else 0)
        for i in range(3):
            out[3 * n + i] = state[_EFFECT_Q8 + i]


with open("out.bin", "wb") as file:
    for first in range(0, 4000, 1000):
        heap_lock()
        drive(first)
        heap_unlock()
        file.write(out)
    file.write(model.e)
