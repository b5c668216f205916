"""A line over temperature with many bends, drawn as smooth as the data say."""

from dataclasses import replace

import numpy as np
import pytest
from zerorate_bench.loop.simulated import simulate
from zerorate_tools.loop.fit.line import ordinary
from zerorate_tools.loop.fit.regression import predicted
from zerorate_tools.loop.fit.smooth import bends_often
from zerorate_tools.model.term import Term

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
        # in another order the same line is none of many bends at even distances
        by_squares = ordinary([*terms[1:], terms[0]], [noisy])
        by_squares = np.vstack([by_squares[-1:], by_squares[:-1]])
        every.append([left(quiet, rate, f) for f in (ordinary(terms, [noisy]), by_squares)])
    smooth, squares = np.sqrt(np.mean(np.square(every), axis=0))
    assert smooth < 0.7 * squares


def test_a_turn_on_offset_is_each_session_s_own(quiet):
    rate = 0.05 * np.sin(2 * np.pi * share_of(quiet))
    both = [made(quiet, rate), made(quiet, rate + 1.0)]
    fitted = ordinary(seven_bends(quiet), both)
    assert left(quiet, rate, fitted) < 0.1 * rate.std()


def test_a_single_kink_is_no_line_that_bends_often(quiet):
    terms = seven_bends(quiet)
    assert bends_often(terms)
    assert not bends_often(terms[:2])
    assert not bends_often([*terms[:-1], Term("acc_x")])
