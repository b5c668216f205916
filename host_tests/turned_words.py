"""Every word of a stored state turned, its checksum right: what the firmware makes of it.

python -m host_tests.turned_words [--values N] [--seed N] [--on RUNTIME]. Each word gets N values,
drawn by the seed. The state is stored, loaded, and run by the compiled kernels through rest over
the temperatures that it had learned. It is to be refused, or to do no harm for good: no signal, no
exception, and within ROUNDS times forty minutes no bias is wrong by more than WRONG_MDPS beyond
the state that nobody turned, for the last ten minutes of a round. --on has an interpreter of
MicroPython do the same for some seconds each, which must end as CPython does, to the last bit: what
a board makes of a state is what was judged here. Exits 1 otherwise.
"""

import argparse
import json
import os
import random
import sys
from array import array
from dataclasses import replace
from pathlib import Path

import numpy as np
from zerorate import Corrector
from zerorate.storage.codes import LOADED, OUT_OF_RANGE
from zerorate.storage.learned_store import LearnedStore
from zerorate_fakes.memory import FakeMemory
from zerorate_tools.layout import SETTINGS, named_state
from zerorate_tools.replay.engines import engine
from zerorate_tools.replay.samples import Frames
from zerorate_tools.runtimes import NAMES, find

from .tools.killed_writers import in_fork

WRONG_MDPS = 10.0
ROUNDS = 8
_LSB_PER_DPS = 131.0
_ODR_HZ = 100
_BIAS_LSB = (800, -300, 40)
_SLOPE = (0.03, -0.02, 0.01)  # LSB/LSB of temperature
_BINDING = b"\x68\0\0\0"
_END = 2**30
_FRAMES = 400  # that an interpreter lives through: a segment and what it leaves to be done
_HEAP = 1 << 20
_HERE = Path(__file__).parent
_SCRIPT = _HERE / "firmware" / "on_micropython" / "turned_words.py"
_ENDS = (0, 1, -1, 2, 0x3FFF, 0x7FFF, -0x8000, 1 << 20, 1 << 29, _END - 1, -_END)


def rest(minutes, cold_lsb, warm_lsb, seed):
    """(frames, biases in LSB) of a rest whose temperature goes to and fro, 20 minutes a way."""
    n = minutes * 60 * _ODR_HZ
    noise = np.random.default_rng(seed)
    way = np.abs((np.arange(n) / (20 * 60 * _ODR_HZ) + 1) % 2 - 1)
    temp = cold_lsb + (warm_lsb - cold_lsb) * way
    bias = np.array(_BIAS_LSB) + np.outer(temp, _SLOPE)
    words = np.empty((n, 7), np.int32)
    words[:, :3] = np.rint((0, 0, 16384) + noise.normal(0, 30, (n, 3)))
    words[:, 3] = np.rint(temp)
    words[:, 4:] = np.rint(bias + noise.normal(0, 6.5, (n, 3)))
    period_us = 1_000_000 // _ODR_HZ
    steps = np.full(n, period_us, np.int32)
    return Frames(np.arange(n) * period_us, words, steps, np.empty((n, 0), np.int32)), bias


def run(corrector, frames):
    """The biases, LSB, that the compiled kernels publish; the frames stay as they are."""
    frames = replace(frames, frames=frames.frames.copy())
    return next(engine("native").run(corrector, [frames])).bias_q8 / 256


def learned(options):
    """A state after 40 minutes of rest between 18 and 30 degC."""
    corrector = Corrector(motion=False, gravity=False, **options)
    run(corrector, rest(40, -6300, -2200, 1)[0])
    return array("i", corrector.state)


def stored(state, options):
    """(what a load says, the corrector that loaded it): the store is written by this very state."""
    memory = FakeMemory(1 << 16)
    writer = Corrector(motion=False, gravity=False, **options)
    writer.state[:] = state
    assert LearnedStore(memory, _BINDING, writer).save()
    reader = Corrector(motion=False, gravity=False, **options)
    return LearnedStore(memory, _BINDING, reader).load(), reader


def error_mdps(corrector, frames, bias_lsb):
    """The largest error of the last ten minutes, averaged over seconds, three axes."""
    off = (run(corrector, frames) - bias_lsb)[-600 * _ODR_HZ :]
    return float(np.abs(off.reshape(600, _ODR_HZ, 3).mean(1)).max() / _LSB_PER_DPS * 1000)


