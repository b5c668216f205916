"""What a search is told, may propose and must pay: beside plain sums and dense solutions."""

from dataclasses import replace
from itertools import combinations
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.stats import chi2
from zerorate_tools.loop.fit.free_curve import draw, parts
from zerorate_tools.loop.fit.regression import Regression
from zerorate_tools.loop.read.earth import Earth
from zerorate_tools.loop.read.lines import Line, Spectrum
from zerorate_tools.loop.read.sessions import Session
from zerorate_tools.loop.search import (
    catalogue,
    curve,
    decide,
    hysteresis,
    likely_hysteresis,
    naming,
    periodic,
    refine,
    step_places,
)
from zerorate_tools.loop.search.catalogue import MARGIN, candidates, ranges, varies
from zerorate_tools.loop.search.examine import cancels
from zerorate_tools.loop.search.selection import Found, Selection, fits_in_slots
from zerorate_tools.model.term import Term, play

from . import dense
from .dense import A, B, C, D
from .selections import candidate

VOLTS, TEMP = Term("vdd_mv", 4900.0, 5100.0, 5000.0), Term("temp", 10.0, 40.0, 25.0)


# --- what could have been shown, and the plain error ---


@pytest.mark.parametrize("beside", [[B], []])
def test_an_effect_of_twice_the_error_without_it_only_stands_against_another(beside):
    made = [dense.made(1, 20, gap=(3,)), dense.made(2, 23), dense.made(3, 26)]

    def whole(values, s):
        return (values - values[s.available].mean(axis=0))[s.available]

    def squares(apart):
        """Of what the effect adds, over those of the error without it."""
        for s in made:
            s.sources["b"] = s.sources["a"] + apart * s.sources["c"]
        a, b, y = (
            np.concatenate([whole(of(s), s) for s in made])
            for of in (lambda s: s.sources["a"], lambda s: s.sources["b"], lambda s: s.rate_dps)
        )
        x = np.column_stack([a, b] if beside else [a])
        size = np.linalg.lstsq(x, y, rcond=None)[0][0]
        without = y - np.outer(b, b @ y) / (b @ b) if beside else y
        return (np.outer(a, size) ** 2).sum() / (without**2).sum()

    if not beside:
        assert squares(1.0) < 4 and not cancels(made, [], [A])
        return
    just = brentq(lambda apart: squares(apart) - 4.0, 0.01, 1.0)
    for apart, against in ((0.999 * just, True), (1.001 * just, False)):
        squares(apart)
        assert cancels(made, beside, [A]) is against


# --- hysteresis, and curves over temperature ---


def widths_by_trial(fits, number, powers):
    """The choice of radii that leaves least, by the logarithms of the axes' squares."""
    left = {}
    for some in combinations(fits._grid, number):
        x = np.column_stack([fits._column(r, p) for r in some for p in powers])
        rest = fits._y - x @ np.linalg.lstsq(x, fits._y, rcond=None)[0]
        left[some] = np.log((rest**2).sum(axis=0)).sum()
    return sorted(min(left, key=left.get))


@pytest.mark.parametrize("powers", [(1,), (1, 2)])
@pytest.mark.parametrize(("number", "grid"), [(1, 64), (2, 64), (3, 12), (4, 12)])
def test_the_widths_of_play_operators_are_those_that_leave_least_of_all_axes(
    monkeypatch, number, grid, powers
):
    monkeypatch.setattr(hysteresis, "_GRID", grid)
    s = dense.made(5, 60, names=("temp",))
    s.sources["temp"] = degc = 25 + 9 * np.sin(np.arange(60) / 7)
    loops = np.column_stack([play(degc, 2 * r) ** k for r, k in ((1.0, 1), (4.0, 1), (2.5, 2))])
    size = np.array([[1.0, 300.0, 0.01], [2.0, -100.0, 0.02], [0.01, 3.0, 1e-4]])
    noise = np.random.default_rng(2).normal(size=(60, 3)) * [0.3, 60.0, 0.003]
    fits = hysteresis._Fits([replace(s, rate_dps=loops @ size + noise)], [Term("temp")])
    told = sorted(fits.best(number, powers))
    assert told == widths_by_trial(fits, number, powers)
    terms = fits.terms(told[::-1], powers)
    assert [(t.width, t.power) for t in terms] == [(2 * r, k) for r in told for k in powers]


LOOP = candidate(Term("temp", memory="play", width=4.0), kind=hysteresis.KIND)
SIMPLER = [candidate(A, kind="thermal-lag"), candidate(B, kind="temperature-kink")]
AS_WELL, BETTER = hysteresis.AS_WELL, hysteresis.BETTER


