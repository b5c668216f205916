"""Frames that are no readings are counted by kind, never learned from, and explain() says so."""

from array import array

import numpy as np
import pytest
from zerorate import Corrector, Sensor
from zerorate.rest import guard
from zerorate_tools.layout import GRAVITY, MOTION, MOTION_REASON, STATE

from . import motions
from .motions import GYRO_LSB_PER_DPS
from .played import estimators, play, rest

COUNTS = STATE.COUNTS


def to_and_fro(column, by):
    """Add the one, then the other, to a column's numbers in turn."""
    np.add(column, np.resize(by, len(column)), out=column)


FAULTS = {
    "zeros": (guard.ALL_ZERO, "frames of all zeros", lambda x, t: x.fill(0)),
    "ones": (guard.ALL_ONES, "frames of all ones", lambda x, t: x.fill(-1)),
    "repeats": (guard.REPEAT, "repeated frames", lambda x, t: np.copyto(x, x[0])),
    "rails": (guard.RAIL, "frames at the rail", lambda x, t: to_and_fro(x[:, 4], (4e4, -4e4))),
    "temperature jumps": (
        *(guard.TEMPERATURE_JUMP, "jumps of the temperature"),
        lambda x, t: to_and_fro(x[:, 3], (500, -500)),
    ),
    "time stands still": (
        *(guard.TIME_STOOD_STILL, "frames at a time that stood still", lambda x, t: t.fill(0)),
    ),
    "time goes back": (
        *(guard.TIME_STOOD_STILL, "frames at a time that stood still", lambda x, t: t.fill(-9)),
    ),
    "time leaps": (
        *(guard.TIME_LEAPT, "frames after missed samples", lambda x, t: t.fill(60_000_000)),
    ),
}
faults = pytest.mark.parametrize(("kind", "words", "fault"), FAULTS.values(), ids=FAULTS)


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


@pytest.mark.parametrize("dt_us, said", [(10, True), (200, False), (100_000, False)])
def test_milliseconds_given_for_microseconds_are_said(dt_us, said):
    frames = rest(5, 1)
    corrector, _ = play(frames, None, np.full(len(frames), dt_us))
    assert ("give microseconds" in corrector.explain()) == said


def test_the_noise_of_a_thermometer_ends_no_rest():
    frames = rest(60, 1, (1.0, 2.0, 3.0))
    frames[:, 3] += np.random.default_rng(2).normal(0, 88, len(frames))  # a quarter of a degree
    assert (np.abs(np.diff(frames[:, 3])) > 400).sum() > 3
    _, outcome = play(frames)
    assert (outcome.verdict == guard.GOOD).all()


def test_a_temperature_that_moved_for_good_is_refused_once():
    frames = rest(60)
    frames[3000:, 3] += 500
    _, outcome = play(frames)
    assert np.flatnonzero(outcome.verdict).tolist() == [3000]
    assert (outcome.verdict[3000:3001] == guard.TEMPERATURE_JUMP).all()


PASSED_HZ = 50.0
DPS = 9.0


def fed(corrector, samples, dt_us):
    """What the guard said of each sample."""
    return [corrector.update(array("i", sample), dt_us) for sample in samples.tolist()]


def turned_while_read_faster(seconds):
    """A Corrector on a turntable about a level axis, with every tenth frame read twice."""
    chip = motions.turning(seconds, DPS, [1, 0, 0], hz=PASSED_HZ, bias_dps=(0.0, 0.0, 0.0)).samples
    twice = np.repeat(chip, np.where(np.arange(len(chip)) % 10, 1, 2), axis=0)
    corrector = Corrector(Sensor(PASSED_HZ))
    said = fed(corrector, twice, round(1e6 / PASSED_HZ * len(chip) / len(twice)))
    assert said.count(guard.REPEAT) == len(chip) // 10
    return corrector


def test_a_program_that_reads_faster_than_the_chip_measures_loses_no_turn():
    seconds = 15
    motion = turned_while_read_faster(seconds).motion
    assert motion[MOTION.FILLED] == pytest.approx(seconds / 0.125, abs=1)
    turned_rad = sum(word >> 15 for word in motion[MOTION.NODES_RING :: 3]) / 8192
    assert np.degrees(turned_rad) == pytest.approx(DPS * seconds, rel=0.02)


def test_a_program_that_reads_eight_times_as_fast_as_the_chip_measures_learns_in_motion():
    chip = motions.swinging(2, 100, hz=25.0)
    corrector = Corrector(Sensor(200.0))
    fed(corrector, np.repeat(chip.samples, 8, axis=0), 5000)
    assert corrector.motion[MOTION.ACCEPTED] >= 6
    assert max(corrector.gravity[GRAVITY.OBSERVED : GRAVITY.OBSERVED + 3]) > 50
    bias = np.array(corrector.motion[MOTION.MOTION_BIAS_Q8 :][:3]) / 256 / GYRO_LSB_PER_DPS
    np.testing.assert_allclose(bias, chip.bias_dps, atol=0.1)


def test_nor_does_gravity_take_the_turn_that_it_would_lose_for_bias():
    gravity = turned_while_read_faster(60).gravity
    assert gravity[GRAVITY.OBSERVED] > 100
    off = gravity[GRAVITY.GRAVITY_BIAS_Q8] / 256 / GYRO_LSB_PER_DPS
    assert abs(off) < 0.15, "a tenth of the turn is 0.9"


@pytest.mark.parametrize("hang", ["the same frame for a second", "no frame for ten seconds"])
def test_after_a_hang_nothing_is_joined_to_what_was_before(hang):
    samples = motions.swinging(2, 6, hz=PASSED_HZ).samples
    corrector, dt_us = Corrector(Sensor(PASSED_HZ)), round(1e6 / PASSED_HZ)
    fed(corrector, samples[:200], dt_us)
    assert corrector.motion[MOTION.FILLED] > 0
    if "same" in hang:
        assert set(fed(corrector, np.tile(samples[199], (50, 1)), dt_us)) == {guard.REPEAT}
    else:
        assert fed(corrector, samples[200:201], 10_000_000) == [guard.TIME_LEAPT]
    fed(corrector, samples[201:202], dt_us)
    assert corrector.motion[MOTION.FILLED] == 0
    assert corrector.motion[MOTION.MOTION_REASON] == MOTION_REASON.MOTION_GAP
    assert corrector.gravity[GRAVITY.UNIT_N] == 0