def values(word, count, draw):
    """Values for a word that holds `word`: bits of it turned, ends of ranges, anything."""
    turned = [word ^ 1 << draw.randrange(30), word ^ 1 << draw.randrange(16, 30), -word, 2 * word]
    turned += [draw.choice(_ENDS), draw.randrange(-_END, _END), word + draw.choice((-1, 1))]
    return [max(-_END, min(_END - 1, draw.choice(turned))) for _ in range(count)]


def turnings(state, settings, count, seed, only=None):
    """(word, its new value) of every turned state."""
    words = range(settings[SETTINGS.AXES], len(state)) if only is None else only
    for at in words:
        for value in values(state[at], count, random.Random(f"{seed} {at}")):
            if value != state[at]:
                yield at, value


def attack(options, count, seed, only=None):
    """Counts of what became of the turned states, and lines on those that fell."""
    state = learned(options)
    settings = Corrector(**options).settings
    frames, bias_lsb = rest(40, -6000, -2500, 2)
    reason, corrector = stored(state, options)
    assert reason == LOADED
    usual_mdps = max(error_mdps(corrector, frames, bias_lsb) for _ in range(ROUNDS))

    def outcome(turned):
        """What the load says, and the error of the last round that was needed."""
        reason, corrector = stored(turned, options)
        assert reason in (LOADED, OUT_OF_RANGE)
        off_mdps = 0.0
        for _ in range(ROUNDS if reason == LOADED else 0):
            off_mdps = error_mdps(corrector, frames, bias_lsb)
            if off_mdps < usual_mdps + WRONG_MDPS:
                break
        return reason, off_mdps

    tally = dict.fromkeys(("loaded", "afresh", "signals", "exceptions", "wrong"), 0)
    lines = []
    for at, value in turnings(state, settings, count, seed, only):
        turned = array("i", state)
        turned[at] = value
        status, answer = in_fork(Path(), lambda turned=turned: outcome(turned))
        reason, off_mdps = answer or (None, 0.0)
        kind = "loaded" if reason == LOADED else "afresh"
        if status:
            kind = "signals" if os.WIFSIGNALED(status) else "exceptions"
        elif off_mdps > usual_mdps + WRONG_MDPS:
            kind = "wrong"
        tally[kind] += 1
        if kind not in ("loaded", "afresh"):
            name = named_state(settings)[at][0]
            off = "" if status else f", {off_mdps:.0f} mdps where {usual_mdps:.1f} are usual"
            lines.append(f"{kind}: {name}, {state[at]} became {value}{off}")
            print(lines[-1], flush=True)
    return tally, lines


def differences(runtime, options, count, seed, only=None):
    """(states tried, what the interpreter and CPython said where it was not the same)."""
    state = learned(options)
    given = [*turnings(state, Corrector(**options).settings, count, seed, only)]
    frames = rest(1, -6000, -2500, 2)[0].frames[:_FRAMES]
    files = {
        "options.json": json.dumps(options).encode(),
        "learned.bin": state.tobytes(),
        "turned.bin": np.array(given, "<i4").tobytes(),
        "frames.bin": frames.astype("<i4").tobytes(),
    }
    modules = [_HERE.parent / "firmware", _HERE / "fakes"]
    said = [
        on.run(_SCRIPT, modules=modules, files_in=files, heap=_HEAP, check=True).stdout.splitlines()
        for on in (runtime, find("cpython"))
    ]
    return len(given), [pair for pair in zip(*said, strict=True) if pair[0] != pair[1]]


SETTINGS_TRIED = ({}, {"bins": 8}, {"document": True})


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--values", type=int, default=3, help="of each word")
    parser.add_argument("--seed", type=int, default=34)
    parser.add_argument("--on", action="append", default=[], choices=NAMES, metavar="RUNTIME")
    arguments = parser.parse_args()
    fallen = 0
    for name in arguments.on:
        for options in SETTINGS_TRIED:
            tried, lines = differences(find(name), options, arguments.values, arguments.seed)
            fallen += len(lines)
            print(f"{options or 'by default'}: {tried} on {name}, {len(lines)} otherwise", *lines)
    for options in SETTINGS_TRIED:
        tally, lines = attack(options, arguments.values, arguments.seed)
        fallen += len(lines)
        counts = ", ".join(f"{number} {kind}" for kind, number in tally.items())
        print(f"{options or 'by default'}: {counts}", flush=True)
    return 1 if fallen else 0


if __name__ == "__main__":
    sys.exit(main())