@pytest.mark.parametrize(
    ("nats", "of_bend", "simpler", "fits", "rivals", "said"),
    [
        (9.0, 2.0, (6.5, 6.9), True, {"temperature-kink": -0.1}, ""),
        (9.0, 8.5, (-3.0, -4.0), True, {"thermal-lag": -0.5}, ""),
        (9.0, 2.0, (7.1, 6.0), True, None, AS_WELL),
        (9.0, 2.0, (9.9, 6.0), True, None, AS_WELL),
        (9.0, 2.0, (10.1, 6.0), True, None, BETTER),
        (9.0, 9.5, (-3.0, -4.0), True, None, AS_WELL),
        (2.9, 0.0, (0.0, 0.0), True, None, "not significant"),
        (9.0, 2.0, (6.5, 6.9), False, None, ""),
        (None, 2.0, (6.5, 6.9), True, None, ""),
    ],
)
def test_a_hysteresis_of_a_pair_is_likelier_than_what_is_simpler(
    monkeypatch, nats, of_bend, simpler, fits, rivals, said
):
    told = {(TEMP,): of_bend, (A,): simpler[0], (B,): simpler[1], (C,): 99.0}
    asked, bend = [], [TEMP] if of_bend else []

    def evidence(regression, terms, tried):
        asked.append((tuple(terms), tuple(tried)))
        return told[tuple(tried)]

    shown = (LOOP, nats) if nats else (None, 0.0)
    monkeypatch.setattr(likely_hysteresis, "likeliest", lambda *of: shown)
    monkeypatch.setattr(likely_hysteresis, "evidence", evidence)
    monkeypatch.setattr(likely_hysteresis, "fits_in_slots", lambda terms, taken: fits)
    every = [*SIMPLER, candidate(C, kind="supply-voltage")]
    found, reason = likely_hysteresis.of_a_pair(None, [D], bend, every, 3)
    assert reason == said and (found is None) is (rivals is None)
    if found:
        assert found.candidate is LOOP and found.rivals == pytest.approx(rivals)
        assert found.decision.accepted and found.decision.ratio == 2 * nats
        assert found.decision.inflation == 1.0 and len(found.decision.session_gains) == 0
        assert found.decision.p_value == pytest.approx(6 * np.exp(-nats))
        assert asked == [((D,), (TEMP,)), ((D, TEMP), (A,)), ((D, TEMP), (B,))]


def test_forms_of_a_likely_hysteresis_span_all_sessions_temperatures():
    made = [warm(temp=np.linspace(*ends, 50)) for ends in ((10.0, 20.0), (14.0, 30.0))]
    every = list(likely_hysteresis._forms(made))
    assert [[t.power for t in form] for form in every] == [[1] * 4, [1, 2] * 4] * 3
    for form, finest in zip(every[::2], (0.0125, 0.025, 0.05)):
        widths = 2 * 20.0 * finest * 2.3 ** np.arange(4)
        assert [t.width for t in form] == pytest.approx(widths.tolist())
        assert {(t.lo, t.hi, t.centre) for t in form} == {(10.0, 30.0, 18.5)}


@pytest.mark.parametrize(
    ("gain", "rival", "p", "factor", "nats", "said"),
    [
        (9.0, 5.9, 2.4e-3, 2.6, 0.1, ""),
        (9.0, 6.1, 1e-4, 2.6, 1.0, AS_WELL),
        (9.0, 11.9, 1e-4, 2.6, 1.0, AS_WELL),
        (9.0, 12.1, 1e-4, 2.6, 1.0, BETTER),
        (9.0, 5.9, 2.6e-3, 2.6, 1.0, "not significant"),
        (9.0, 5.9, 1e-4, 2.4, 1.0, "too little of the error to tell it from the noise's walk"),
        (9.0, 5.9, 1e-4, 2.6, -1.0, "the kernels say no"),
        (None, 5.9, 1e-4, 2.6, 1.0, ""),
    ],
)
def test_a_hysteresis_of_one_recording_passes_every_question(
    monkeypatch, gain, rival, p, factor, nats, said
):
    answers = {
        **{"_with_a_bend": gain and (gain, (TEMP,), LOOP), "_rival": (SIMPLER[0], rival)},
        **{"_chance": (p, 33.0), "_factor": factor},
    }
    for name, answer in answers.items():
        monkeypatch.setattr(hysteresis, name, lambda *of, answer=answer: answer)

    def judged(*of):
        assert of == ([D], (), (TEMP, *LOOP.terms))
        return np.full(2, nats)

    judged.reason = "the kernels say no"
    one = SimpleNamespace(sessions=[dense.made(1, 60)])
    found, reason = hysteresis.of_one_recording(one, [D], [()], [], judged, 0)
    assert reason == said and (found is None) is bool(said or gain is None)
    if found:
        assert found.candidate == candidate(TEMP, *LOOP.terms, kind=hysteresis.KIND)
        assert (found.decision.p_value, found.decision.ratio) == (p, 33.0)
        assert found.decision.accepted and found.decision.session_gains.tolist() == [nats] * 2
        assert found.decision.inflation == 1.0


@pytest.mark.parametrize(
    ("nats", "chosen", "gain"),
    [((0.9, 1.9), None, 0.0), ((1.5, 2.4), 0, 0.5), ((1.1, 2.2), 1, 0.2), ((3.0, 4.0), 0, 2.0)],
)
def test_a_form_of_a_hysteresis_pays_a_nat_for_each_width(monkeypatch, nats, chosen, gain):
    one, wide = LOOP.terms[0], replace(LOOP.terms[0], width=9.0)
    forms = [(one, replace(one, power=2)), (one, wide)]
    monkeypatch.setattr(hysteresis, "may_show", lambda sessions: True)
    monkeypatch.setattr(hysteresis, "_forms", lambda sessions, beside: forms)
    by = lambda straight, beside, terms: np.array([nats[forms.index(terms)]])  # noqa: E731
    found, most = hysteresis.best_hysteresis([], [], [], by)
    assert most == pytest.approx(gain)
    assert found == (None if chosen is None else candidate(*forms[chosen], kind=hysteresis.KIND))


