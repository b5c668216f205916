"""Effects that are all but the same."""

from dataclasses import replace

import pytest
from zerorate_tools.bench.loop.simulated import simulate
from zerorate_tools.loop.search.collinear import collinear
from zerorate_tools.model.term import Term

RATE = Term("temp", lag_s=20.0, lag_mode="rate")


@pytest.fixture(scope="module")
def sessions():
    return simulate(4).sessions


def test_a_rate_with_nearly_the_same_lag_is_no_second_effect(sessions):
    assert collinear([replace(RATE, lag_s=20.3)], [RATE], sessions)


def test_a_lag_ten_times_as_long_is_one(sessions):
    slow = Term("temp", lag_s=200.0, lag_mode="difference")
    assert not collinear([slow], [RATE], sessions)


def test_another_channel_is_one_however_like_it(sessions):
    assert not collinear([Term("vdd_mv")], [RATE, Term("load")], sessions)


def test_a_cubic_beside_a_quadratic_is_one_wherever_its_centre_is(sessions):
    square = Term("temp", centre=28.0, power=2)
    assert not collinear([Term("temp", centre=10.0, power=3)], [square], sessions)
