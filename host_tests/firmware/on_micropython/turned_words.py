"""Stores a state with one word turned, loads it and lives on: prints what each load said.

Here beside it: options.json, learned.bin, turned.bin (pairs of word and value), frames.bin (seven
words each). See turned_words.py.
"""

import json
from array import array

from zerorate import Corrector
from zerorate.storage.crc32 import checksum
from zerorate.storage.store import Store
from zerorate_fakes.memory import FakeMemory

PERIOD_US = 10_000


def words(name):
    with open(name, "rb") as file:
        return array("i", file.read())


def load(state, corrector):
    size = 4 * len(state)
    memory = FakeMemory(2 * size + 256)
    assert Store(memory, b"\x68", size).save(state)
    return corrector.load(Store(memory, b"\x68", size))


with open("options.json") as file:
    corrector = Corrector(motion=False, gravity=False, **json.load(file))
learned, turned, frames = words("learned.bin"), words("turned.bin"), words("frames.bin")
for i in range(0, len(turned), 2):
    state = array("i", learned)
    state[turned[i]] = turned[i + 1]
    reason = load(state, corrector)
    for k in range(0, len(frames) if reason == 0 else 0, 7):
        corrector.update(frames[k : k + 7], PERIOD_US)
    left = bytearray(4)
    checksum(corrector.state, left)
    print(turned[i], turned[i + 1], reason, left.hex())
