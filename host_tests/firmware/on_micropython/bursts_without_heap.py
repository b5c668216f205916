"""Runs the trace in bursts with the heap locked; writes the final state and every frame.

Arguments: a mode of trace.MODES, how many updates.
"""

import sys
import trace
from array import array

from micropython import heap_lock, heap_unlock
from zerorate import Corrector, Sensor
from zerorate.bursts import Bursts

_MOST = 73

mode, updates = sys.argv[1], int(sys.argv[2])

options = dict(trace.LIMITS)
options.update(trace.MODES[mode])
corrector = Corrector(Sensor(*trace.SENSOR), **options)
bursts = Bursts(corrector)
frame = array("i", [0] * 7)
generator = array("i", trace.GENERATOR)
burst = array("i", [0] * (8 * _MOST))


def fill(first, count):
    for n in range(count):
        burst[8 * n] = trace.fill(frame, first + n, generator)
        for i in range(7):
            burst[8 * n + 1 + i] = frame[i]


with open("frames.bin", "wb") as file:
    first = 0
    while first < updates:
        count = min(1 + first * 7 % _MOST, updates - first)
        fill(first, count)
        heap_lock()
        try:
            bursts.update(burst, count)
        finally:
            heap_unlock()  # the WebAssembly port hangs on an error under the lock
        file.write(bytes(burst)[: 32 * count])
        first += count
with open("state.bin", "wb") as file:
    file.write(corrector.state)
