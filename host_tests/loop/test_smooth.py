"""A line over temperature with many bends, drawn as smooth as the data say."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from zerorate_bench.loop.devices import CURVE, Device
from zerorate_bench.loop.run_trial import run_trial
from zerorate_bench.loop.simulated import simulate
from zerorate_tools.loop.fit.line import ordinary
from zerorate_tools.loop.fit.regression import Regression, predicted
from zerorate_tools.loop.fit.single import PiecesByLine, held
from zerorate_tools.loop.fit.smooth import draw
from zerorate_tools.loop.search import curve
from zerorate_tools.loop.search.catalogue import ranges
from zerorate_tools.model.effects import is_free
from zerorate_tools.model.model import TABLE_POINTS
from zerorate_tools.model.term import Term, evaluate

from . import dense
from .dense import A, B, C
from .selections import candidate, found, warm

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


TEMP = Term("temp", 10.0, 40.0, 25.0)
LAGS = [candidate(t, kind="thermal-lag") for t in (A, B)]


def by_pieces(sessions, line=(), pool=(), taken=0):
    return curve.ByPieces(SimpleNamespace(sessions=sessions), line, pool, None, taken)


@pytest.mark.parametrize(
    ("slots", "p", "accepted", "alike", "kept"),
    [
        *((8, 0.9e-3, True, False, True), (8, 1.1e-3, True, False, False)),
        *((8, 0.9e-3, False, False, False), (8, 0.9e-3, True, True, False)),
        (0, 0.9e-3, True, False, False),
    ],
)
def test_a_memory_of_one_recording_is_likely_and_no_hysteresis(
    monkeypatch, answers, slots, p, accepted, alike, kept
):
    gains = lambda straight, beside, terms: np.array([9.0 * (terms == (B,))])  # noqa: E731
    answers(curve, cancels=False, is_like_hysteresis=alike, PiecesByLine=gains)
    monkeypatch.setattr(curve, "refined", lambda of, beside, best: best)
    asked, told = [], found(B, kind="thermal-lag", accepted=accepted, p=p)
    monkeypatch.setattr(curve.ByPieces, "_judged", lambda self, *of: asked.append(of) or told)
    pool = [*LAGS, candidate(C, kind="temperature-kink")]
    by = by_pieces([dense.made(1, 60)], [TEMP], pool, 8 - slots)
    assert by._memory([]) == ([told] if kept else [])
    assert asked == ([(LAGS[1], [], (B,), 2)] if slots else [])


@pytest.mark.parametrize(("taken", "bends"), [(0, 7), (5, 2), (6, 0)])
def test_a_curve_bends_in_every_slot_that_is_left_at_places_evenly_apart(taken, bends):
    every = curve.smooth_curve([warm()], (Term("temp", centre=25.0),), taken)
    assert len(every) == bool(bends)
    for one in every:
        slope, *knots = one.terms
        assert (slope.lo, slope.hi, slope.knot) == (15.0, 35.0, None)
        at = 20.0 + 10.0 * np.arange(1, bends + 1) / (bends + 1)
        assert [t.knot + 25.0 for t in knots] == pytest.approx(at)


@pytest.mark.parametrize(("missing", "shows"), [(3, True), (4, False)])
def test_a_curve_takes_enough_rests(missing, shows):
    least = curve.PIECES * curve.LEAST_OF_A_PIECE
    assert curve.shows_a_curve(dense.made(1, least + 3, gap=range(missing))) is shows


def test_of_a_pool_each_power_is_taken_once():
    kinds = ("temperature-quadratic", "temperature-cubic", "temperature-cubic", "vibration")
    terms = [replace(TEMP, power=p, centre=c) for p, c in ((2, 1.0), (3, 2.0), (3, 3.0), (1, 4.0))]
    pool = [candidate(t, kind=kind) for t, kind in zip(terms, kinds)]
    assert [t.centre for t in curve.powers(pool)] == [1.0, 3.0]