def test_a_bend_gains_with_its_hysteresis_and_both_need_their_slots(monkeypatch):
    bends, one = [(), (A,), (A, B), (C,)], SimpleNamespace(sessions=["s"])
    gains = {(): 5.0, (A,): 3.0, (A, B): 9.0, (C,): 2.0}
    alone = {(A,): [1.0, 1.1], (A, B): [0.0], (C,): [9.0]}
    loops = {bend: None if bend == (C,) else replace(LOOP, family=str(bend)) for bend in bends}

    def best(sessions, straight, bend, by_line):
        assert (sessions, straight) == (["s"], [D])
        return loops[bend], gains[bend]

    monkeypatch.setattr(hysteresis, "best_hysteresis", best)
    by_line = lambda straight, beside, bend: np.array(alone[bend])  # noqa: E731
    for some, taken, chosen in (
        *((bends[:2], 0, (5.1, (A,))), (bends, 0, (9.0, (A, B)))),
        *((bends, 7, (5.1, (A,))), (bends, 8, (5.0, ())), (bends[3:], 0, None)),
    ):
        told = hysteresis._with_a_bend(one, [D], some, by_line, taken)
        assert told == (chosen and (pytest.approx(chosen[0]), chosen[1], loops[chosen[1]]))


def test_a_rival_is_the_simpler_effect_that_predicts_best_with_the_bend():
    pool = [*SIMPLER, candidate(C, kind="supply-voltage")]
    told = {(D, A): [1.0, 2.0], (D, B): [4.0, -0.5], (D, C): [9.0, 9.0]}
    by_line = lambda straight, beside, terms: np.array(told[terms])  # noqa: E731
    assert hysteresis._rival([], (D,), pool, by_line) == (SIMPLER[1], 3.5)
    one = SimpleNamespace(gains=lambda beside, groups: np.full((1, 3), 8.0))
    p, ratio = hysteresis._chance(one, [], LOOP)
    assert (p, ratio) == (pytest.approx(chi2.sf(24.0, 3) * 8 * 6), 24.0)


@pytest.mark.parametrize(
    ("slots", "p", "accepted", "alike", "kept"),
    [
        *((8, 0.009, True, False, True), (8, 0.011, True, False, False)),
        *((8, 0.009, False, False, False), (8, 0.009, True, True, False)),
        (0, 0.009, True, False, False),
    ],
)
def test_a_memory_of_one_recording_is_likely_and_no_hysteresis(
    monkeypatch, slots, p, accepted, alike, kept
):
    lags = [candidate(t, kind="thermal-lag") for t in (A, B)]
    pool = [*lags, candidate(C, kind="temperature-kink")]
    one = SimpleNamespace(sessions=[dense.made(1, 60)])
    monkeypatch.setattr(curve, "refined", lambda of, beside, best: best)
    monkeypatch.setattr(curve, "cancels", lambda *of: False)
    monkeypatch.setattr(curve, "is_like_hysteresis", lambda *of: alike)
    monkeypatch.setattr(
        curve, "PiecesByLine", lambda s: lambda straight, beside, t: np.array([9.0 * (t == (B,))])
    )
    asked, told = [], Found(lags[1], decide.Decision(accepted, p, 0.0, 1.0, np.zeros(1)))
    monkeypatch.setattr(curve.ByPieces, "_judged", lambda self, *of: asked.append(of) or told)
    by = curve.ByPieces(one, [TEMP], pool, None, 8 - slots)
    assert by._memory([]) == ([told] if kept else [])
    assert asked == ([(lags[1], [], (B,), 2)] if slots else [])


def test_a_curve_bends_in_every_slot_that_is_left_at_places_evenly_apart():
    made = [warm()]
    line = (Term("temp", centre=25.0),)
    for taken, bends in ((0, 7), (5, 2), (6, 0)):
        every = curve.smooth_curve(made, line, taken)
        assert len(every) == bool(bends)
        for one in every:
            slope, *knots = one.terms
            assert (slope.lo, slope.hi, slope.knot) == (15.0, 35.0, None)
            at = 20.0 + 10.0 * np.arange(1, bends + 1) / (bends + 1)
            assert [t.knot + 25.0 for t in knots] == pytest.approx(at)
    assert curve.smooth_curve(made, (), 0) == []
    by = curve.ByPieces(SimpleNamespace(sessions=made), (), [], None, 0)
    assert by._curve([]) == [] == by._kink([])


@pytest.mark.parametrize(
    ("degc", "p", "accepted", "found"),
    [
        *((10.0, 0.01, True, True), (10.0, 0.011, True, False), (10.0, 0.009, False, False)),
        *((0.1, 0.011, True, True), (0.1, 1.0, True, True)),
    ],
)
def test_a_curve_is_likely_and_bends_in_the_slots_that_others_leave(
    monkeypatch, degc, p, accepted, found
):
    made, line = [warm(temp=np.linspace(20.0, 20.0 + degc, 50))], (TEMP,)
    told = [Found(None, decide.Decision(accepted, p, 0.0, 1.0, np.array([g]))) for g in (1.0, 2.0)]
    smooth, kink = candidate(A, B, C), candidate(D)
    asked = []
    monkeypatch.setattr(curve, "smooth_curve", lambda *of: asked.append(of) or [smooth])
    monkeypatch.setattr(curve.ByPieces, "_kink", lambda self, beside: [kink])
    judge = lambda self, c, *of: asked.append((c, *of)) or told[c is kink]  # noqa: E731
    monkeypatch.setattr(curve.ByPieces, "_judged", judge)
    by = curve.ByPieces(SimpleNamespace(sessions=made), line, [], None, 1)
    assert by._curve([Found(candidate(A, B), None)], 1) == (told[::-1] if found else [])
    assert asked == [
        (made, line, 4),
        *((smooth, [A, B], (B, C), 1), (kink, [A, B], (D,), 1)),
    ]


