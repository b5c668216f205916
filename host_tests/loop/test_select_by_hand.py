"""One search, decision by decision: who is asked, in which order, and what is made of it."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from zerorate_tools.loop.fit.regression import Regression
from zerorate_tools.loop.search import curve, examine, hysteresis, select
from zerorate_tools.loop.search.catalogue import Candidate
from zerorate_tools.loop.search.decide import Decision
from zerorate_tools.loop.search.examine import Examiner
from zerorate_tools.loop.search.select import Search
from zerorate_tools.loop.search.selection import Found
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
DRIFT = Candidate("time-drift", (Term("time"),), "catalogue")


def found(candidate, **rivals):
    return Found(candidate, PASSED, rivals)


def searching(**fields):
    """A search that has come so far."""
    search = object.__new__(Search)
    empty = {"taken": 0, "found": [], "refused": [], "dropped": set(), "kept": 0, "pool": []}
    more = {"forms": [], "line": (), "own_bend": (), "on_pieces": None, "judged_again": False}
    regression = SimpleNamespace(sessions=[dense.made(1, 60)], outliers=0)
    vars(search).update({**empty, **more, "regression": regression, **fields})
    return search


# --- one candidate ---


@pytest.fixture
def examiner():
    """Of terms that gain ten times as much as there are of them beside so many nuisances."""
    gains = lambda beside, groups: np.array([[10.0 * len(g) - len(beside)] for g in groups])  # noqa: E731
    regression = SimpleNamespace(sessions=["s"], gains=gains)
    testing = SimpleNamespace(
        regression=regression, pool=[LAG, Candidate("two", (A, B), "catalogue"), VOLTS],
        tried=lambda c: 3.0, least_ratio=lambda c: 8.5,
    )  # fmt: skip
    return Examiner(testing, None)


def test_an_effect_is_idle_where_the_rest_explains_it(examiner):
    assert examiner.is_idle(LAG, [A, B]) and not examiner.is_idle(LAG, [A])


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
    examiner, monkeypatch, candidate, cancels, turned, alike, said
):
    answers = {"cancels": cancels, "may_show": turned, "is_like_hysteresis": alike}
    for name, answer in answers.items():
        monkeypatch.setattr(examine, name, lambda *of, answer=answer: answer)
    judged = lambda straight, beside, terms: np.array([9.0 * ((straight, beside) == ((A,), [B]))])  # noqa: E731
    told = examiner._by_pieces(PASSED, judged, candidate, (A,), [B])
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


def test_no_temperature_shows_no_hysteresis():
    bare = SimpleNamespace(sessions=[replace(dense.made(1, 60), sources={})])
    assert hysteresis.likeliest(bare, []) == (None, 0.0)
    assert hysteresis.of_one_recording(bare, [], (), [], None, 0) == (None, "")


# --- the whole search ---


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


POOL = [LAG, KINK, BEND, DRIFT, START, VOLTS]
FEW = (curve.KIND, "too few rests to tell by pieces left out")


@pytest.mark.parametrize(
    ("again", "rests", "loop", "kinds", "refused"),
    [
        (False, 12, None, [LAG, VOLTS, "curve"], [(hysteresis.KIND, "as well")]),
        (False, 12, LOOP, [LAG, VOLTS], []),
        (True, 12, LOOP, [LAG, DRIFT, START, VOLTS], []),
        (False, 11, LOOP, [LAG, VOLTS], [FEW]),
    ],
)
def test_a_recording_alone_is_asked_for_a_hysteresis_first(
    monkeypatch, again, rests, loop, kinds, refused
):
    bend, judged, said = BEND.terms, object(), (loop and found(loop), "" if loop else "as well")
    every = POOL if again else [c for c in POOL if c not in (DRIFT, START)]
    pair, alone = (bend, every, 5), (bend, every, judged, 5)
    monkeypatch.setattr(curve, "LEAST_OF_A_PIECE", 12 / curve.PIECES)
    two = lambda r, line, *of: again and of == pair and said  # noqa: E731
    monkeypatch.setattr(hysteresis, "of_a_pair", two)
    one = lambda r, line, *of: not again and of == alone and said  # noqa: E731
    monkeypatch.setattr(hysteresis, "of_one_recording", one)
    monkeypatch.setattr(curve, "smooth_curve", lambda made, line, n: ["curve"] * (n == 5))
    search = searching(pool=POOL, judged_again=again, taken=5)
    search.regression.sessions = [dense.made(1, rests)]
    search._begin_with_one(judged)
    begun = loop is not None and FEW not in refused
    assert search.pool == kinds and search.refused == refused
    assert search.forms == ([KINK, BEND] if FEW not in refused else [])
    assert (search.found, search.kept) == ([said[0]] * begun, begun)


def test_the_best_of_each_kind_is_tried_by_their_likelihood_less_what_they_cost():
    every = [replace(LAG, kind=str(k), terms=(A,) * (1 + (k == 3))) for k in range(9)]
    every += [
        replace(every[0], refine=("again",)),
        VOLTS,
        replace(VOLTS, kind="full", terms=(C,) * 9),
    ]
    test = np.array([40.0, 30.0, 9.0, 33.0, 25.0, 41.0, 20.0, 15.0, 12.0, 39.0, 80.0, 90.0])
    tried = []
    testing = SimpleNamespace(least_ratio=lambda c: 9.0)
    search = searching(pool=every, testing=testing, dropped={"supply-voltage"})
    search._ratios = lambda: (test, test)
    search._beside_outliers = lambda c: tried.append(c.kind)
    assert search._best_candidate() is None and tried == ["5", "0", "1", "3", "4", "6", "7", "8"]
    one = found(VOLTS)
    search._beside_outliers = lambda c: one if c.kind == "1" else None
    assert search._best_candidate() is one
    search._look_afresh = lambda: None
    assert search._add_one() and search.found == [one]
    search._best_candidate = lambda: None
    assert not search._add_one() and search.found == [one]


@pytest.mark.parametrize("outliers", [0, 3])
@pytest.mark.parametrize("said", [found(LAG), ("thermal-lag", "no")])
def test_a_block_that_a_candidate_explains_is_no_outlier(outliers, said):
    settled = []
    search = searching(line=(A,), own_bend=(B,), found=[found(VOLTS)])
    search.regression = SimpleNamespace(outliers=outliers, settle=settled.append)
    nuisances = [A, B, *VOLTS.terms]
    examined = lambda *of: said if of == (LAG, (A,), [*VOLTS.terms], nuisances) else None  # noqa: E731
    search.examiner = SimpleNamespace(examine=examined)
    told = search._beside_outliers(LAG)
    assert told is (said if isinstance(said, Found) else None)
    assert search.refused == ([] if told else [said])
    assert settled == ([[*nuisances, *LAG.terms]] + [nuisances] * (not told) if outliers else [])


def test_what_is_named_anew_must_pass_beside_the_others(monkeypatch):
    asked = []
    search = searching(line=(A,), own_bend=(B,), taken=2)
    search.examiner = SimpleNamespace(accepts=lambda *of: asked.append(of) or True)
    assert search._passes(LAG, [C]) and search._passes(BEND, [C])
    assert asked == [(LAG, (A,), [C], [A, B, C]), (BEND, (A,), [C], [A, C])]
    assert not search._passes(LAG, [D] * 6) and len(asked) == 2
    assert search._nuisances(BEND) == [A] and search._nuisances(LAG) == [A, B]
