"""What pieces of one recording tell of a curve over temperature, and of what remembers it."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from zerorate_tools.loop.search import curve
from zerorate_tools.model.term import Term

from . import dense
from .dense import A, B, C
from .selections import candidate, found, warm

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