@pytest.mark.parametrize(
    ("curves", "memories", "kinds"),
    [
        ([], [], ["supply"]),
        ([5.0], [], ["supply", curve.KIND]),
        ([5.0], [7.0], ["supply", "thermal-lag", curve.KIND]),
        ([], [7.0], ["supply", "thermal-lag"]),
    ],
)
def test_what_gains_more_is_taken_first_and_the_curve_gets_the_slots_that_are_left(
    monkeypatch, curves, memories, kinds
):
    asked = []

    def way(kind, gains):
        def look(self, some, kept=0):
            asked.append((kind, [f.candidate.kind for f in some], kept))
            every = [decide.Decision(True, 0.0, 0.0, 1.0, np.array([gain])) for gain in gains]
            return [Found(candidate(A, kind=kind), decision) for decision in every]

        return look

    monkeypatch.setattr(curve.ByPieces, "_curve", way(curve.KIND, curves))
    monkeypatch.setattr(curve.ByPieces, "_memory", way("thermal-lag", memories))
    before = [Found(candidate(A, kind="supply"), None)]
    told = curve.ByPieces(None, [], [], None, 0).look(before)
    assert [f.candidate.kind for f in told] == kinds
    assert asked[:2] == [(curve.KIND, ["supply"], 1), ("thermal-lag", ["supply"], 1)]
    if memories:
        assert asked[2] == (curve.KIND, ["supply", "thermal-lag"], 0)
    if curves:
        assert asked[-1] == (curve.KIND, kinds[:-1], 0)


@pytest.mark.parametrize(("blocks", "shows"), [(None, True), (1, False)])
def test_a_curve_takes_enough_rests_and_each_power_once(blocks, shows):
    least = curve.PIECES * curve.LEAST_OF_A_PIECE
    s = dense.made(1, least + 3, gap=range(3 + (blocks or 0)))
    assert curve.shows_a_curve(s) is shows
    kinds = ("temperature-quadratic", "temperature-cubic", "temperature-cubic", "vibration")
    terms = [replace(TEMP, power=p, centre=c) for p, c in ((2, 1.0), (3, 2.0), (3, 3.0), (1, 4.0))]
    pool = [candidate(t, kind=kind) for t, kind in zip(terms, kinds)]
    assert [t.centre for t in curve.powers(pool)] == [1.0, 3.0]


# --- places of steps ---


def test_before_a_step_is_nothing_and_of_the_block_with_it_in_the_share_behind_it():
    session = Session("x", 20.0, 4, np.zeros((6, 3)), np.ones(6), {})
    told = step_places.heavisides(session, np.array([2.0, 2.25, 5.5, 0.0]))
    assert told[:, 0].tolist() == [0, 0, 1, 1, 1, 1]
    assert told[:, 1].tolist() == [0, 0, 0.75, 1, 1, 1]
    assert told[:, 2].tolist() == [0, 0, 0, 0, 0, 0.5] and (told[:, 3] == 1).all()
    weight = np.ones(24)
    weight[8:10] = 0.0  # the first half of block 2 was no rest
    half = replace(session, tick_weight=weight)
    assert step_places.heavisides(half, np.array([2.25]))[2, 0] == 1.0
    assert step_places.heavisides(half, np.array([2.75]))[2, 0] == 0.5
    none = replace(session, tick_weight=np.zeros(24))
    assert step_places.heavisides(none, np.array([2.25]))[2, 0] == 0.75


@pytest.mark.parametrize(("blocks", "places"), [(100, 86), (15, 1), (14, 0), (3, 0)])
def test_a_step_is_looked_for_away_from_either_end(blocks, places):
    session = Session("x", 20.0, 1, np.zeros((blocks, 3)), np.ones(blocks), {})
    assert step_places.tried(session) == places
    ground = step_places._ground(session)
    assert len(ground) == places
    if places:
        assert (ground[0], ground[-1]) == (10, blocks - 5)


def test_no_step_is_looked_for_beside_motion():
    ticks = np.zeros((40, 3))
    ticks[20:22] = np.nan
    session = Session("x", 20.0, 1, np.zeros((40, 3)), np.ones(40), {}, ticks_dps=ticks)
    assert sorted(set(range(10, 36)) - set(step_places._ground(session))) == [20, 21, 22]


@pytest.mark.parametrize(("ramp", "sharper"), [(0.0, (20.0, 1e9)), (12.0, (-1e9, -10.0))])
def test_a_step_explains_more_than_a_ramp_and_a_ramp_more_than_a_step(ramp, sharper):
    made = [dense.made(seed, 60) for seed in (4, 5)]
    for s in made:
        s.rate_dps[:] = np.random.default_rng(int(s.name[1])).normal(size=(60, 3))
    change = np.clip((np.arange(60) + 0.5 - 32.0) / max(ramp, 1.0) + 0.5 * bool(ramp), 0, 1)
    made[1].rate_dps[:] += np.outer(change, [9.0, -9.0, 9.0])
    assert sharper[0] < step_places.beyond_ramps(Regression(made), [A], 1, 32.0) < sharper[1]


def test_where_the_device_did_not_rest_a_step_may_be_at_either_end():
    session = Session("x", 20.0, 1, np.zeros((20, 3)), np.ones(20), {})
    assert step_places._around(session, 7.0).tolist() == np.arange(6.25, 7.76, 0.25).tolist()
    gap = replace(session, weight=(~np.isin(np.arange(20), (6, 7, 8, 9))).astype(float))
    around = step_places._around(gap, 8.0)
    assert {6.0, 10.0, 8.0, 5.25, 10.75} <= set(around) and around.max() == 10.75
    near = replace(session, weight=(~np.isin(np.arange(20), (1, 2, 19))).astype(float))
    assert {1.0, 3.0} <= set(step_places._around(near, 2.0))
    assert step_places._around(near, 19.5).max() == 20.25


