"""The time of frames that are no good readings is not lost to the sources that integrate."""

from array import array

import numpy as np
import pytest
from zerorate import Corrector, Sensor
from zerorate.rest import guard
from zerorate_tools.layout import GRAVITY, MOTION, MOTION_REASON

from . import motions
from .motions import GYRO_LSB_PER_DPS

HZ = 50.0
DPS = 9.0


def fed(corrector, samples, dt_us):
    """What the guard said of each sample."""
    return [corrector.update(array("i", sample), dt_us) for sample in samples.tolist()]


def turned_while_read_faster(seconds):
    """A Corrector on a turntable about a level axis, with every tenth frame read twice."""
    chip = motions.turning(seconds, DPS, [1, 0, 0], hz=HZ, bias_dps=(0.0, 0.0, 0.0)).samples
    twice = np.repeat(chip, np.where(np.arange(len(chip)) % 10, 1, 2), axis=0)
    corrector = Corrector(Sensor(HZ))
    said = fed(corrector, twice, round(1e6 / HZ * len(chip) / len(twice)))
    assert said.count(guard.REPEAT) == len(chip) // 10
    return corrector


def test_a_program_that_reads_faster_than_the_chip_measures_loses_no_turn():
    seconds = 15
    motion = turned_while_read_faster(seconds).motion
    assert motion[MOTION.FILLED] == pytest.approx(seconds / 0.125, abs=1)
    turned_rad = sum(word >> 15 for word in motion[MOTION.NODES_RING :: 3]) / 8192
    assert np.degrees(turned_rad) == pytest.approx(DPS * seconds, rel=0.02)


def test_nor_does_gravity_take_the_turn_that_it_would_lose_for_bias():
    gravity = turned_while_read_faster(60).gravity
    assert gravity[GRAVITY.OBSERVED] > 100
    off = gravity[GRAVITY.GRAVITY_BIAS_Q8] / 256 / GYRO_LSB_PER_DPS
    assert abs(off) < 0.15, "a tenth of the turn is 0.9"


@pytest.mark.parametrize("hang", ["the same frame for a second", "no frame for ten seconds"])
def test_after_a_hang_nothing_is_joined_to_what_was_before(hang):
    samples = motions.swinging(2, 6, hz=HZ).samples
    corrector, dt_us = Corrector(Sensor(HZ)), round(1e6 / HZ)
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


def test_frames_that_repeat_for_ever_keep_within_31_bits():
    samples = motions.swinging(2, 1, hz=HZ).samples
    corrector = Corrector(Sensor(HZ))
    fed(corrector, samples[:1], 20000)
    for dt_us in ((1 << 30) - 1, -(1 << 30), 900_000_000, (1 << 30) - 1):
        fed(corrector, samples[:1], dt_us)
    assert corrector.motion[MOTION.LATE_US] == corrector.gravity[GRAVITY.GRAVITY_LATE_US] < 1 << 29
