"""Which hysteresis is taken, of one recording and of several, and what speaks against it."""

from dataclasses import replace
from itertools import combinations
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.stats import chi2
from zerorate_tools.loop.search import hysteresis, likely_hysteresis
from zerorate_tools.loop.search.hysteresis import AS_WELL, BETTER, KIND
from zerorate_tools.model.term import Term, play

from . import dense
from .dense import A, B, C, D
from .selections import candidate, warm

TEMP = Term("temp", 10.0, 40.0, 25.0)
LOOP = candidate(Term("temp", memory="play", width=4.0), kind=KIND)
SIMPLER = [candidate(A, kind="thermal-lag"), candidate(B, kind="temperature-kink")]
POOL = [*SIMPLER, candidate(C, kind="supply-voltage")]


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
    degc = 25 + 9 * np.sin(np.arange(60) / 7)
    loops = np.column_stack([play(degc, 2 * r) ** k for r, k in ((1.0, 1), (4.0, 1), (2.5, 2))])
    size = np.array([[1.0, 300.0, 0.01], [2.0, -100.0, 0.02], [0.01, 3.0, 1e-4]])
    noise = np.random.default_rng(2).normal(size=(60, 3)) * [0.3, 60.0, 0.003]
    session = replace(dense.made(5, 60), rate_dps=loops @ size + noise, sources={"temp": degc})
    fits = hysteresis._Fits([session], [Term("temp")])
    told = sorted(fits.best(number, powers))
    assert told == widths_by_trial(fits, number, powers)
    terms = fits.terms(told[::-1], powers)
    assert [(t.width, t.power) for t in terms] == [(2 * r, k) for r in told for k in powers]


def test_widths_are_tried_as_shares_of_the_range_about_its_middle():
    sessions = [dense.made(seed, 24, names=("temp",)) for seed in (1, 2)]
    for s in sessions:
        s.sources["temp"] = temp = np.linspace(10.0, 27.0, 24)
    fits = hysteresis._Fits(sessions, [Term("temp", centre=20.0)])
    assert fits._grid[[0, -1]] == pytest.approx([17 * hysteresis._FINEST, 17 * hysteresis._WIDEST])
    assert (fits._lo, fits._hi, fits._centre) == pytest.approx((10.0, 27.0, 18.5))
    line = np.tile(temp - temp.mean(), 2)[:, None]

    def beside_the_line(values):
        off = values - values.mean(axis=0)
        return off - line @ (line.T @ off) / (line.T @ line)

    both = [s.rate_dps - s.rate_dps.mean(axis=0) for s in sessions]
    assert fits.rows == 48 and fits._y == pytest.approx(beside_the_line(np.vstack(both)))
    for power in (1, 2):
        column = np.tile(((play(temp, 6.0) - 18.5) / 8.5) ** power, 2)[:, None]
        assert fits._column(3.0, power) == pytest.approx(beside_the_line(column)[:, 0])


def test_forms_of_a_likely_hysteresis_span_all_sessions_temperatures():
    made = [warm(temp=np.linspace(*ends, 50)) for ends in ((10.0, 20.0), (14.0, 30.0))]
    every = list(likely_hysteresis._forms(made))
    assert [[t.power for t in form] for form in every] == [[1] * 4, [1, 2] * 4] * 3
    for form, finest in zip(every[::2], (0.0125, 0.025, 0.05)):
        widths = 2 * 20.0 * finest * 2.3 ** np.arange(4)
        assert [t.width for t in form] == pytest.approx(widths.tolist())
        assert {(t.lo, t.hi, t.centre) for t in form} == {(10.0, 30.0, 18.5)}


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
    answers(likely_hysteresis, likeliest=shown, fits_in_slots=fits)
    monkeypatch.setattr(likely_hysteresis, "evidence", evidence)
    bend = [TEMP] if of_bend else []
    found, reason = likely_hysteresis.of_a_pair(None, [D], bend, POOL, 3)
    assert (reason, found is None) == (said, rivals is None)
    if found:
        decision = found.decision
        assert (found.candidate, found.rivals) == (LOOP, pytest.approx(rivals))
        assert (decision.accepted, decision.ratio, decision.inflation) == (True, 2 * nats, 1.0)
        assert decision.p_value == pytest.approx(6 * np.exp(-nats))
        assert len(decision.session_gains) == 0
        assert asked == [[D, TEMP], [D, TEMP, A], [D, TEMP, B]]


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
    answers, gain, rival, p, factor, nats, said
):
    best, of_rival = gain and (gain, (TEMP,), LOOP), (SIMPLER[0], rival)
    answers(hysteresis, _with_a_bend=best, _rival=of_rival, _chance=(p, 33.0), _factor=factor)

    def judged(*of):
        assert of == ([D], (), (TEMP, *LOOP.terms))
        return np.full(2, nats)

    judged.reason = "the kernels say no"
    one = SimpleNamespace(sessions=[dense.made(1, 60)])
    found, reason = hysteresis.of_one_recording(one, [D], [()], [], judged, 0)
    assert (reason, found is None) == (said, bool(said or gain is None))
    if found:
        decision = found.decision
        assert found.candidate == candidate(TEMP, *LOOP.terms, kind=KIND)
        assert (decision.accepted, decision.p_value, decision.ratio) == (True, p, 33.0)
        assert (decision.session_gains.tolist(), decision.inflation) == ([nats] * 2, 1.0)


