"""Feeds samples to a corrector with both other sources on, the heap locked; writes all states.

Argument: how many samples are in samples.bin, at 25 Hz.
"""

import sys
from array import array

from micropython import heap_lock, heap_unlock
from zerorate import Corrector, Sensor

corrector = Corrector(Sensor(25.0), motion=True, gravity=True)
sample = array("i", [0] * 7)
with open("samples.bin", "rb") as file:
    for _ in range(int(sys.argv[1])):
        file.readinto(sample)
        heap_lock()
        corrector.update(sample, 40000)
        heap_unlock()
with open("state.bin", "wb") as file:
    file.write(corrector.state)
    file.write(corrector.motion)
    file.write(corrector.gravity)
