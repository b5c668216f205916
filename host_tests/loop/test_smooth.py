"""A line over temperature with many bends, drawn as smooth as the data say."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from zerorate_bench.loop.devices import CURVE, Device
from zerorate_bench.loop.real import best_curve_rms_dps, cubic_left
from zerorate_bench.loop.run_trial import run_trial
from zerorate_bench.loop.simulated import simulate
from zerorate_tools.loop.fit.free_curve import draw, parts
from zerorate_tools.loop.fit.line import ordinary
from zerorate_tools.loop.fit.regression import Regression, predicted
from zerorate_tools.loop.fit.single import PiecesByLine, held
from zerorate_tools.loop.fit.smooth import curve_of
from zerorate_tools.loop.read.sessions import block_basis
from zerorate_tools.loop.search.catalogue import candidates, ranges
from zerorate_tools.loop.search.select import straight_line
from zerorate_tools.model.effects import is_free
from zerorate_tools.model.model import TABLE_POINTS
from zerorate_tools.model.term import Term, evaluate

SHARES = np.arange(1, 8) / 8


@pytest.fixture(scope="module")
def quiet():
    """A session without noise, over the range of a simulated one."""
    (session,) = simulate(5, sessions=1, bare=True).sessions
    return replace(session, rate_dps=np.zeros((session.blocks, 3)))


def share_of(session):
    temp = session.block_mean(session.sources["temp"])
    return (temp - temp.min()) / np.ptp(temp)


def seven_bends(session):
    temp = session.block_mean(session.sources["temp"])
    lo, hi = temp.min(), temp.max()
    slope = Term("temp", lo, hi, lo)
    return [slope, *(replace(slope, knot=float(k)) for k in SHARES * (hi - lo))]


def made(session, rate):
    return replace(session, rate_dps=np.repeat(rate[:, None], 3, axis=1))


def left(session, rate, fitted):
    """RMS of what a fit leaves of a rate, its mean aside."""
    return (rate - predicted(seven_bends(session), fitted, session)[:, 0]).std()


def test_a_straight_line_has_no_bends(quiet):
    rate = 0.5 * share_of(quiet)
    fitted = ordinary(seven_bends(quiet), [made(quiet, rate)])
    slopes = np.cumsum(fitted, axis=0)
    assert np.abs(slopes / slopes[0] - 1.0).max() < 1e-3


def test_a_wave_is_followed_where_no_noise_hides_it(quiet):
    rate = 0.05 * np.sin(2 * np.pi * share_of(quiet))
    fitted = ordinary(seven_bends(quiet), [made(quiet, rate)])
    assert left(quiet, rate, fitted) < 0.1 * rate.std()


def test_it_follows_the_noise_less_than_least_squares_do(quiet):
    rng, share = np.random.default_rng(1), share_of(quiet)
    rate = 0.02 * share**2
    every = []
    for _ in range(8):
        noisy = made(quiet, rate + rng.normal(0.0, 0.02, quiet.blocks))
        terms = seven_bends(quiet)
        columns = np.column_stack([block_basis(t, noisy) for t in terms])
        columns, rates = (v - v.mean(axis=0) for v in (columns, noisy.rate_dps))
        by_squares = np.linalg.lstsq(columns, rates, rcond=None)[0]
        every.append([left(quiet, rate, f) for f in (ordinary(terms, [noisy]), by_squares)])
    smooth, squares = np.sqrt(np.mean(np.square(every), axis=0))
    assert smooth < 0.7 * squares


def test_a_turn_on_offset_is_each_session_s_own(quiet):
    rate = 0.05 * np.sin(2 * np.pi * share_of(quiet))
    both = [made(quiet, rate), made(quiet, rate + 1.0)]
    fitted = ordinary(seven_bends(quiet), both)
    assert left(quiet, rate, fitted) < 0.1 * rate.std()


def test_a_single_kink_is_no_curve_and_what_is_beside_one_is_none_of_it(quiet):
    terms = seven_bends(quiet)
    assert curve_of([Term("acc_x"), *terms]) == list(range(1, 9))
    assert curve_of(terms[:2]) == []


def test_what_is_beside_a_curve_is_fitted_with_it(quiet):
    lag = Term("temp", lag_s=300.0, lag_mode="difference")
    rate = 0.05 * np.sin(2 * np.pi * share_of(quiet)) + 0.02 * block_basis(lag, quiet)
    fitted = ordinary([lag, *seven_bends(quiet)], [made(quiet, rate)])
    assert fitted[0] == pytest.approx(0.02, rel=0.05)


def alone(session, line):
    selection = SimpleNamespace(line=line)
    return SimpleNamespace(single=True, sessions=[session], train=[session], selection=selection)


@pytest.fixture(scope="module")
def bent():
    (session,) = simulate(5, [("temperature-kink", 20.0)], sessions=1, bare=True).sessions
    return session


def test_the_best_of_many_curves_leaves_less_than_a_cubic_of_a_kink_and_more_than_nothing(bent):
    analysis = alone(bent, straight_line([bent]))
    (left,) = cubic_left(analysis)
    cubic, best = np.sqrt(np.nanmean(left**2)), best_curve_rms_dps(analysis)
    noise = np.sqrt((np.diff(bent.rate_dps[bent.available], n=2, axis=0) ** 2).mean() / 6)
    assert 0.9 * noise < best < 0.8 * cubic


def test_without_temperature_there_is_neither(bent):
    analysis = alone(bent, ())
    assert (cubic_left(analysis), best_curve_rms_dps(analysis)) == (None, None)


DPS = np.array([0.03, -0.02, 0.01])


@pytest.fixture(scope="module")
def sessions():
    return simulate(31, sessions=3).sessions


def with_curves(sessions, *curves):
    """The sessions with a curve of the load on every axis in turn."""

    def added(s):
        return np.column_stack([s.block_mean(c(s.sources["load"])) for c in curves]) * DPS

    return [replace(s, rate_dps=s.rate_dps + added(s)) for s in sessions]


def load(sessions):
    lo, hi, mean = ranges(sessions)["load"]
    return Term("load", lo, hi, mean)


@pytest.mark.parametrize("curve", ["power of 1.5 above a threshold", "notch"])
def test_it_is_tied_to_the_channel_and_corrected_down_to_the_noise(curve):
    outcome = run_trial(Device(CURVE, 900_100, ((curve, 3.0),)))
    assert outcome.tied_to(("humidity",))
    assert outcome.after < min(1.2, outcome.before)


def test_its_nine_points_lie_on_the_curve(sessions):
    def hump(x):
        return np.sin(np.pi * x)

    told, lost = draw(Regression(with_curves(sessions, hump, hump, hump)), (), load(sessions))
    at = np.linspace(told.lo, told.hi, TABLE_POINTS)
    apart = np.polynomial.Polynomial.fit(hump(at), told.table, 1)
    assert np.abs(apart(hump(at)) - told.table).max() < 0.1
    assert lost < 0.01


def test_axes_that_follow_different_curves_lose_by_the_one_form_of_a_slot(sessions):
    two = with_curves(sessions, lambda x: np.sin(np.pi * x), lambda x: x, lambda x: x)
    assert draw(Regression(two), (), load(sessions))[1] > 0.05


def test_a_channel_without_effect_gets_no_curve_to_speak_of(sessions):
    told, _ = draw(Regression(sessions), (), load(sessions))
    fitted = Regression(sessions).fit([told]).coefficients
    assert np.abs(fitted).max() < 0.1 * np.abs(DPS).max()


def test_the_parts_it_is_looked_for_by_add_no_offset_and_make_any_line():
    tables = np.array([t.table for t in parts(Term("load", 0.0, 1.0))])
    assert np.abs(tables.sum(axis=1)).max() < 1e-9
    line = np.linspace(-1.0, 1.0, TABLE_POINTS)
    assert np.abs(tables.T @ np.linalg.lstsq(tables.T, line, rcond=None)[0] - line).max() < 0.05


def test_it_takes_one_slot(sessions):
    pool = [c for c in candidates(sessions) if c.kind == "channel-curve"]
    assert pool and all(len(c.slots) == 1 < len(c.terms) for c in pool)


def test_a_part_that_saw_less_of_a_channel_does_not_stretch_its_curve(sessions):
    term = replace(load(sessions), table=tuple(np.linspace(-1.0, 1.0, TABLE_POINTS).tolist()))
    few = replace(sessions[0], weight=(np.arange(sessions[0].blocks) < 20).astype(float))
    at = np.linspace(0.0, 1.0, 50)
    assert np.all(
        evaluate(held(term, [few]), lambda _: at, 1.0) == evaluate(term, lambda _: at, 1.0)
    )


def test_a_piece_left_out_has_no_say_in_the_curve_that_judges_it(sessions):
    (alone,) = with_curves(sessions[:1], *[lambda x: np.sin(np.pi * x)] * 3)
    told, _ = draw(Regression([alone]), (), load([alone]))
    pieces = PiecesByLine(alone)
    tables = {pieces.fitted_to(part, (), [told])[0][0].table for part in pieces.parts}
    assert is_free(told) and len(tables) == len(pieces.parts)
