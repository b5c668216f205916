"""Feeds samples to a source that learns without rest, the heap locked; writes its state.

Arguments: in_motion, gravity or together (a corrector with both), how many samples are in
samples.bin.
"""

import sys
from array import array

from micropython import heap_lock, heap_unlock
from zerorate import Corrector, Sensor

source, count = sys.argv[1], int(sys.argv[2])
if source == "in_motion":
    from zerorate.motion.in_motion import update
    from zerorate.motion.motion_settings import motion_settings, motion_state

    settings = motion_settings(odr_hz=25.0, longest_stage=8)
    states = [motion_state(settings)]
elif source == "gravity":
    from zerorate.gravity.gravity import update
    from zerorate.gravity.gravity_settings import gravity_settings, gravity_state

    settings = gravity_settings(odr_hz=25.0)
    states = [gravity_state(settings)]
else:
    corrector = Corrector(Sensor(25.0), motion=True, gravity=True)
    states = [corrector.state, corrector.motion, corrector.gravity]

    def update(state, settings, sample, dt_us):
        corrector.update(sample, dt_us)

    settings = None

sample = array("i", [0] * 7)
with open("samples.bin", "rb") as file:
    for _ in range(count):
        file.readinto(sample)
        heap_lock()
        update(states[0], settings, sample, 40000)
        heap_unlock()
with open("state.bin", "wb") as file:
    for state in states:
        file.write(state)
