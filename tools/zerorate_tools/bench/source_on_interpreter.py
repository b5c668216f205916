"""Runs on a MicroPython: COUNT SOURCE feeds so many frames to in_motion, realtime, or nothing."""

import sys
from array import array

count, source = int(sys.argv[1]), sys.argv[2]
update = None
settings = state = array("i", [0])
if source == "in_motion":
    from zerorate.motion_settings import motion_settings, motion_state
    from zerorate.viper import in_motion

    settings = motion_settings()
    state, update = motion_state(settings), in_motion.update
elif source == "realtime":
    from zerorate.realtime_settings import realtime_settings, realtime_state
    from zerorate.viper import realtime

    settings = realtime_settings()
    state, update = realtime_state(settings), realtime.update


def drive(count, update, state, settings, file, x):
    for _ in range(count):
        file.readinto(x)
        if update:
            update(state, settings, x, 10000)


with open("frames.bin", "rb") as file:
    drive(count, update, state, settings, file, array("i", [0] * 7))
