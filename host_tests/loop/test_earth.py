"""Earth's rotation: taken out where it is known, named where an effect may be it."""

from types import SimpleNamespace

import numpy as np
import pytest
from zerorate_tools.loop.read.earth import EARTH_DPS, can_be_earth, earth_of
from zerorate_tools.recordings import Scales

UP = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]])


def ticks(columns=None, **more):
    """Three ticks, one pose each. columns: attitude as columns give it; more: of the scales."""
    scales = Scales("MPU-6050", 25.0, 131.0, 16384.0, more=more)
    return SimpleNamespace(count=np.ones(3), accel=UP, attitude=columns, scales=scales)


def test_without_a_latitude_nothing_is_removed_and_all_of_it_is_said_to_be_left():
    earth = earth_of(ticks())
    assert not earth.rate_dps.any() and earth.unknown_dps == EARTH_DPS
    assert "4.2 mdps" in earth.said and "latitude_deg" in earth.said


def test_gravity_and_latitude_give_the_vertical_part():
    earth = earth_of(ticks(latitude_deg=30.0))
    assert earth.rate_dps == pytest.approx(UP * EARTH_DPS / 2)
    assert earth.unknown_dps == pytest.approx(EARTH_DPS * np.sqrt(3) / 2)


def test_attitude_and_latitude_give_all_of_it():
    quarter_left = np.sqrt(0.5)  # nose to the north: east is to the right
    attitude = np.tile([quarter_left, 0.0, 0.0, quarter_left], (3, 1))
    earth = earth_of(ticks(columns=attitude, latitude_deg=0.0))
    assert earth.rate_dps == pytest.approx(np.tile([EARTH_DPS, 0.0, 0.0], (3, 1)), abs=1e-9)
    assert earth.unknown_dps == 0.0


def test_a_constant_attitude_may_travel_in_the_scales():
    earth = earth_of(ticks(latitude_deg=90.0, attitude=[2.0, 0.0, 0.0, 0.0]))
    assert earth.rate_dps == pytest.approx(np.tile([0.0, 0.0, EARTH_DPS], (3, 1)), abs=1e-9)


@pytest.mark.parametrize(("dps_per_g", "may_be"), [(0.004, True), (0.02, False)])
def test_a_small_effect_of_acceleration_may_be_earth(dps_per_g, may_be):
    assert can_be_earth(np.vstack([UP, -UP]) * dps_per_g, EARTH_DPS) is may_be
