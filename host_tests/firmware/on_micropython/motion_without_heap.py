"""Feeds samples to a source that learns without rest, the heap locked; writes its state.

Arguments: in_motion or gravity, how many samples are in samples.bin.
"""

import sys
from array import array

from micropython import heap_lock, heap_unlock

source, count = sys.argv[1], int(sys.argv[2])
if source == "in_motion":
    from zerorate.motion.in_motion import update
    from zerorate.motion.motion_settings import motion_settings, motion_state

    settings = motion_settings(odr_hz=25.0, longest_stage=8)
    state = motion_state(settings)
else:
    from zerorate.gravity.gravity import update
    from zerorate.gravity.gravity_settings import gravity_settings, gravity_state

    settings = gravity_settings(odr_hz=25.0)
    state = gravity_state(settings)

sample = array("i", [0] * 7)
with open("samples.bin", "rb") as file:
    for _ in range(count):
        file.readinto(sample)
        heap_lock()
        update(state, settings, sample, 40000)
        heap_unlock()
with open("state.bin", "wb") as file:
    file.write(state)
