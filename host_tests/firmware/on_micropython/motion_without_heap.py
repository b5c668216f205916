"""Feeds samples to a corrector that learns in motion and against gravity, the heap locked.

Argument: how many samples are in samples.bin. Writes the states.
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
    for state in (corrector.state, corrector.motion, corrector.gravity):
        file.write(state)
