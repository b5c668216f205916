"""A line over temperature with many bends, drawn as smooth as the data say."""

from dataclasses import replace

import numpy as np
import pytest
from zerorate_bench.loop.devices import CURVE, Device
from zerorate_bench.loop.run_trial import run_trial
from zerorate_bench.loop.simulated import simulate
from zerorate_tools.loop.fit.free_curve import draw
from zerorate_tools.loop.fit.line import ordinary
from zerorate_tools.loop.fit.regression import Regression, predicted
from zerorate_tools.loop.fit.single import PiecesByLine, held
from zerorate_tools.loop.search.catalogue import ranges
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


def test_a_wave_is_followed_where_no_noise_hides_it(quiet):
    rate = 0.05 * np.sin(2 * np.pi * share_of(quiet))
    fitted = ordinary(seven_bends(quiet), [made(quiet, rate)])
    assert left(quiet, rate, fitted) < 0.1 * rate.std()


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


def test_it_is_tied_to_the_channel_and_corrected_down_to_the_noise():
    outcome = run_trial(Device(CURVE, 900_100, (("notch", 3.0),)))
    assert outcome.tied_to(("humidity",))
    assert outcome.after < min(1.2, outcome.before)


def test_a_channel_without_effect_gets_no_curve_to_speak_of(sessions):
    told, _ = draw(Regression(sessions), (), load(sessions))
    fitted = Regression(sessions).fit([told]).coefficients
    assert np.abs(fitted).max() < 0.1 * np.abs(DPS).max()


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
    tables = {pieces.fitted_to(part, (), [told])[0][0].table for part in pieces.parts[:3]}
    assert is_free(told) and len(tables) == 3
