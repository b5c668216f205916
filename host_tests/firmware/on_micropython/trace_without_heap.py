"""Runs the trace with the heap locked; writes the final state and every sample's bias.

Arguments: a mode of trace.MODES, how many updates.
"""

import sys
import trace
from array import array

from micropython import const, heap_lock, heap_unlock
from zerorate import Corrector, Sensor

_STRETCH = 500
# layout: The corrector's state
_OUT_Q8 = const(62)
# layout: end

mode, updates = sys.argv[1], int(sys.argv[2])

options = dict(trace.LIMITS)
options.update(trace.MODES[mode])
corrector = Corrector(Sensor(*trace.SENSOR), **options)
frame = array("i", [0] * 7)
generator = array("i", trace.GENERATOR)
biases = array("i", [0] * (3 * _STRETCH))


def stretch(first):
    s = corrector.state
    for n in range(_STRETCH):
        dt_us = trace.fill(frame, first + n, generator)
        corrector.update(frame, dt_us)
        for axis in range(3):
            biases[3 * n + axis] = s[_OUT_Q8 + axis]


with open("bias.bin", "wb") as file:
    for first in range(0, updates, _STRETCH):
        heap_lock()
        try:
            stretch(first)
        finally:
            heap_unlock()  # the WebAssembly port hangs on an error under the lock
        file.write(biases)
with open("state.bin", "wb") as file:
    file.write(corrector.state)
