"""Which hysteresis is taken, of one recording and of several, and what speaks against it."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.stats import chi2
from zerorate_tools.loop.search import hysteresis
from zerorate_tools.loop.search.hysteresis import AS_WELL, BETTER, KIND
from zerorate_tools.model.term import Term

from . import dense
from .dense import A, B, C, D
from .selections import candidate

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
