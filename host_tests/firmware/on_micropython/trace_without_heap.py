"""Runs the trace with the heap locked; writes the final state, and every sample's bias or frame.

Arguments: a mode of trace.MODES, how many updates; and "bursts" if they are to come in bursts.
"""

import sys
import trace
from array import array

from micropython import const, heap_lock, heap_unlock
from zerorate import Corrector, Sensor

_STRETCH = 500
_MOST = 73
# layout: The corrector's state
_OUT_Q8 = const(63)
# layout: end

mode, updates = sys.argv[1], int(sys.argv[2])
in_bursts = sys.argv[3:] == ["bursts"]
options = dict(trace.LIMITS)
options.update(trace.MODES[mode])
corrector = Corrector(Sensor(*trace.SENSOR), **options)
frame = array("i", [0] * 7)
generator = array("i", trace.GENERATOR)
biases = array("i", [0] * (3 * _STRETCH))
burst = array("i", [0] * (8 * _MOST))


def stretch(first):
    s = corrector.state
    for n in range(_STRETCH):
        dt_us = trace.fill(frame, first + n, generator)
        corrector.update(frame, dt_us)
        for axis in range(3):
            biases[3 * n + axis] = s[_OUT_Q8 + axis]


def one_by_one():
    with open("bias.bin", "wb") as file:
        for first in range(0, updates, _STRETCH):
            heap_lock()
            try:
                stretch(first)
            finally:
                heap_unlock()  # the WebAssembly port hangs on an error under the lock
            file.write(biases)


def fill(first, count):
    for n in range(count):
        burst[8 * n] = trace.fill(frame, first + n, generator)
        for i in range(7):
            burst[8 * n + 1 + i] = frame[i]


def by_bursts():
    from zerorate.bursts import Bursts

    bursts, first = Bursts(corrector), 0
    with open("frames.bin", "wb") as file:
        while first < updates:
            count = min(1 + first * 7 % _MOST, updates - first)
            fill(first, count)
            heap_lock()
            try:
                bursts.update(burst, count)
            finally:
                heap_unlock()
            file.write(bytes(burst)[: 32 * count])
            first += count


if in_bursts:
    by_bursts()
else:
    one_by_one()
with open("state.bin", "wb") as file:
    file.write(corrector.state)
