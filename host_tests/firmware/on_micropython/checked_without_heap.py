"""Checkpoints kept and taken back under micropython.heap_lock(); prints what was refused."""

from array import array

import micropython
from zerorate import Corrector
from zerorate.checked import CheckedCorrector

checked = CheckedCorrector(Corrector())
sample = array("i", [1, 2, 16384, -3000, 40, -20, 5])


def feed(count):
    for i in range(count):
        sample[4] = 40 + (i * 7) % 13  # what was corrected in place is no reading
        sample[5] = -20
        sample[6] = 5
        sample[0] = (i * 5) % 17
        status = 1 if i % 50 == 0 else 3 if i % 31 == 0 else 0
        checked.update(sample, 10000, status)


feed(300)
micropython.heap_lock()
feed(300)
checked.take_back()
micropython.heap_unlock()
print(checked.refused > 0, checked.taken_back)
