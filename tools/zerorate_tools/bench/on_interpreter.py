"""Runs on a MicroPython: COUNT CALL KIND [REPEATS] as the C yardstick does.

KIND is bytecode or viper. With REPEATS times.bin gets the fewest us that each sample took.
"""

import sys
import time
from array import array

count, call, kind = int(sys.argv[1]), int(sys.argv[2]), sys.argv[3]
if kind == "viper":
    from zerorate.viper import step
else:
    from zerorate import step


def whole(name):
    with open(name, "rb") as file:
        return array("i", file.read())


def drive(count, take, s, c, rows, x):
    at = 0
    for _ in range(count):
        for k in range(7):
            x[k] = rows[at + 1 + k]
        if take:
            rows[at] = take(s, c, x, rows[at])
        for k in range(7):
            rows[at + 1 + k] = x[k]
        at += 8


def time_each(count, take, s, c, rows, x, fewest):
    clock = time.ticks_us
    for i in range(count):
        for k in range(7):
            x[k] = rows[8 * i + 1 + k]
        dt = rows[8 * i]
        start = clock()
        take(s, c, x, dt)
        spent = time.ticks_diff(clock(), start)
        if spent < fewest[i]:
            fewest[i] = spent


settings, state, frames = whole("settings.bin"), whole("state.bin"), whole("frames.bin")
x = array("i", [0] * 7)
if len(sys.argv) > 4:
    fewest = array("i", [0x3FFFFFFF] * count)
    for _ in range(int(sys.argv[4])):
        time_each(count, step.step, array("i", state), settings, frames, x, fewest)
    with open("times.bin", "wb") as file:
        file.write(fewest)
else:
    take = step.step if call else None
    drive(count, take, state, settings, frames, x)
    for name, words in (("state.out", state), ("frames.out", frames)):
        with open(name, "wb") as file:
            file.write(words)