# --- the catalogue ---


def warm(blocks=50, seed=0, **more):
    rng = np.random.default_rng(seed)
    sources = {
        "temp": np.linspace(20.0, 30.0, blocks),
        "acc_x": np.linspace(-0.2, 0.3, blocks),
        "acc_y": np.zeros(blocks),
        "acc_z": np.ones(blocks),
        "vib": np.full(blocks, 0.1),
        "vdd_mv": 5000 + 20 * rng.normal(size=blocks),
        "load": rng.normal(size=blocks),
        **more,
    }
    return Session(f"w{seed}", 20.0, 1, rng.normal(size=(blocks, 3)), np.ones(blocks), sources)


def test_a_source_s_range_leaves_out_extremes_that_no_several_blocks_share():
    session = warm(blocks=200)
    session.sources["load"][[3, 50, 90]] = [99.0, 98.0, 97.0]
    span = ranges([session])
    load = np.sort(session.sources["load"])
    few = int(1 + 0.01 * 200)
    assert few == 3 and span["load"] == (load[few], load[-1 - few], pytest.approx(load.mean()))
    assert span["load"][1] < 10
    assert span["temp"] == (20.0, 30.0, pytest.approx(25.0))
    assert span["time"] == (10.0, 3990.0, pytest.approx(2000.0))
    unseen = replace(session, weight=(np.arange(200) < 100).astype(float))
    assert ranges([unseen])["temp"][1] == session.sources["temp"][99]
    two = ranges([session, warm(blocks=2, seed=1)])
    assert two["temp"][:2] == (20.0, 30.0) and set(two) == set(span)
    tiny = ranges([warm(blocks=2)])["load"]
    assert tiny[0] <= tiny[1]


def of_kind(found, kind):
    return [c for c in found if c.kind == kind]


def test_candidates_are_the_rows_of_effects_in_their_places():
    session = warm()
    found, span = candidates([session]), ranges([session])
    [bend] = of_kind(found, "temperature-quadratic")
    assert bend.terms == (Term("temp", 15.0, 35.0, span["temp"][2], power=2),) and not bend.refine
    cubic, kinks = (of_kind(found, f"temperature-{kind}") for kind in ("cubic", "kink"))
    assert [c.terms[0].centre for c in cubic] == [span["temp"][2], 20.0, 30.0]
    at = 20 + 10 * np.arange(0.15, 0.9, 0.1) - span["temp"][2]
    assert [c.terms[0].knot for c in kinks] == pytest.approx(at)
    assert (cubic[0].refine, kinks[0].refine) == (("centre",), ("knot",))
    assert not of_kind(found, "temperature-peak")  # it only ever rises here: no memory of anything
    [drift], decay = of_kind(found, "time-drift"), of_kind(found, "power-on-transient")
    assert drift.terms[0].centre == 0.0 and drift.sources == ["time"]
    assert len(decay) == 7 and decay[0].sources == [] and decay[0].terms[0].lo == -np.inf
    [volts], [squared] = of_kind(found, "supply-voltage"), of_kind(found, "squared-acceleration")
    assert volts.sources == ["vdd_mv"] and volts.slots == volts.terms and not volts.is_free
    both = of_kind(found, "supply-temperature")
    assert len({(c.terms[0].centre, c.terms[0].second_centre) for c in both}) == len(both) == 9
    assert (both[0].terms[0].second_lo, both[0].terms[0].second_hi) == (15.0, 35.0)
    first, reach = squared.terms[0], max(-span["acc_x"][0], span["acc_x"][1])
    assert (first.lo, first.hi, first.centre) == (-reach, reach, 0.0)
    assert not of_kind(found, "vibration") and not of_kind(found, "rate-scale")
    # the supply comes before the load, and has the two's product
    pairs = {(c.terms[0].source, c.terms[0].second) for c in of_kind(found, "channel-product")}
    assert pairs == {("load", "temp"), ("vdd_mv", "temp"), ("vdd_mv", "load")}
    curves = of_kind(found, "channel-curve")
    assert {(c.family, c.is_free, len(c.slots)) for c in curves} == {("generic", True, 1)}
    assert {c.label for c in curves} == {"channel-curve(vdd_mv)", "channel-curve(load)"}
    assert volts.label == "supply-voltage"


@pytest.mark.parametrize(
    ("name", "least"), [("temp", 0.3), ("acc_x", 0.1), ("rate_y", 2.0), ("load", 1e-12)]
)
def test_a_source_that_hardly_moves_shows_nothing(name, least):
    sessions = [warm(), warm()]
    sessions[0].sources[name] = np.zeros(50)
    for times in (0.97, 1.03):
        sessions[1].sources[name] = np.linspace(0.0, times * least, 50)
        assert bool(varies(name, sessions)) is (times > 1)
    assert varies("time", sessions)


@pytest.mark.parametrize("name", ["vdd_mv", "VBAT", "Supply 5V", "my_volts", "vcc"])
def test_a_supply_is_told_by_its_name(name):
    assert catalogue.is_supply(name) and not catalogue.is_supply("load")
    assert catalogue.extra_channels(warm()) == ("vdd_mv", "load")


