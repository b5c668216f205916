"""Feeds samples to a source that learns without rest, the heap locked; writes its state.

Arguments: plain or viper, in_motion or realtime, how many samples are in samples.bin.
"""

import sys
from array import array

from micropython import heap_lock, heap_unlock

which, source, count = sys.argv[1], sys.argv[2], int(sys.argv[3])
if source == "in_motion":
    from zerorate.motion_settings import motion_settings, motion_state

    settings = motion_settings(odr_hz=25.0, longest_stage=5)
    state = motion_state(settings)
    if which == "viper":
        from zerorate.viper.in_motion import update
    else:
        from zerorate.in_motion import update
else:
    from zerorate.realtime_settings import realtime_settings, realtime_state

    settings = realtime_settings(odr_hz=25.0)
    state = realtime_state(settings)
    if which == "viper":
        from zerorate.viper.realtime import update
    else:
        from zerorate.realtime import update

sample = array("i", [0] * 7)
with open("samples.bin", "rb") as file:
    for _ in range(count):
        file.readinto(sample)
        heap_lock()
        update(state, settings, sample, 40000)
        heap_unlock()
with open("state.bin", "wb") as file:
    file.write(state)
