"""Frames that are no readings are counted by kind, never learned from, and explain() says so."""

from array import array

import numpy as np
import pytest
from zerorate import Corrector
from zerorate.layout import SETTINGS, STATE
from zerorate.rest import guard

from .played import estimators, play, rest

COUNTS = STATE.COUNTS


def zeros(frames, dt_us):
    frames[:] = 0


def ones(frames, dt_us):
    frames[:] = -1


def repeats(frames, dt_us):
    frames[:] = frames[0]


def rails(frames, dt_us):
    frames[:, 4] = 32767
    frames[1::2, 4] = -32768


def temperature_jumps(frames, dt_us):
    frames[::2, 3] += 500


def time_stands_still(frames, dt_us):
    dt_us[:] = 0


def time_goes_back(frames, dt_us):
    dt_us[:] = -10000


def time_leaps(frames, dt_us):
    dt_us[:] = 60000000


FAULTS = [
    (zeros, guard.ALL_ZERO, "frames of all zeros"),
    (ones, guard.ALL_ONES, "frames of all ones"),
    (repeats, guard.REPEAT, "repeated frames"),
    (rails, guard.RAIL, "frames at the rail"),
    (temperature_jumps, guard.TEMPERATURE_JUMP, "jumps of the temperature"),
    (time_stands_still, guard.TIME_STOOD_STILL, "frames at a time that stood still"),
    (time_goes_back, guard.TIME_STOOD_STILL, "frames at a time that stood still"),
    (time_leaps, guard.TIME_LEAPT, "frames after a leap of time"),
]
faults = pytest.mark.parametrize(
    ("fault", "kind", "words"), FAULTS, ids=[fault.__name__ for fault, _, _ in FAULTS]
)


def broken(fault, seconds):
    """(frames, dt_us) of a rest, every frame of which has the fault."""
    frames = np.rint(rest(seconds, 5, (5.0, -5.0, 5.0)))
    dt_us = np.full(len(frames), 10000)
    fault(frames, dt_us)
    return frames, dt_us


@faults
@pytest.mark.parametrize("options", [{}, {"document": True}, {"every": True}], ids=str)
def test_a_minute_of_faults_teaches_nothing_and_is_counted(fault, kind, words, options):
    corrector, _ = play(rest(20, 1, (1.0, 2.0, 3.0)), **options)
    before = estimators(corrector)
    counted = corrector.state[COUNTS + kind]
    frames, dt_us = broken(fault, 60)
    _, outcome = play(frames[:1], corrector, dt_us[:1])  # the first may still be good
    before = estimators(corrector) if outcome.verdict[0] == guard.GOOD else before
    _, outcome = play(frames[1:], corrector, dt_us[1:])
    assert (outcome.verdict == kind).all()
    assert corrector.state[COUNTS + kind] >= counted + len(frames) - 1
    assert estimators(corrector) == before


@faults
def test_explain_says_which_faults_kept_it_from_learning(fault, kind, words):
    frames, dt_us = broken(fault, 60)
    corrector, _ = play(frames, None, dt_us)
    assert words in corrector.explain()
    assert "no bias yet" in corrector.explain()
    assert [corrector.source(axis) for axis in range(3)] == [0, 0, 0]


@faults
def test_one_broken_frame_in_a_rest_ends_it_but_a_repeat_does_not(fault, kind, words):
    corrector, _ = play(rest(2))
    assert corrector.state[STATE.REST] == 1  # a rest is being watched
    frames, dt_us = broken(fault, 0.02)
    play(frames, corrector, dt_us)
    assert corrector.state[STATE.REST] == (1 if kind == guard.REPEAT else 0)


def test_good_frames_are_counted_and_learned_from():
    corrector, outcome = play(rest(20, 1, (1.0, 2.0, 3.0)))
    assert (outcome.verdict == guard.GOOD).all()
    assert corrector.state[COUNTS] == 2000
    assert corrector.source(2) > 0


@pytest.mark.parametrize("frame", [[1] * 7, [-2] * 7, [0, 5, 5, 5, 5, 5, 5], [0, 0, 0, 0, 0, 0, 1]])
def test_only_all_zeros_and_all_ones_say_that_the_bus_is_dead(frame):
    corrector, _ = play(np.array([frame]))
    assert corrector.state[COUNTS + guard.GOOD] == 1


@pytest.mark.parametrize("word", range(7))
@pytest.mark.parametrize("value", [-32768, -32767, 32766, 32767])
def test_only_a_rate_that_cannot_be_larger_is_at_the_rail(word, value):
    frame = np.arange(1, 8)
    frame[word] = value
    corrector, _ = play(np.array([frame]))
    at_rail = word >= 4 and value in (-32768, 32767)
    assert corrector.state[COUNTS + guard.RAIL] == at_rail


def test_time_up_to_a_leap_passes_and_no_more():
    corrector = Corrector()
    leap_us = corrector.settings[SETTINGS.LEAP_US]
    for number, dt_us in enumerate((0, leap_us, leap_us + 1, leap_us)):
        verdict = corrector.update(array("i", [1, 2, 3, 4, 5, 6, number]), dt_us)
        assert verdict == (guard.TIME_LEAPT if dt_us > leap_us else guard.GOOD)
    assert corrector.state[STATE.ELAPSED_US] == 2 * leap_us


def test_a_jump_of_the_temperature_begins_at_its_limit():
    for sign in (1, -1):
        corrector = Corrector()
        limit = corrector.settings[SETTINGS.JUMP_LSB]
        verdicts = [
            corrector.update(array("i", [1, 2, 3, temp * sign, 5, 6, temp]), 10000)
            for temp in (7, 6 + limit, 6 + 2 * limit)
        ]
        assert verdicts == [guard.GOOD, guard.GOOD, guard.TEMPERATURE_JUMP]