def test_what_does_not_vary_or_was_not_recorded_is_no_candidate():
    still = warm(temp=np.full(50, 20.0), acc_x=np.zeros(50))
    found = candidates([still])
    assert not [c for c in found if "temp" in c.sources or "acc_x" in c.sources]
    bare = replace(warm(), sources={})
    assert {c.kind for c in candidates([bare])} == {"time-drift", "power-on-transient"}
    turning = warm(**{f"rate_{a}": np.linspace(0.0, 9.0, 50) for a in "xyz"})
    ticks = turning.blocks * turning.ticks_per_block
    for moves_s, delay, told in ((30, [], False), (50, [], True), (50, None, False)):
        # what motion tells by samples beside a reference is no effect to look for
        at_rest = np.where(np.arange(ticks) * turning.tick_s < moves_s, np.nan, 0.0)
        known = replace(turning, delay=delay, ticks_dps=np.tile(at_rest[:, None], 3))
        assert bool(of_kind(candidates([known, turning]), "rate-scale")) is not told
    shaken = candidates([warm(vib=np.linspace(0.0, 1.0, 50))])
    assert of_kind(shaken, "vibration")


def test_a_late_part_adds_lags_or_the_rate_of_temperature_times_its_slope():
    late, lags = catalogue.late([warm()]), catalogue.lags([warm()])
    assert [[t.lag_s for t in c.terms] for c in late] == [[1.0, 1.0], [8.0, 8.0]]
    assert {c.terms[1].second_centre for c in late} == {lags[0].centre} == {25.0}
    every = [(s, k, k == 2) for s in (5, 15, 45, 135, 405, 1215) for k in (1, 2)]
    assert [(t.lag_s, t.power, t.power_first) for t in lags] == every
    bare = replace(warm(), sources={})
    assert catalogue.late([bare]) == [] == catalogue.lags([bare])


# --- names ---


@pytest.mark.parametrize(
    ("kind", "lag_s", "name", "mode"),
    [
        ("thermal-rate", 50.0, "thermal-rate", "rate"),
        ("thermal-rate", 50.1, "thermal-lag", "difference"),
        ("thermal-lag", 40.0, "thermal-rate", "rate"),
        ("thermal-lag", 400.0, "thermal-lag", "difference"),
    ],
)
def test_a_rate_and_a_lag_are_named_by_their_seconds(kind, lag_s, name, mode):
    one = candidate(Term("temp", lag_s=lag_s, lag_mode="rate"), kind=kind)
    named = naming.named(one, np.ones((1, 3)))
    assert named.kind == name and named.terms[0].lag_mode == mode


def test_a_matrix_is_named_by_where_most_of_it_is():
    rates = candidate(*(Term(f"rate_{a}") for a in "xyz"), kind="rate-scale")
    aside = np.array([[0, 1, -1], [-1, 0, 1], [1, -1, 0]])
    for diagonal, name in (  # nine tenths of the squares are those of 4.24, a tenth of 0.471
        *((-4.3, "scale-factor"), (4.2, "scale-factor+cross-axis")),
        *((-0.48, "scale-factor+cross-axis"), (0.46, "cross-axis")),
    ):
        assert naming.named(rates, diagonal * np.eye(3) + aside).kind == name
    same = candidate(A)
    assert naming.named(same, np.ones((1, 3))) is same


def test_groups_alike_share_the_posterior_by_the_levels_of_their_families(sessions):
    for s in sessions:
        s.sources["twin"] = s.sources["a"] * 1.0001
    regression = Regression([dense.following(s) for s in sessions])
    lagged = candidate(Term("a", lag_s=0.1, lag_mode="lag"), kind="channel-lag", family="generic")
    plain = candidate(Term("twin"), kind="channel", family="generic")
    catalogued = candidate(A, kind="vibration")
    far = candidate(B, kind="supply-voltage")
    every = [lagged, plain, catalogued, far]
    ratios = regression.gains([], [c.terms for c in every]).sum(axis=1)
    found = naming.posterior(regression, [], lagged, every, ratios)
    assert found[0][0] is catalogued and far not in [c for c, _ in found]
    nats = {c.label: n for c, n in found}
    assert nats["vibration"] - nats["channel(twin)"] == pytest.approx(np.log(50), abs=0.1)
    # a group of two places has half the weight where one of them alone fits
    twice = [catalogued, candidate(B, kind="vibration"), plain]
    ratios = regression.gains([], [c.terms for c in twice]).sum(axis=1)
    again = dict(naming.posterior(regression, [], plain, twice, ratios))
    assert again[catalogued] - again[plain] == pytest.approx(np.log(25), abs=0.1)


def test_a_curve_that_was_drawn_pays_for_its_form():
    curve = Term("a", -4.0, 4.0)
    drawn = candidate(replace(curve, table=tuple(np.linspace(-1, 1, 9) ** 3)))
    assert naming._coefficients(drawn) == 3 + len(parts(curve)) - 1
    assert naming._coefficients(candidate(A)) == 3


