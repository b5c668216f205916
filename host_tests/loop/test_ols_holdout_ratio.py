"""The plain error of sessions left out, and the firmware's room."""

import pytest
from zerorate_bench.loop.simulated import simulate
from zerorate_tools.loop.fit.regression import Regression
from zerorate_tools.loop.search.fits_in_slots import fits_in_slots
from zerorate_tools.loop.search.ols_holdout_ratio import ols_holdout_ratio
from zerorate_tools.loop.search.select import select, straight_line
from zerorate_tools.model.term import Term

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
