"""Runs on a MicroPython: COUNT CALL AT_ONCE KIND [REPEATS], the first three as the C yardstick.

KIND is bytecode or viper. With REPEATS times.bin gets the fewest us that each sample took, or, with
AT_ONCE above 1, the whole is done so often, each time from the same state.
"""

import gc
import sys
import time
from array import array

if sys.argv[4] == "bytecode":
    sys.modules["zerorate.viper"] = sys  # has nothing of it, so that bytecode is chosen

from zerorate import Corrector, kernels
from zerorate.bursts import Bursts

count, call, at_once = int(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3])
if kernels.VIPER != (sys.argv[4] == "viper"):
    raise SystemExit("no " + sys.argv[4] + " here")


def whole(name):
    with open(name, "rb") as file:
        return array("i", file.read())


def one_by_one(count, take, rows, x):
    at = 0
    for _ in range(count):
        for k in range(7):
            x[k] = rows[at + 1 + k]
        if take:
            rows[at] = take(x, rows[at])
        for k in range(7):
            rows[at + 1 + k] = x[k]
        at += 8


def by_bursts(count, take, rows, burst):
    at = 0
    while count > 0:
        n = at_once if count > at_once else count
        for k in range(8 * n):
            burst[k] = rows[at + k]
        if take:
            take(burst, n)
        for k in range(8 * n):
            rows[at + k] = burst[k]
        at += 8 * n
        count -= n


def again_and_again(count, take, rows, state, rounds):
    first_rows, first_state = array("i", rows), array("i", state)
    for _ in range(rounds):
        memoryview(rows)[:] = memoryview(first_rows)
        memoryview(state)[:] = memoryview(first_state)
        for at in range(0, count, at_once):
            burst = memoryview(rows)[8 * at :]
            if take:
                take(burst, at_once if count - at > at_once else count - at)


def time_each(count, take, rows, x, fewest):
    clock = time.ticks_us  # type: ignore[attr-defined]
    for i in range(count):
        for k in range(7):
            x[k] = rows[8 * i + 1 + k]
        dt = rows[8 * i]
        start = clock()
        take(x, dt)
        spent = time.ticks_diff(clock(), start)  # type: ignore[attr-defined]
        if spent < fewest[i]:
            fewest[i] = spent


corrector = Corrector()
corrector.settings, frames = whole("settings.bin"), whole("frames.bin")
corrector.state = whole("state.bin")
x, burst = array("i", [0] * 7), array("i", [0] * (8 * at_once))
gc.collect()
if len(sys.argv) > 5 and at_once > 1:
    take = Bursts(corrector).update if call else None
    again_and_again(count, take, frames, corrector.state, int(sys.argv[5]))
elif len(sys.argv) > 5:
    fewest = array("i", [0x3FFFFFFF] * count)
    for _ in range(int(sys.argv[5])):
        corrector.state = whole("state.bin")
        time_each(count, corrector.update, frames, x, fewest)
    with open("times.bin", "wb") as file:
        file.write(fewest)
else:
    if at_once > 1:
        by_bursts(count, Bursts(corrector).update if call else None, frames, burst)
    else:
        one_by_one(count, corrector.update if call else None, frames, x)
    for name, words in (("state.out", corrector.state), ("frames.out", frames)):
        with open(name, "wb") as file:
            file.write(words)