def test_the_likeliest_is_named_with_what_else_it_may_be(sessions):
    regression = Regression([dense.following(s) for s in sessions])
    lagged = candidate(Term("a", lag_s=0.1, lag_mode="lag"), kind="channel-lag", family="generic")
    pool_ = [candidate(A, kind="vibration"), candidate(B, kind="supply-voltage")]
    decision = decide.Decision(True, 0.0, 0.0, 1.0, np.zeros(1))
    found = [Found(lagged, decision)]
    naming.name_found(regression, (), found, pool_, 0, lambda own, others: own.terms != (A,))
    assert found[0].candidate.kind == "channel-lag", "the likelier one does not pass"
    naming.name_found(regression, (), found, pool_, 0, lambda own, others: True)
    assert found[0].candidate.kind == "vibration" and found[0].confounded_with == []
    assert found[0].probabilities["vibration"] > 0.95
    twin = candidate(replace(A, centre=1.0), kind="channel", family="generic")
    kept = [Found(lagged, decision, {"other": 0.0})]
    naming.name_found(regression, (), kept, [*pool_, twin], 1, lambda own, others: True)
    assert kept[0].candidate.kind == "channel-lag"
    assert set(kept[0].rivals) == {"other", "vibration"}
    slope = [Found(candidate(TEMP, kind="temperature-polynomial"), decision)]
    naming.name_found(regression, (), slope, pool_, 0, lambda own, others: True)
    assert slope[0].candidate.kind == "temperature-polynomial"


def test_chances_are_those_of_the_nats_and_the_least_are_not_told():
    decision = decide.Decision(True, 0.0, 0.0, 1.0, np.zeros(1))
    found = Found(candidate(A, kind="vibration"), decision, {"b": 1.0, "c": -5.0})
    assert list(found.probabilities) == ["b", "vibration"] and found.confounded_with == ["b"]
    assert found.probabilities["b"] == pytest.approx(np.e / (1 + np.e + np.exp(-5)))


def test_earth_is_named_beside_what_follows_a_pose_and_is_no_larger(sessions):
    for s in sessions:
        s.sources["acc_x"] = np.sign(s.sources["a"])
    earthly = [replace(s, earth=Earth(np.zeros((s.blocks, 3)), 0.004, "")) for s in sessions]
    term = Term("acc_x")
    decision = decide.Decision(True, 0.0, 0.0, 1.0, np.zeros(1))

    def beside(kind, size, some):
        found = [Found(candidate(term, kind=kind), decision)]
        naming.name_earth(found, [B, term], np.array([[9.0] * 3, [size, 0, 0]]), some)
        return found[0].confounded_with

    assert beside("linear-acceleration", 0.002, earthly) == ["earth-rotation"]
    assert beside("squared-acceleration", 0.002, earthly) == ["earth-rotation"]
    assert beside("linear-acceleration", 0.5, earthly) == []
    assert beside("vibration", 0.002, earthly) == []
    assert beside("linear-acceleration", 0.002, sessions) == []


# --- refinement, slots, selections, lines ---


def test_where_any_curve_will_do_it_is_told_by_the_recordings():
    regression, same = Regression([dense.made(seed, 100) for seed in (1, 2)]), candidate(A)
    assert refine.drawn(regression, [], same) is same
    curve = Term("a", -4.0, 4.0)
    for some in (candidate(*parts(curve), kind="x"), candidate(replace(curve, table=(0.5,) * 9))):
        told = refine.drawn(regression, [B], some)
        assert told.terms == (draw(regression, [B], some.terms[0])[0],) and told.kind == some.kind


LAG = Term("temp", lag_s=9.0, lag_mode="lag")
PLAY = Term("temp", memory="play", width=1.0)


@pytest.mark.parametrize(
    ("terms", "taken", "fits"),
    [
        ([LAG] * 8, 0, True),
        ([LAG] * 9, 0, False),
        ([LAG] * 6, 2, True),
        ([LAG] * 6, 3, False),
        ([replace(PLAY, width=float(w)) for w in range(1, 7)] + [LAG] * 8, 0, True),
        ([replace(PLAY, width=float(w)) for w in range(1, 8)], 0, False),
        ([replace(PLAY, width=float(w), power=p) for w in range(1, 7) for p in (1, 2)], 0, True),
        ([replace(LAG, delay_s=float(d)) for d in (1, 2)], 0, True),
        ([replace(LAG, delay_s=float(d)) for d in (1, 2, 3)], 0, False),
        ([replace(LAG, table=(0.0,) * 9)] * 2, 0, True),
        ([replace(LAG, table=(0.0,) * 9)] * 3, 0, False),
        ([Term(f"c{k}", second=f"d{k}") for k in range(4)] + [Term("time"), Term("one")], 0, True),
        ([Term(f"c{k}", second=f"d{k}") for k in range(4)] + [Term("c9")], 0, False),
    ],
)
def test_what_the_board_has_room_for(terms, taken, fits):
    assert fits_in_slots(terms, taken) is fits


def test_a_selection_with_less_in_it():
    decision = decide.Decision(True, 0.0, 0.0, 1.0, np.zeros(1))
    found = [Found(candidate(A, B), decision), Found(candidate(TEMP), decision)]
    line = (Term("temp"),)
    whole = Selection(found, [], 0, None, line, (), [], {})
    assert whole.terms == [A, B, TEMP] and whole.straight == ()
    assert whole.first(1).straight == line and whole.first(1).found == found[:1]
    assert whole.without(0).found == found[1:] and whole.without(1).found == found[:1]
    less = whole.without_axes(0, (True, False, False), "worse")
    assert less.found[0].axes == (False, True, True) and less.found[1] is found[1]
    assert less.applied.tolist() == [[0, 1, 1], [0, 1, 1], [1, 1, 1]]
    gone = less.without_axes(0, (False, True, True), "worse")
    assert gone.found == found[1:] and gone.withdrawn == [("vibration", "worse")]
    assert found[0].axes == (True, True, True) and whole.first(0).applied.shape == (0, 3)
    alone = replace(whole, alone=True)
    assert alone.stands_alone and not replace(alone, judged_again=True).stands_alone
    assert not whole.stands_alone


