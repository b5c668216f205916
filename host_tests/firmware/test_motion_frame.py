"""Where the source in motion says that a part points, and what its second order rounds off."""

from array import array

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from zerorate import Corrector, Sensor
from zerorate.motion import increments
from zerorate.motion.motion_settings import motion_settings, motion_state
from zerorate.motion.orientation import level, orientation
from zerorate_tools.layout import MOTION

from . import motions
from .played import by_machine_code


def test_what_second_order_rounds_off_does_not_add_up_to_a_bias():
    settings = motion_settings()
    state, turned = motion_state(settings), np.zeros(3)
    rates = np.rint(np.random.default_rng(1).normal(0, 262, (1200, 3)))  # 2 dps
    for rate in rates.tolist():
        frame = array("i", [0, 0, 16384, 0, *(int(v) for v in rate)])
        if increments.gather(state, settings, frame, 10000):
            at = MOTION.NODES_RING + 3 * state[MOTION.HEAD]
            increments.close(state, settings)
            turned += np.array(state[at : at + 3]) >> 15
    left = np.array(state[MOTION.NODE_ANGLE_Q24 : MOTION.NODE_ANGLE_Q24 + 3])
    turned_deg = np.degrees(turned / 8192 + left / (1 << 24))
    assert turned_deg == pytest.approx(rates.sum(axis=0) / 13100, abs=0.02)  # 2 mdps


SWUNG_HZ = 50.0
SWUNG_BIAS_DPS = np.array([1.0, -2.0, 3.0])


def as_rotation(found):
    return Rotation.from_quat([*found[1:], found[0]])


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_it_is_level_and_turned_as_the_body_is(seed):
    lean = Rotation.from_rotvec([0.5, -0.6, 0.2])
    swing = motions.swinging(seed, 60, SWUNG_HZ, SWUNG_BIAS_DPS, start=lean)
    corrector = Corrector(Sensor(SWUNG_HZ))
    dt_us = np.full(len(swing.samples), round(1e6 / SWUNG_HZ))
    by_machine_code(corrector, swing.samples.astype(np.int32), dt_us)
    now = as_rotation(orientation(corrector))
    up = now.inv().apply([0, 0, 1]) @ swing.attitude[-1].inv().apply([0, 0, 1])
    assert np.degrees(np.arccos(min(1.0, up))) < 1.5
    corrector.state[:] = array("i", [0] * len(corrector.state))  # what a bias left on does to it
    left_on = as_rotation(orientation(corrector))
    assert np.degrees((now.inv() * left_on).magnitude()) > 20


def test_there_is_none_before_a_second_has_passed_or_without_the_source():
    assert orientation(Corrector(motion=False)) is None
    corrector = Corrector(Sensor(SWUNG_HZ))
    assert orientation(corrector) is None
    for n in range(60):  # a frame like the one before is none
        corrector.update(array("i", [0, 0, 16384, 0, n & 1, 0, 0]), 20000)
    assert orientation(corrector) == pytest.approx((1, 0, 0, 0), abs=1e-3)


@pytest.mark.parametrize("up", [(0, 0, -1), (0, 0, 1), (0.6, 0, -0.8), (0, -1, 0)])
def test_any_force_is_made_vertical(up):
    assert as_rotation(level(up)).apply(up) == pytest.approx([0, 0, 1], abs=1e-9)
