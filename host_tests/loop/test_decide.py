"""The locks that an effect must open."""

from dataclasses import replace

import numpy as np
import pytest
from zerorate_bench.loop.simulated import simulate
from zerorate_tools.loop.fit.regression import Regression
from zerorate_tools.loop.search.collinear import collinear
from zerorate_tools.loop.search.decide import effective, predicts
from zerorate_tools.loop.search.fits_in_slots import fits_in_slots
from zerorate_tools.loop.search.ols_holdout_ratio import ols_holdout_ratio
from zerorate_tools.loop.search.select import Search, select, straight_line
from zerorate_tools.model.term import Term


@pytest.mark.parametrize(
    ("nats", "speaks"),
    [
        ([5.0, 4.0, 2.0], True),
        ([60.0, 60.0, -1.5], True),
        ([60.0, 60.0, -4.0], False),
        ([5.0, 3.5, -0.5], False),
        ([60.0, -1.0, -1.0], False),
        ([1.0, 0.5, 0.5], False),
        ([9.0, -1.0], False),
        ([9.0], True),
    ],
)
def test_sessions_left_out_must_speak_for_it_and_none_clearly_against(nats, speaks):
    assert predicts(np.array(nats)) is speaks


def test_columns_that_are_alike_are_paid_for_once():
    rng = np.random.default_rng(1)
    one = rng.normal(size=(500, 1))
    alike = np.hstack([one + 0.01 * rng.normal(size=(500, 1)) for _ in range(6)])
    assert effective(alike) < 1.6
    assert effective(rng.normal(size=(500, 6))) > 5.5


def test_the_shares_of_a_family_add_up_to_its_level():
    search = Search(simulate(1).sessions[:-1])
    for family in ("catalogue", "generic"):
        kinds = {c.kind: c for c in search.pool if c.family == family}
        shares = [search.testing.grid(kind) / search.testing.tried(c) for kind, c in kinds.items()]
        assert sum(shares) == pytest.approx(1.0)


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


BACKLASH = Term("temp", memory="backlash", width=3.0)


@pytest.fixture(scope="module")
def regression():
    device = simulate(11, [("thermal-hysteresis", 5.0)])
    return Regression(device.sessions)


def test_an_effect_that_is_there_makes_the_plain_error_smaller(regression):
    straight = straight_line(regression.sessions)
    assert ols_holdout_ratio(regression, straight, (), (BACKLASH,)) < 0.7


def test_a_channel_that_means_nothing_hardly_changes_it(regression):
    straight = straight_line(regression.sessions)
    assert ols_holdout_ratio(regression, straight, (BACKLASH,), (Term("load"),)) == pytest.approx(
        1, abs=0.03
    )


def test_one_session_alone_has_no_other_to_be_judged_by(regression):
    alone = Regression(regression.sessions[:1])
    assert ols_holdout_ratio(alone, straight_line(alone.sessions), (), (BACKLASH,)) == 1.0


def test_nine_terms_three_delays_or_nine_channels_have_no_room():
    assert fits_in_slots([Term(f"c{i}") for i in range(8)])
    assert not fits_in_slots([Term("temp")] * 9)
    assert not fits_in_slots([Term("temp")] * 6, taken=3)
    assert not fits_in_slots([Term("load", delay_s=100.0 + i) for i in range(3)])
    assert not fits_in_slots([Term(f"c{i}", second=f"d{i}") for i in range(5)])


def test_no_more_is_found_than_there_is_room_for():
    train = simulate(13, [("linear-acceleration", 3.0), ("supply-voltage", 5.0)]).sessions[:-1]
    assert len(select(train).terms) == 4
    assert len(select(train, taken=6).terms) <= 2
