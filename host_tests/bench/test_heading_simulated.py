"""What gravity may say of a device that turns about one axis in one pose."""

import pytest
from zerorate_bench.heading_simulated import Case, outcome


@pytest.mark.parametrize("number", [0, 2])
def test_a_robot_on_a_floor_whose_gyroscope_is_right_gets_no_matrix(number):
    assert not outcome(Case("robot", number, off=False))["found"]
