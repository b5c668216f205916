"""Effects that are all but the same."""

from dataclasses import replace

import numpy as np
import pytest
from zerorate_bench.loop.simulated import simulate
from zerorate_tools.loop.fit.regression import Regression
from zerorate_tools.loop.search.collinear import collinear
from zerorate_tools.model.term import Term

# 6 mdps of noise a block over a hundred poses and more, thrice
FLOOR_DPS_A_G2 = 0.003
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


def test_the_sum_of_squares_that_gravity_holds_gets_no_coefficient_from_noise(sessions):
    rng = np.random.default_rng(3)
    session = sessions[0]
    poses = rng.normal(size=(session.blocks, 3))
    poses /= np.linalg.norm(poses, axis=1)[:, None]
    read_g = poses + (0.03, -0.02, 0.04) + rng.normal(0.0, 4e-4, poses.shape)
    names = ("acc_x", "acc_y", "acc_z")
    sources = {n: np.repeat(g, session.ticks_per_block) for n, g in zip(names, read_g.T)}
    turned = replace(session, sources=sources, rate_dps=session.rate_dps + 0.08 * poses)
    terms = [Term(n, power=power) for power in (1, 2) for n in names]
    fitted = Regression([turned]).fit(terms).coefficients
    assert np.abs(fitted[3:].sum(axis=0)).max() < 3 * FLOOR_DPS_A_G2
    assert fitted[:3] == pytest.approx(0.08 * np.eye(3), abs=FLOOR_DPS_A_G2)
