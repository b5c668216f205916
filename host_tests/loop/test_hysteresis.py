"""Hysteresis of many widths is found where a course can show it, and nowhere else; which is taken,
and what speaks against it."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.stats import chi2
from zerorate_bench.loop.added_effects import PRANDTL_ISHLINSKII, PRANDTL_ISHLINSKII_KNOWN
from zerorate_bench.loop.simulated import simulate
from zerorate_tools.loop.fit.line import ordinary
from zerorate_tools.loop.fit.regression import Regression, predicted
from zerorate_tools.loop.fit.single import PiecesByLine
from zerorate_tools.loop.read.sessions import Session
from zerorate_tools.loop.search import hysteresis
from zerorate_tools.loop.search.catalogue import candidates
from zerorate_tools.loop.search.curve import powers
from zerorate_tools.loop.search.hysteresis import (
    AS_WELL,
    BETTER,
    KIND,
    may_show,
    of_a_pair,
    of_one_recording,
    play_operators,
)
from zerorate_tools.loop.search.select import select, straight_line
from zerorate_tools.model import Slot, build_model
from zerorate_tools.model.term import Term, play
from zerorate_tools.recordings import Scales

from . import dense
from .dense import A, B, C, D
from .selections import candidate

SCALES = Scales("MPU-6050", 1.0, 131.0, 16384.0, 340.0, 36.53)
DOWN_UP_DOWN = ((0, 50.0), (80, -15.0), (180, 75.0), (240, 35.0))
WARMED_ONCE = ((0, 20.0), (240, 60.0))
BLOCKS, TICKS, BLOCK_S = 240, 34, 34.0


PLAYS = ((4.0, 1.0), (12.0, 0.7), (30.0, 1.5))


def recording(course, seed=1, hysteresis=1.0, walk=0.0, cubic_dps=0.0, plays=PLAYS, lopsided=0.1):
    """One recording in a chamber; hysteresis in tenths of a dps, walk in dps a block, cubic of so
    many dps at 40 degC; plays: radii in degC, and weights."""
    rng = np.random.default_rng(seed)
    at = (np.arange(BLOCKS * TICKS) + 0.5) / TICKS
    degc = np.interp(at, *zip(*course)) + rng.normal(0, 0.02, len(at))
    total = sum(
        w * (play(degc, 2 * r) - degc) / r + w * lopsided * (play(degc, 2 * r) / 40) ** 2
        for r, w in plays
    )
    effect = total.reshape(BLOCKS, TICKS).mean(axis=1)
    mean = degc.reshape(BLOCKS, TICKS).mean(axis=1)
    rate = np.outer(mean, (0.004, -0.003, 0.002)) + np.outer((mean / 40) ** 2, (0.1, 0.05, -0.1))
    rate += np.outer((mean / 40) ** 3, cubic_dps * np.array([1.0, -1.0, 0.5]))
    rate += 0.1 * hysteresis * np.outer(effect, (1.0, -0.3, 0.4))
    rate += rng.normal(0, 0.003, rate.shape) + np.cumsum(rng.normal(0, walk, rate.shape), axis=0)
    return Session("chamber", BLOCK_S, TICKS, rate, np.ones(BLOCKS), {"temp": degc})


def left(session, terms):
    """(3,) RMS dps of pieces left out in turn."""
    residual = PiecesByLine(session).residual(straight_line([session]), terms)
    return np.sqrt(np.nanmean(residual**2, axis=0))


def fitted_left(session, terms):
    """RMS dps that terms fitted to all of it leave."""
    rate = session.rate_dps - predicted(terms, ordinary(terms, [session]), session)
    return np.sqrt((session.less_offsets(rate, session.available) ** 2).mean())


def test_a_chamber_s_loop_is_named_and_taken_away_on_pieces_left_out():
    session = recording(DOWN_UP_DOWN)
    found = select([session], on_pieces=PiecesByLine(session)).found
    assert found[0].candidate.kind == KIND
    after = left(session, found[0].candidate.terms)
    assert (after < 0.1 * left(session, ())).all()
    slots = [Slot(t, (1e-6, 0.0, 0.0), KIND) for t in found[0].candidate.terms]
    assert len(build_model(slots, SCALES).slots) == len(slots)


def asked_of(session):
    """What the search asks a hysteresis of: fit, line, bend, pool, pieces, and slots taken."""
    pool, line = candidates([session]), straight_line([session])
    return Regression([session]), line, powers(pool), pool, PiecesByLine(session), 0


def test_a_part_warmed_once_shows_no_hysteresis():
    session = recording(WARMED_ONCE)
    assert not may_show([session]) and may_show([recording(DOWN_UP_DOWN)])
    asked = asked_of(session)
    assert of_one_recording(*asked) == (None, "") == of_a_pair(*asked[:4], 0)


@pytest.mark.parametrize(("walk", "cubic_dps"), [(0.001, 0.0), (0.0004, 0.1)])
def test_neither_noise_nor_a_bend_that_pieces_at_its_ends_are_far_out_on_is_one(walk, cubic_dps):
    session = recording(DOWN_UP_DOWN, hysteresis=0.0, walk=walk, cubic_dps=cubic_dps)
    assert of_one_recording(*asked_of(session))[0] is None


@pytest.mark.parametrize("judged_again", [False, True])
def test_a_hysteresis_that_a_lag_predicts_nearly_as_well_is_no_lag(judged_again):
    session = simulate(302010, [(PRANDTL_ISHLINSKII, 2.0)], sessions=2).sessions[0]
    found = select([session], on_pieces=PiecesByLine(session), judged_again=judged_again).found
    assert [f.candidate.kind for f in found] == [KIND]
    assert any(t.memory == "play" for t in found[0].candidate.terms) == judged_again


def test_one_recording_names_a_hysteresis_that_predicts_as_well_beside_the_lag():
    session = simulate(302003, [("thermal-lag", 4.0)], sessions=2).sessions[0]
    (found,) = select([session], on_pieces=PiecesByLine(session)).found
    assert (found.candidate.kind, found.confounded_with) == ("thermal-lag", [KIND])


def test_power_ons_show_more_than_one_width():
    device = simulate(300_003, [(PRANDTL_ISHLINSKII, 5.0)], sessions=4, bare=True)
    terms = [t for f in select(device.sessions[:3]).found for t in f.candidate.terms]
    assert len({t.width for t in terms if t.memory in ("backlash", "play")}) > 1


@pytest.mark.parametrize(
    "plays",
    [
        ((2.0, -1.3), (9.0, 0.7), (40.9, -1.4), (46.0, -1.0)),
        ((2.5, 1.2), (3.1, 1.3), (27.4, -0.9), (42.9, -1.5)),
    ],
)
def test_operators_of_fixed_widths_stand_for_those_of_any(plays):
    session = recording(DOWN_UP_DOWN, plays=plays, lopsided=0.5)
    line = straight_line([session])
    beside = [*line, replace(line[0], power=2)]
    operators = play_operators([session])
    assert fitted_left(session, [*beside, *operators]) < 0.1 * fitted_left(session, beside)


def test_a_wide_loop_that_is_gone_through_one_way_is_no_memory_of_a_peak():
    sessions = simulate(304_020, [(PRANDTL_ISHLINSKII_KNOWN, 2.0)], 4).sessions
    assert [f.candidate.kind for f in select(sessions[:-1]).found] == [KIND]


@pytest.mark.parametrize("seed", range(10_000, 10_008))
def test_noise_makes_no_hysteresis_likely(seed):
    made = simulate(seed, [], 1, bare=True).sessions
    assert of_a_pair(Regression(made), straight_line(made), (), candidates(made), 0)[0] is None


def test_a_lag_that_is_nearly_as_likely_is_named_beside_it():
    sessions = simulate(200_010, [("thermal-lag", 2.0)], 4).sessions
    (found,) = select(sessions[:-1]).found
    assert found.candidate.kind == KIND and "thermal-lag" in found.confounded_with


def test_a_bend_and_a_lag_of_one_of_two_power_ons_are_no_hysteresis():
    effects = [("temperature-quadratic", 4.0), ("thermal-lag", 4.0)]
    first, _ = simulate(302_301, effects, 2, bare=True).sessions
    found = select([first], on_pieces=PiecesByLine(first), judged_again=True).found
    bend, lag = sorted(f.candidate.kind for f in found)
    assert bend in ("temperature-kink", "temperature-curve") and lag == "thermal-lag"


TEMP = Term("temp", 10.0, 40.0, 25.0)
LOOP = candidate(Term("temp", memory="play", width=4.0), kind=KIND)
SIMPLER = [candidate(A, kind="thermal-lag"), candidate(B, kind="temperature-kink")]
POOL = [*SIMPLER, candidate(C, kind="supply-voltage")]


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
    monkeypatch, answers, nats, of_bend, simpler, fits, rivals, said
):
    told, asked = {TEMP: of_bend, A: simpler[0], B: simpler[1], C: 99.0}, []

    def evidence(regression, terms, tried):
        asked.append([*terms, *tried])
        return told[tried[0]]

    shown = (LOOP, nats) if nats else (None, 0.0)
    answers(hysteresis, likeliest=shown, fits_in_slots=fits)
    monkeypatch.setattr(hysteresis, "evidence", evidence)
    bend = [TEMP] if of_bend else []
    found, reason = hysteresis.of_a_pair(None, [D], bend, POOL, 3)
    assert (reason, found is None) == (said, rivals is None)
    if found:
        decision = found.decision
        assert (found.candidate, found.rivals) == (LOOP, pytest.approx(rivals))
        assert (decision.accepted, decision.ratio, decision.inflation) == (True, 2 * nats, 1.0)
        assert decision.p_value == pytest.approx(2 * np.exp(-nats))
        assert len(decision.session_gains) == 0
        assert asked == [[D, TEMP], [D, TEMP, A], [D, TEMP, B]]


@pytest.mark.parametrize(
    ("gain", "rival", "factor", "nats", "said"),
    [
        (9.0, 5.9, 2.6, 0.1, ""),
        (9.0, 6.1, 2.6, 1.0, AS_WELL),
        (9.0, 11.9, 2.6, 1.0, AS_WELL),
        (9.0, 12.1, 2.6, 1.0, BETTER),
        (9.0, 5.9, 2.4, 1.0, "too little of the error to tell it from the noise's walk"),
        (9.0, 5.9, 2.6, -1.0, "the kernels say no"),
        (None, 5.9, 2.6, 1.0, ""),  # the temperature never turned back
        (99.0, 5.9, 2.6, 1.0, ""),  # the board has no room
    ],
)
def test_a_hysteresis_of_one_recording_passes_every_question(
    monkeypatch, answers, gain, rival, factor, nats, said
):
    told = {LOOP.terms: gain, (A,): rival - 1, (B,): rival, (C,): 50.0}
    by_line = lambda session, hold: (  # noqa: E731
        lambda straight, bend, terms: np.array([told[tuple(terms)]]) * (bend == (TEMP,))
    )
    shown = {"may_show": gain is not None, "fits_in_slots": gain != 99.0}
    answers(hysteresis, play_operators=LOOP.terms, _factor=factor, **shown)
    monkeypatch.setattr(hysteresis, "PiecesByLine", by_line)

    def judged(*of):
        assert of == ([D], (), (TEMP, *LOOP.terms))
        return np.full(2, nats)

    judged.reason = "the kernels say no"
    gains = lambda beside, groups: np.full((1, 3), 11.0)  # noqa: E731
    one = SimpleNamespace(sessions=[dense.made(1, 60)], gains=gains)
    found, reason = hysteresis.of_one_recording(one, [D], (TEMP,), POOL, judged, 0)
    assert (reason, found is None) == (said, bool(said or gain in (None, 99.0)))
    if found:
        decision = found.decision
        assert found.candidate == candidate(TEMP, *LOOP.terms, kind=KIND)
        assert (decision.accepted, decision.ratio) == (True, 33.0)
        assert decision.p_value == pytest.approx(chi2.sf(33.0, 3))
        assert (decision.session_gains.tolist(), decision.inflation) == ([nats] * 2, 1.0)