@pytest.mark.parametrize(
    ("nats", "chosen", "gain"),
    [((0.9, 1.9), None, 0.0), ((1.5, 2.4), 0, 0.5), ((1.1, 2.2), 1, 0.2), ((3.0, 4.0), 0, 2.0)],
)
def test_a_form_of_a_hysteresis_pays_a_nat_for_each_width(answers, nats, chosen, gain):
    one, wide = LOOP.terms[0], replace(LOOP.terms[0], width=9.0)
    forms = [(one, replace(one, power=2)), (one, wide)]
    answers(hysteresis, may_show=True, _forms=forms)
    by = lambda straight, beside, terms: np.array([nats[forms.index(terms)]])  # noqa: E731
    found, most = hysteresis.best_hysteresis([], [], [], by)
    assert most == pytest.approx(gain)
    assert found == (None if chosen is None else candidate(*forms[chosen], kind=KIND))


BENDS = [(), (A,), (A, B), (C,)]


@pytest.mark.parametrize(
    ("bends", "taken", "nats", "chosen"),
    [
        (BENDS[:2], 0, 5.1, (A,)),
        (BENDS, 0, 9.0, (A, B)),
        (BENDS, 7, 5.1, (A,)),
        (BENDS, 8, 5.0, ()),
        (BENDS[3:], 0, None, None),  # it shows no hysteresis
    ],
)
def test_a_bend_gains_with_its_hysteresis_and_both_need_their_slots(
    monkeypatch, bends, taken, nats, chosen
):
    gains = {(): 5.0, (A,): 3.0, (A, B): 9.0, (C,): 2.0}
    alone = {(A,): [1.0, 1.1], (A, B): [0.0], (C,): [9.0]}
    loops = {bend: None if bend == (C,) else replace(LOOP, family=str(bend)) for bend in BENDS}

    def best(sessions, straight, bend, by_line):
        assert (sessions, straight) == (["s"], [D])
        return loops[bend], gains[bend]

    monkeypatch.setattr(hysteresis, "best_hysteresis", best)
    by_line = lambda straight, beside, bend: np.array(alone[bend])  # noqa: E731
    told = hysteresis._with_a_bend(SimpleNamespace(sessions=["s"]), [D], bends, by_line, taken)
    assert told == (nats and (pytest.approx(nats), chosen, loops[chosen]))


def test_a_rival_is_the_simpler_effect_that_predicts_best_with_the_bend():
    told = {(D, A): [1.0, 2.0], (D, B): [4.0, -0.5], (D, C): [9.0, 9.0]}
    by_line = lambda straight, beside, terms: np.array(told[terms])  # noqa: E731
    assert hysteresis._rival([], (D,), POOL, by_line) == (SIMPLER[1], 3.5)
    one = SimpleNamespace(gains=lambda beside, groups: np.full((1, 3), 8.0))
    p, ratio = hysteresis._chance(one, [], LOOP)
    assert (p, ratio) == (pytest.approx(chi2.sf(24.0, 3) * 8 * 6), 24.0)


def test_errors_of_pieces_are_compared_with_the_best_bend_by_their_geometric_mean():
    left = {
        "whole": [[1.0, 2.0, 4.0]],
        "a": [[3.0, 3.0, 3.0], [np.nan] * 3],
        "b": [[2.0, 4.0, 8.0]],
    }
    pieces = SimpleNamespace(residual=lambda straight, terms: np.array(left[terms]))
    factor = hysteresis._factor([], ["a", "b"], "whole", pieces)
    assert factor == pytest.approx(3.0 / 2.0)
