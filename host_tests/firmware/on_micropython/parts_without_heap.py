"""Runs a part of the firmware with the heap locked; writes what it leaves to out.bin.

Argument: the part, a key of PARTS.
"""

import sys
from array import array

from micropython import const, heap_lock, heap_unlock
from zerorate import Corrector
from zerorate.effects.effect_refine import attend
from zerorate.model import EffectModel
from zerorate.sensor import Sensor

# layout: The corrector's state
_WINDOW_N = const(17)
_STILLNESS = const(19)
_TEMP = const(22)
_EFFECT_Q8 = const(75)
_SEGMENT_TOTAL = const(100)
_FIT_WEIGHTS = const(103)
# layout: The corrector's settings
_WINDOW_SHIFT = const(4)
_SEGMENT = const(5)
_SETTINGS_WORDS = const(59)
# layout: The effect model and its running state
_SLOT_COUNT = const(7)
_SLOTS = const(119)
_REFINE_WORK = const(589)
# layout: An effect slot
_SLOT_VALUE = const(39)
_SLOT_WORDS = const(40)
# layout: What a window was
_STILL = const(1)
# layout: end


def sources(out):
    """Learns in motion and against gravity from samples.bin."""
    corrector = Corrector(Sensor(25.0), motion=True, gravity=True)
    sample = array("i", [0] * 7)
    with open("samples.bin", "rb") as file:
        while file.readinto(sample):
            heap_lock()
            corrector.update(sample, 40000)
            heap_unlock()
    for state in (corrector.state, corrector.motion, corrector.gravity):
        out.write(state)


def checkpoints(out):
    """Keeps checkpoints and takes one back; prints what was refused."""
    from zerorate.checked import CheckedCorrector

    checked = CheckedCorrector(Corrector())
    sample = array("i", [1, 2, 16384, -3000, 40, -20, 5])
    _feed(checked, sample)
    heap_lock()
    _feed(checked, sample)
    checked.take_back()
    heap_unlock()
    print(checked.refused > 0, checked.taken_back)


def _feed(checked, sample):
    for i in range(300):
        sample[4] = 40 + (i * 7) % 13  # what was corrected in place is no reading
        sample[5] = -20
        sample[6] = 5
        sample[0] = (i * 5) % 17
        checked.update(sample, 10000, 1 if i % 50 == 0 else 3 if i % 31 == 0 else 0)


def effects(out):
    """Sums the slots of model.bin."""
    from zerorate.effects.effects import sense

    model = EffectModel()
    assert model.load_file("model.bin", Sensor(4.0), b"\x68\x00\x00\x03") == 0
    state = array("i", [0] * (_EFFECT_Q8 + 3))
    frame = array("i", [0] * 7)
    found = array("i", [0] * 3000)
    for first in range(0, 4000, 1000):
        heap_lock()
        for n in range(1000):
            _fill(frame, model, first + n)
            k = first + n
            sense(state, model.e, frame, 3000000 if k % 211 == 0 else 250000, 1 if k % 13 else 0)
            for i in range(3):
                found[3 * n + i] = state[_EFFECT_Q8 + i]
        heap_unlock()
        out.write(found)
    out.write(model.e)


def _fill(frame, model, k):
    for i in range(7):
        frame[i] = (k * (i + 3) * 7919 >> 3) % 9001 - 4500
    frame[3] = 6000 - abs(k * 6 - 12000)
    model.channel("vdd_mv", 5000 + k % 97)


def refinement(out):
    """Refines the slots of model.bin."""
    model = EffectModel()
    assert model.load_file("model.bin", Sensor(2.0)) == 0
    model.refine()
    state = array("i", [0] * _FIT_WEIGHTS)
    state[_STILLNESS] = _STILL
    settings = array("i", [0] * _SETTINGS_WORDS)
    settings[_WINDOW_SHIFT], settings[_SEGMENT] = 6, 1  # a segment of one window of 64 samples
    heap_lock()
    for n in range(120):
        _attend(state, settings, model.e, n)
    heap_unlock()
    out.write(model.e)


def _attend(state, settings, e, n):
    for slot in range(e[_SLOT_COUNT]):
        value = _SLOTS + _SLOT_WORDS * slot + _SLOT_VALUE
        e[value] = (n * (slot + 3) * 7919 >> 2) % 40001 * 400 - 8000000
    for axis in range(3):
        state[_SEGMENT_TOTAL + axis] = n * (axis + 5) * 104729 % 60013 - 20000
    state[_TEMP] = n * 31 - 2000
    state[_WINDOW_N] = 0  # the window has just ended
    attend(state, settings, e)
    state[_WINDOW_N] = 1
    while e[_REFINE_WORK]:
        attend(state, settings, e)


PARTS = {
    "sources": sources,
    "checkpoints": checkpoints,
    "effects": effects,
    "refinement": refinement,
}
with open("out.bin", "wb") as file:
    PARTS[sys.argv[1]](file)
