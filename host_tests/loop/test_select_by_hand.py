"""One search, decision by decision: who is asked, in which order, and what is made of it; and the
effects that come of it, refined, with less in it, and in the board's slots."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.optimize import brentq
from zerorate_tools.loop.fit.regression import Regression
from zerorate_tools.loop.search import examine, hysteresis, select
from zerorate_tools.loop.search.catalogue import Candidate
from zerorate_tools.loop.search.decide import Decision
from zerorate_tools.loop.search.examine import Examiner, cancels
from zerorate_tools.loop.search.select import Search
from zerorate_tools.loop.search.selection import Found, fits_in_slots
from zerorate_tools.model.term import Term, evaluate

from . import dense
from .dense import A, B, C, D
from .selections import warm

PASSED = Decision(True, 1e-6, 40.0, 1.0, np.zeros(0))
LAG, RATE, KINK, LOOP, BEND, VOLTS = (
    Candidate(kind, (Term("temp", centre=float(k)),), "catalogue")
    for k, kind in enumerate((
        *("thermal-lag", "thermal-rate", "temperature-kink"),
        *(hysteresis.KIND, "temperature-quadratic", "supply-voltage"),
    ))
)  # fmt: skip
START = Candidate("power-on-transient", (Term("one", decay_s=9.0),), "catalogue")


def found(candidate, **rivals):
    return Found(candidate, PASSED, rivals)


def searching(**fields):
    """A search that has come so far."""
    search = object.__new__(Search)
    empty = {"taken": 0, "found": [], "refused": [], "dropped": set(), "kept": 0, "own_bend": ()}
    vars(search).update({"line": (), "regression": None, **empty, **fields})
    return search


@pytest.mark.parametrize(
    ("candidate", "cancels", "turned", "alike", "said"),
    [
        (LOOP, True, False, True, "it would only cancel another"),
        (LOOP, False, False, True, "the temperature never turned back"),
        (LAG, False, False, True, "a hysteresis predicts as well"),
        (LOOP, False, True, False, "pieces"),
        (LAG, False, False, False, "pieces"),
    ],
)
def test_on_one_recording_more_speaks_against_an_effect(
    answers, candidate, cancels, turned, alike, said
):
    answers(examine, cancels=cancels, may_show=turned, is_like_hysteresis=alike)
    testing = SimpleNamespace(regression=SimpleNamespace(sessions=["s"]), pool=[])
    judged = lambda straight, beside, terms: np.array([9.0 * ((straight, beside) == ((A,), [B]))])  # noqa: E731
    told = Examiner(testing, None)._by_pieces(PASSED, judged, candidate, (A,), [B])
    assert (told.accepted, told.reason or "pieces") == (said == "pieces", said)
    assert told.session_gains.sum() == 9.0 * (said == "pieces")


@pytest.mark.parametrize(("reach_g", "found"), [(0.25, True), (0.0025, False)])
def test_acceleration_adds_no_more_than_a_gyroscope_follows_it_by(reach_g, found):
    session = warm(blocks=100, acc_x=reach_g * np.sign(np.sin(np.arange(100.0))))
    session.rate_dps = 0.005 * session.rate_dps + 0.05 / reach_g * session.sources["acc_x"][:, None]
    r, pose = Regression([session]), Candidate("linear-acceleration", (Term("acc_x"),), "catalogue")
    alone = r.gains([], [pose.terms]).sum()
    r.heed_data_sheets([])
    testing = SimpleNamespace(regression=r, pool=[pose], tried=lambda c: 1.0)
    told = Examiner(testing, None)._by_likelihood(pose, [])
    assert alone > 300 and told.accepted is found and (told.ratio > 0.6 * alone) == found


@pytest.mark.parametrize(
    ("step_degc", "across", "term", "explained"),
    [
        (1.0, 0.0, Term("temp", memory="play", width=2.0), True),
        (0.0, 0.0, Term("temp", memory="play", width=2.0), False),
        (0.1, 0.0, Term("temp", memory="play", width=2.0), False),
        (1.0, 0.02, Term("temp", memory="play", width=2.0), False),
        (1.0, 0.0, Term("b"), False),
    ],
)
def test_what_moves_along_the_slope_alone_may_be_a_coarse_thermometer_s(
    step_degc, across, term, explained
):
    line, degc = Term("temp", centre=1.0), 5.0 * np.sin(np.arange(120) / 9.0)
    session = dense.white(6, 120, temp=degc)
    session.temp_step_degc = step_degc
    slope = np.array([0.02, -0.03, 0.01])
    moved = 0.5 * evaluate(term, session.source, 20.0)[:, None] + degc[:, None]
    session.rate_dps = 1e-3 * session.rate_dps + moved * slope + (moved - degc[:, None]) * across
    regression = Regression([session])
    told = examine.is_rounding(regression, [line], Candidate("", (term,), "catalogue"), 1.0)
    assert told is explained


def test_what_later_effects_explain_is_taken_out_and_the_others_are_refined(monkeypatch):
    refined = lambda r, rest, c: replace(c, refine=tuple(str(t.centre) for t in rest))  # noqa: E731
    monkeypatch.setattr(select, "refined", refined)
    monkeypatch.setattr(select, "drawn", lambda r, rest, c: c)
    idle = SimpleNamespace(is_idle=lambda c, rest: c in (RATE, LAG))
    search = searching(found=[*map(found, (LAG, KINK, RATE, VOLTS))], kept=1, examiner=idle)
    search._drop_idle()
    assert [f.candidate.kind for f in search.found] == [c.kind for c in (LAG, KINK, VOLTS)]
    assert [f.candidate.refine for f in search.found] == [(), ("0.0", "5.0"), ("0.0", "2.0", "1.0")]
    assert search.dropped == {"thermal-rate"}
    assert search.refused == [("thermal-rate", "explained by effects found later")]


@pytest.mark.parametrize(
    ("own", "nats", "evidence", "fits", "kinds", "rivals"),
    [
        ([VOLTS], 9.0, 8.0, True, ["supply-voltage"], [{}]),
        ([LAG, VOLTS, START], 9.0, 8.0, True, ["supply-voltage", hysteresis.KIND],
         [{}, {"thermal-lag": -1.0, "power-on-transient": -1.0}]),
        ([LAG, VOLTS], 9.0, 9.5, True, ["thermal-lag", "supply-voltage"],
         [{hysteresis.KIND: -0.5}, {}]),
        ([LAG, VOLTS], 9.0, 8.0, False, ["thermal-lag", "supply-voltage"],
         [{hysteresis.KIND: 1.0}, {}]),
        ([LAG, VOLTS], None, 8.0, True, ["thermal-lag", "supply-voltage"], [{}, {}]),
    ],
)  # fmt: skip
def test_a_sum_of_play_operators_takes_the_place_of_what_remembers_if_it_is_likelier(
    monkeypatch, own, nats, evidence, fits, kinds, rivals
):
    search = searching(found=[*map(found, own)], line=(A,))
    beside = [A, *VOLTS.terms]

    def told(regression, terms, simpler=None):
        assert terms == beside
        if simpler is None:
            return (LOOP if nats else None), nats or 0.0
        assert simpler == [t for c in own if c is not VOLTS for t in c.terms]
        return evidence

    room = lambda terms, taken: fits and terms == [*VOLTS.terms, *LOOP.terms]  # noqa: E731
    monkeypatch.setattr(hysteresis, "likeliest", told)
    monkeypatch.setattr(select, "evidence", told)
    monkeypatch.setattr(select, "fits_in_slots", room)
    search._widen_hysteresis()
    assert [f.candidate.kind for f in search.found] == kinds
    assert [f.rivals for f in search.found] == rivals


def test_what_is_named_anew_must_pass_beside_the_others(monkeypatch):
    asked = []
    search = searching(line=(A,), own_bend=(B,), taken=2)
    search.examiner = SimpleNamespace(accepts=lambda *of: asked.append(of) or True)
    assert search._passes(LAG, [C]) and search._passes(BEND, [C])
    assert asked == [(LAG, (A,), [C], [A, B, C]), (BEND, (A,), [C], [A, C])]
    assert not search._passes(LAG, [D] * 6) and len(asked) == 2
    assert search._nuisances(BEND) == [A] and search._nuisances(LAG) == [A, B]


AFTER = Term("temp", lag_s=9.0, lag_mode="lag")
PLAY = Term("temp", memory="play", width=1.0)
TABLE = replace(AFTER, table=(0.0,) * 9)
PLAYS = [replace(PLAY, width=float(width)) for width in range(1, 8)]
DELAYS = [replace(AFTER, delay_s=float(delay)) for delay in (1, 2, 3)]
PRODUCTS = [Term(f"c{k}", second=f"d{k}") for k in range(4)]


@pytest.mark.parametrize(
    ("terms", "taken", "fits"),
    [
        *(([AFTER] * 8, 0, True), ([AFTER] * 9, 0, False)),
        *(([AFTER] * 6, 2, True), ([AFTER] * 6, 3, False)),
        *((PLAYS[:6] + [AFTER] * 8, 0, True), (PLAYS, 0, False)),
        (PLAYS[:6] + [replace(p, power=2) for p in PLAYS[:6]], 0, True),
        *((DELAYS[:2], 0, True), (DELAYS, 0, False)),
        *(([TABLE] * 2, 0, True), ([TABLE] * 3, 0, False)),
        *((PRODUCTS + [Term("time"), Term("one")], 0, True), (PRODUCTS + [Term("c9")], 0, False)),
    ],
)
def test_what_the_board_has_room_for(terms, taken, fits):
    assert fits_in_slots(terms, taken) is fits


@pytest.fixture
def alike():
    """alike(apart): sessions with two sources, the first so far from the second."""

    def sources(apart):
        made = [dense.made(1, 20, gap=(3,)), dense.made(2, 23), dense.made(3, 26)]
        for s in made:
            s.sources["b"] = s.sources["a"] + apart * s.sources["c"]
        return made

    return sources


def larger(sessions, beside):
    """Squares of what the first source adds by least squares, over those of the error without."""
    rows = []
    for s in sessions:
        whole = np.column_stack([s.sources["a"], s.sources["b"], s.rate_dps])[s.available]
        rows.append(whole - whole.mean(axis=0))
    a, b, *y = np.vstack(rows).T
    y = np.column_stack(y)
    x = np.column_stack([a, b] if beside else [a])
    size = np.linalg.lstsq(x, y, rcond=None)[0][0]
    without = y - np.outer(b, b @ y) / (b @ b) if beside else y
    return (np.outer(a, size) ** 2).sum() / (without**2).sum()


def test_an_effect_of_twice_the_error_without_it_only_stands_against_another(alike):
    just = brentq(lambda apart: larger(alike(apart), True) - 4.0, 0.01, 1.0)
    assert cancels(alike(0.999 * just), [B], [A])
    assert not cancels(alike(1.001 * just), [B], [A])
    assert larger(alike(1.0), False) < 4 and not cancels(alike(1.0), [], [A])
