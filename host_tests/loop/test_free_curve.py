"""A bias that follows a recorded channel along a curve that no row lists."""

from dataclasses import replace

import numpy as np
import pytest
from zerorate_bench.loop.devices import CURVE, Device
from zerorate_bench.loop.run_trial import run_trial
from zerorate_bench.loop.simulated import simulate
from zerorate_tools.loop.fit.free_curve import draw, parts
from zerorate_tools.loop.fit.regression import Regression
from zerorate_tools.loop.fit.single import PiecesByLine, held
from zerorate_tools.loop.search.catalogue import candidates, ranges
from zerorate_tools.model.effects import is_free
from zerorate_tools.model.model import TABLE_POINTS
from zerorate_tools.model.term import Term, evaluate

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
