"""How far beyond the range it was fitted over a term follows its source."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from zerorate_bench.loop.simulated import simulate
from zerorate_tools.loop.fit.regression import Regression
from zerorate_tools.loop.fit.single import PiecesByLine
from zerorate_tools.loop.read.sessions import block_basis
from zerorate_tools.loop.search.catalogue import candidates
from zerorate_tools.loop.search.decide import effective
from zerorate_tools.loop.search.extrapolation import MOST, followed
from zerorate_tools.loop.search.fits_in_slots import fits_in_slots
from zerorate_tools.loop.search.ols_holdout_ratio import ols_holdout_ratio
from zerorate_tools.loop.search.select import Search, select, straight_line
from zerorate_tools.model import build_model
from zerorate_tools.model.model import Slot
from zerorate_tools.model.term import Term

from .power_ons import SCALES


def regression(seed):
    return Regression(simulate(seed).sessions[:-1])


def fitted(r, kind):
    return [c for c in candidates(r.sessions) if c.kind == kind][0].terms


def shares(before, after):
    """Of the range, below and above."""
    span = before.hi - before.lo
    return (before.lo - after.lo) / span, (after.hi - before.hi) / span


def test_a_supply_is_followed_beyond_what_was_seen():
    r = regression(1)
    (term,) = fitted(r, "supply-voltage")
    (moved,) = followed(r, straight_line(r.sessions), [term])
    assert min(shares(term, moved)) > 0.1


def test_a_cubic_is_followed_less_far_than_a_straight_line():
    r = regression(1)
    cubic, supply = (fitted(r, k)[0] for k in ("temperature-cubic", "supply-voltage"))
    moved = followed(r, straight_line(r.sessions), [cubic, supply])
    assert sum(shares(cubic, moved[0])) < sum(shares(supply, moved[1]))


@pytest.mark.parametrize("kind", ["time-drift", "power-on-transient", "thermal-lag"])
def test_time_and_what_has_its_own_margin_stay_as_they_were(kind):
    r = regression(1)
    terms = list(fitted(r, kind))
    assert followed(r, straight_line(r.sessions), terms) == terms


def test_one_face_never_shown_is_not_taken_for_granted():
    r = regression(1)
    for s in r.sessions:
        s.sources["acc_x"] = np.abs(s.sources["acc_x"])
    terms = list(fitted(r, "linear-acceleration"))
    moved = followed(r, straight_line(r.sessions), terms)
    assert moved[0].lo > -0.3


def test_a_product_is_followed_in_both_of_its_sources():
    r = regression(1)
    (term,) = fitted(r, "supply-temperature")
    (moved,) = followed(r, straight_line(r.sessions), [term])
    assert moved.lo < term.lo and moved.second_hi > term.second_hi


@settings(max_examples=10, deadline=None)
@given(st.integers(0, 10_000), st.sampled_from(["temperature-cubic", "vibration"]))
def test_what_was_fitted_is_not_changed_and_the_margin_is_bounded(seed, kind):
    r = regression(seed)
    terms = list(fitted(r, kind))
    moved = followed(r, straight_line(r.sessions), terms)
    for term, after in zip(terms, moved):
        assert all(0 <= s <= MOST + 1e-9 for s in shares(term, after))
        assert replace(after, lo=term.lo, hi=term.hi) == term
        for s in r.sessions:
            assert (block_basis(term, s) == block_basis(after, s)).all()


def test_a_found_effect_is_held_further_out_only_after_several_power_ons():
    sessions = simulate(3, [("supply-voltage", 5.0)]).sessions[:-1]
    volts = np.concatenate([s.sources["vdd_mv"] for s in sessions])
    many = select(sessions).found[0].candidate.terms[0]
    alone = select(sessions[:1], on_pieces=PiecesByLine(sessions[0])).found[0].candidate.terms[0]
    assert many.lo < volts.min() and many.hi > volts.max()
    own = sessions[0].sources["vdd_mv"]
    assert own.min() <= alone.lo < alone.hi <= own.max()


@pytest.mark.parametrize("kind", ["temperature-kink", "temperature-quadratic"])
def test_the_curve_of_one_recording_goes_on_beyond_its_temperatures(kind):
    (session,) = simulate(3, [(kind, 10.0)], sessions=1, bare=True).sessions
    (found,) = select([session], on_pieces=PiecesByLine(session)).found
    assert all(t.hi > session.sources["temp"].max() for t in found.candidate.terms)


def test_the_integers_are_held_where_the_numbers_are():
    found = select(simulate(3, [("temperature-quadratic", 5.0)]).sessions[:-1]).found[0]
    term = found.candidate.terms[0]
    slot = build_model([Slot(term, (0.001, 0.0, 0.0), "x")], SCALES, tick_s=5.0).slots[0]
    assert (slot.term.lo, slot.term.hi) == pytest.approx((term.lo, term.hi), abs=0.01)


def test_a_square_of_acceleration_is_held_alike_on_both_sides():
    sessions = simulate(1).sessions[:-1]
    for s in sessions:
        s.sources["acc_x"] = np.abs(s.sources["acc_x"])
    squares = next(c for c in candidates(sessions) if c.kind == "squared-acceleration")
    assert squares.terms[0].lo == -squares.terms[0].hi


def test_noise_sets_how_far_it_goes():
    reaches = []
    for minutes in (60, 15):
        sessions = simulate(1, hours=minutes / 60).sessions[:-1]
        r = Regression(sessions)
        (term,) = fitted(r, "temperature-cubic")
        reaches.append(sum(shares(term, followed(r, straight_line(sessions), [term])[0])))
    assert reaches[0] > reaches[1]


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
def regression_decide():
    device = simulate(11, [("thermal-hysteresis", 5.0)])
    return Regression(device.sessions)


def test_an_effect_that_is_there_makes_the_plain_error_smaller(regression_decide):
    straight = straight_line(regression_decide.sessions)
    assert ols_holdout_ratio(regression_decide, straight, (), (BACKLASH,)) < 0.7


def test_a_channel_that_means_nothing_hardly_changes_it(regression_decide):
    straight = straight_line(regression_decide.sessions)
    assert ols_holdout_ratio(
        regression_decide, straight, (BACKLASH,), (Term("load"),)
    ) == pytest.approx(1, abs=0.03)


def test_one_session_alone_has_no_other_to_be_judged_by(regression_decide):
    alone = Regression(regression_decide.sessions[:1])
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