@pytest.mark.parametrize(
    ("quick", "slow", "same"),
    [
        (10.1, 0.1, True),
        (9.9, 0.1, True),
        (10.1, 0.13, False),
        (10.5, 0.5, True),
        (10.1, 0.119, True),
    ],
)
def test_a_slow_line_may_be_a_quick_one_as_ticks_show_it(quick, slow, same):
    lines = [Line(hz, np.ones(3), 1e-9, True) for hz in (quick, slow)]
    assert periodic._folds(*lines, 1.0) is same


def with_ticks(rate, name="x", temp=None):
    sources, blocks = {} if temp is None else {"temp": temp}, rate.reshape(-1, 20, 3).mean(axis=1)
    return Session(name, 20.0, 20, blocks, np.ones(len(blocks)), sources, ticks_dps=rate)


def test_a_line_in_ticks_is_found_where_there_are_enough_of_them_at_rest():
    t = np.arange(2000.0)
    wave = 4e-3 * np.sin(2 * np.pi * t / 50)[:, None]
    made = [
        with_ticks(np.random.default_rng(k).normal(0, 1e-3, (2000, 3)) + wave, str(k))
        for k in range(4)
    ]
    (line,) = periodic.periodic(made[:3], made[3:], [], np.zeros((0, 3)))
    assert line.hz == pytest.approx(1 / 50, rel=0.03) and line.in_holdout
    torn = [replace(s, ticks_dps=s.ticks_dps.copy()) for s in made]
    torn[0].ticks_dps[:190] = np.nan
    assert periodic.periodic(torn[:3], torn[3:], [], np.zeros((0, 3)))
    torn[0].ticks_dps[:210] = np.nan
    assert periodic.periodic(torn[:3], torn[3:], [], np.zeros((0, 3))) == []
    short = [with_ticks(s.ticks_dps[:380], s.name) for s in made]
    assert periodic.periodic(short[:3], short[3:], [], np.zeros((0, 3))) == []
    none = [replace(s, ticks_dps=None) for s in made]
    assert periodic.periodic(none[:3], none[3:], [], np.zeros((0, 3))) == []


def test_a_line_that_a_term_explains_is_none_and_one_that_it_makes_is_none():
    t = np.arange(2000.0)
    temp = 25 + np.sin(2 * np.pi * t / 50)
    rng = np.random.default_rng(0)
    noise = [rng.normal(0, 1e-3, (2000, 3)) for _ in range(4)]
    term, told = Term("temp", centre=25.0), np.full((1, 3), 4e-3)
    moved = [
        with_ticks(n + np.outer(temp - 25, told[0]), str(k), temp) for k, n in enumerate(noise)
    ]
    assert periodic.periodic(moved[:3], moved[3:], [], np.zeros((0, 3)))
    assert periodic.periodic(moved[:3], moved[3:], [term], told) == []
    still = [with_ticks(n, str(k), temp) for k, n in enumerate(noise)]
    assert periodic.periodic(still[:3], still[3:], [term], told) == []


@pytest.mark.parametrize(
    ("name", "least", "most"),
    [
        *(("lag_s", 8.0, 7200.0), ("delay_s", 1.0, 1200.0), ("decay_s", 40.0, 14400.0)),
        ("width", 0.3, 30.0),
    ],
)
def test_what_is_refined_stays_within_what_the_firmware_and_a_recording_can_hold(name, least, most):
    for sign, start, end in ((1, 1.5 * least, least), (-1, most / 1.5, most)):
        told = SimpleNamespace(
            gains=lambda terms, trial, sign=sign: np.array([[-sign * getattr(trial[0][0], name)]]),
            forget=lambda term: None,
        )
        one = candidate(Term("a", **{name: start}), refine=(name,))
        found = getattr(refine.refined(told, [], one).terms[0], name)
        assert found == pytest.approx(end, rel=0.03)
        assert least * 0.999 <= found <= most * 1.001


BOTH = Term("a", 2.0, 12.0, 7.0, second="b", second_lo=2.0, second_hi=12.0, second_centre=7.0)


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("name", ["knot", "centre", "second_centre"])
def test_a_place_is_refined_by_a_fifth_of_the_range_seen_at_most(name, sign):
    told = SimpleNamespace(
        gains=lambda terms, trial: np.array([[sign * getattr(trial[0][0], name)]]),
        forget=lambda term: None,
    )
    one = candidate(replace(BOTH, knot=7.0), refine=(name,))
    found = getattr(refine.refined(told, [], one).terms[0], name)
    seen = 10.0 / (1.0 + 2.0 * MARGIN)
    assert found == pytest.approx(7.0 + sign * 0.2 * seen, abs=0.03 * seen)


def test_quick_lines_are_of_the_samples_where_all_recordings_have_them_alike():
    def with_spectrum(step_hz, peak):
        power = np.ones((200, 3))
        power[40] += peak
        welch = Spectrum(power, step_hz, 50.0)
        return Session("x", 20.0, 1, np.zeros((9, 3)), np.ones(9), {}, welch=welch)

    none = np.zeros((0, 3))
    loud = [with_spectrum(0.1, 100.0) for _ in range(3)]
    (line,) = periodic.periodic(loud[:2], loud[2:], [], none)
    assert line.hz == pytest.approx(4.0) and line.in_holdout
    assert periodic.periodic(loud[:2], [with_spectrum(0.2, 100.0)], [], none) == []
    assert periodic.periodic(loud[:2], [replace(loud[2], welch=None)], [], none) == []
    slow = [with_spectrum(0.01, 100.0) for _ in range(3)]
    assert periodic.periodic(slow[:2], slow[2:], [], none) == []  # ticks show what is so slow
