"""The corrected orientation that an application may ask for."""

from array import array

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from zerorate import Corrector, Sensor
from zerorate.motion.orientation import level, orientation

from . import motions
from .played import by_machine_code

HZ = 50.0
BIAS_DPS = np.array([1.0, -2.0, 3.0])


def swung(seed, seconds):
    """(attitude, samples): swinging about a lean, with a bias."""
    t = np.arange(int(seconds * HZ) + 1) / HZ
    draw = np.random.default_rng(seed)
    angles = np.sin(2 * np.pi * draw.uniform(0.4, 1.2, 3) * t[:, None]) * draw.uniform(0.2, 0.6, 3)
    attitude = Rotation.from_rotvec([0.5, -0.6, 0.2]) * Rotation.from_rotvec(angles)
    return attitude, motions.Motion(attitude, BIAS_DPS, HZ, seed).samples.astype(np.int32)


def as_rotation(found):
    return Rotation.from_quat([*found[1:], found[0]])


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_it_is_level_and_turned_as_the_body_is(seed):
    attitude, samples = swung(seed, 60)
    corrector = Corrector(Sensor(HZ))
    by_machine_code(corrector, samples, np.full(len(samples), round(1e6 / HZ)))
    now = as_rotation(orientation(corrector))
    up = now.inv().apply([0, 0, 1]) @ attitude[-1].inv().apply([0, 0, 1])
    assert np.degrees(np.arccos(min(1.0, up))) < 1.5
    corrector.state[:] = array("i", [0] * len(corrector.state))  # what a bias left on does to it
    left_on = as_rotation(orientation(corrector))
    assert np.degrees((now.inv() * left_on).magnitude()) > 20


def test_there_is_none_before_a_second_has_passed_or_without_the_source():
    assert orientation(Corrector(motion=False)) is None
    corrector = Corrector(Sensor(HZ))
    assert orientation(corrector) is None
    for n in range(60):  # a frame like the one before is none
        corrector.update(array("i", [0, 0, 16384, 0, n & 1, 0, 0]), 20000)
    assert orientation(corrector) == pytest.approx((1, 0, 0, 0), abs=1e-3)


@pytest.mark.parametrize("up", [(0, 0, -1), (0, 0, 1), (0.6, 0, -0.8), (0, -1, 0)])
def test_any_force_is_made_vertical(up):
    assert as_rotation(level(up)).apply(up) == pytest.approx([0, 0, 1], abs=1e-9)
