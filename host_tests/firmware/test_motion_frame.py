"""The tilt frame, nodes and orientation of the source in motion beside the same in floats."""

from array import array

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from zerorate import Corrector, Sensor
from zerorate.motion import increments, tilt_frame
from zerorate.motion.motion_settings import motion_settings, motion_state
from zerorate.motion.orientation import level, orientation
from zerorate_tools.layout import MOTION

from . import motions
from .motions import Q12, Q14, SETTINGS, put_words, rotation_at
from .played import by_machine_code


@pytest.fixture
def state():
    return motion_state(SETTINGS)


@pytest.mark.parametrize("size", [60, 4096, 300000])
@pytest.mark.parametrize("way", [[0, 0, 1], [0, 0, -1], [1, 0, 0], [0, -1, 0], [0.6, 0.3, -0.7]])
def test_the_least_turn_makes_the_mean_force_vertical(state, draw, way, size):
    force = Rotation.from_rotvec(draw.normal(0, 0.3, 3)).apply(way) * size / np.linalg.norm(way)
    put_words(state, MOTION.OTHER_TILT, force[:1])
    put_words(state, MOTION.TILT, -force[1:2])
    put_words(state, MOTION.UP, force[2:])
    tilt_frame.find_up(state)
    length = np.linalg.norm(state[MOTION.START : MOTION.START + 4]) / Q14
    assert length == pytest.approx(1, abs=0.02 if size < 100 else 1e-3)
    turn = rotation_at(state, MOTION.START)
    assert turn.apply(force / size)[2] == pytest.approx(1, abs=0.002 if size < 100 else 1e-5)
    # about a level axis: of what points down first half about x
    least = turn if force[2] >= 0 else turn * Rotation.from_rotvec([-np.pi, 0, 0])
    assert abs(least.as_rotvec()[2]) < (0.05 if size < 100 else 2e-3)


def test_a_node_of_a_fast_hand_holds_its_turn_and_force_to_second_order(draw):
    settings, dt_s = motion_settings(gyro_lsb_per_dps=32.8), 0.01
    state = motion_state(settings)
    axis, aside = np.linalg.qr(draw.normal(size=(3, 2)))[0].T
    turn, up = Rotation.identity(), Rotation.from_rotvec(draw.normal(0, 1, 3)).apply([0, 0, 1])
    for n in range(12):
        # 350 dps, whose axis turns by half a radian in the node
        rate = 350 * Rotation.from_rotvec(0.05 * n * aside).apply(axis)
        frame = [*turn.inv().apply(up) * 16384, 0, *rate * 32.8]
        increments.gather(state, settings, array("i", [round(v) for v in frame]), 10000)
        turn = turn * Rotation.from_rotvec(np.radians(rate) * dt_s)
    angle = np.array(state[MOTION.NODE_ANGLE_Q24 : MOTION.NODE_ANGLE_Q24 + 3]) / (1 << 24)
    assert angle == pytest.approx(turn.as_rotvec(), abs=0.0006)
    force = np.array(state[MOTION.NODE_FORCE_Q12 : MOTION.NODE_FORCE_Q12 + 3]) / 12 / Q12
    assert force == pytest.approx(up, abs=0.02)


def test_what_second_order_rounds_off_does_not_add_up_to_a_bias():
    state, turned = motion_state(SETTINGS), np.zeros(3)
    rates = np.rint(np.random.default_rng(1).normal(0, 262, (1200, 3)))  # 2 dps
    for rate in rates.tolist():
        frame = array("i", [0, 0, 16384, 0, *(int(v) for v in rate)])
        if increments.gather(state, SETTINGS, frame, 10000):
            at = MOTION.NODES_RING + 3 * state[MOTION.HEAD]
            increments.close(state, SETTINGS)
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
