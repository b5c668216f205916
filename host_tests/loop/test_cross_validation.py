"""What pieces left out of one recording tell by themselves."""

from dataclasses import replace

import numpy as np
import pytest
from zerorate_bench.loop.simulated import simulate
from zerorate_tools.loop.fit.line import is_slope, less_slope, ordinary
from zerorate_tools.loop.fit.single import PiecesByLine, held, nats_of
from zerorate_tools.loop.search.cross_validation import (
    POLYNOMIAL,
    SEGMENTS,
    Remembering,
    _powers,
    cancels,
    is_like_hysteresis,
    memory,
    of_memory,
    polynomial,
    remembering,
    whole_curve,
)
from zerorate_tools.loop.search.one_recording import OneRecording
from zerorate_tools.loop.search.select import Search
from zerorate_tools.loop.search.selection import Found
from zerorate_tools.model.term import Term


@pytest.fixture(scope="module")
def lagging():
    (session,) = simulate(5, [("thermal-lag", 20.0)], sessions=1, bare=True).sessions
    return Search([session])


@pytest.fixture(scope="module")
def narrow():
    """The same over two degrees."""
    (session,) = simulate(5, [("thermal-lag", 20.0)], sessions=1, bare=True).sessions
    temp = session.sources["temp"]
    session.sources["temp"] = 25.0 + 2.0 * (temp - temp.min()) / np.ptp(temp)
    return Search([session])


class Kernels:
    """Pieces as a firmware predicts them whose own curve is worth `nats` less than a slope, which
    leaves so much of its plain error."""

    reason = "-"

    def __init__(self, nats, left=1.0):
        self.nats, self.left = nats, left

    def __call__(self, straight, found, candidate):
        return np.array([self.nats if any(is_slope(t) for t in candidate) else 0.0])

    def residual(self, straight, terms):
        return np.full((9, 3), self.left if any(is_slope(t) for t in terms) else 1.0)


def by(search, judged):
    r = search.regression
    return r, search.line, [], judged, PiecesByLine(r.sessions[0]), 0


def test_a_polynomial_takes_the_place_of_a_curve_that_predicts_worse(narrow):
    found = polynomial(*by(narrow, Kernels(5.0)))
    assert found.candidate.kind == POLYNOMIAL
    assert less_slope(narrow.line, found.candidate.terms) == ()


def test_a_curve_that_predicts_as_well_keeps_its_place(narrow):
    assert polynomial(*by(narrow, Kernels(1.0))) is None


def test_a_curve_over_many_degrees_keeps_its_place(lagging):
    assert polynomial(*by(lagging, Kernels(5.0))) is None


@pytest.fixture
def wavy():
    """A bias that goes up and down twice over the range of temperature."""
    (session,) = simulate(5, sessions=1, bare=True).sessions
    temp = session.block_mean(session.sources["temp"])
    share = (temp - temp.min()) / np.ptp(temp)
    wave = 0.02 * np.sin(4 * np.pi * share)
    return Search([replace(session, rate_dps=session.rate_dps + wave[:, None])])


def test_segments_follow_what_no_cubic_does(wavy):
    r, line, _, _, by_line, taken = by(wavy, None)
    found = whole_curve(r, line, [], by_line, by_line, taken)
    assert found.candidate.kind == SEGMENTS
    cubic = [replace(line[0], power=k) for k in (2, 3)]
    left = [np.nanstd(by_line.residual(line, t)) for t in (cubic, found.candidate.terms)]
    assert left[1] < 0.7 * left[0]


@pytest.fixture
def parabolic():
    """A bias that is a parabola over temperature."""
    (session,) = simulate(5, sessions=1, bare=True).sessions
    temp = session.block_mean(session.sources["temp"])
    bent = 0.1 * ((temp - temp.mean()) / np.ptp(temp)) ** 2
    return Search([replace(session, rate_dps=session.rate_dps + bent[:, None])])


def test_powers_follow_a_parabola(parabolic):
    r, line, _, _, by_line, _ = by(parabolic, None)
    assert whole_curve(r, line, [], by_line, by_line, 0).candidate.kind == POLYNOMIAL


@pytest.mark.parametrize("left, taken", [(0.85, True), (0.95, False)])
def test_a_whole_curve_leaves_a_tenth_less(parabolic, wavy, left, taken):
    for search in (parabolic, wavy):
        r, line, _, _, by_line, _ = by(search, None)
        judged = Kernels(nats_of(1 / left, int(r.sessions[0].available.sum())))
        assert bool(whole_curve(r, line, [], judged, by_line, 0)) == taken


@pytest.mark.parametrize("nats, left, taken", [(3, 0.85, True), (3, 0.95, False), (1, 0.5, False)])
def test_segments_may_leave_a_tenth_less_of_the_plain_error(wavy, parabolic, nats, left, taken):
    judged = Kernels(nats, left)
    for search in (wavy, parabolic):  # of a parabola in the place of one, too
        r, line, _, _, by_line, _ = by(search, None)
        found = whole_curve(r, line, [], judged, by_line, 0)
        assert (found.candidate.kind if found else None) == (SEGMENTS if taken else None)
        assert whole_curve(r, line, [], judged, by_line, 0, by_error=False) is None


def test_powers_are_held_or_reach_as_far_beyond_as_pieces_do(parabolic):
    r, line, _, _, by_line, _ = by(parabolic, None)
    held_at, going_on = (_powers(r, line, by_line)[k][0] for k in (0, 2))
    degc = r.sessions[0].block_mean(r.sessions[0].sources["temp"])
    parts = [degc[p.available] for p in by_line.parts]
    beyond = max(degc.max() - min(p.max() for p in parts), max(p.min() for p in parts) - degc.min())
    assert held_at.lo - going_on.lo == pytest.approx(beyond)
    assert going_on.hi - held_at.hi == pytest.approx(beyond)


def test_segments_have_to_predict_clearly_better_than_what_was_found(wavy, lagging):
    by_line = PiecesByLine(wavy.regression.sessions[0])
    assert whole_curve(wavy.regression, wavy.line, [], Kernels(1.0), by_line, 0) is None
    by_line = PiecesByLine(lagging.regression.sessions[0])
    assert whole_curve(lagging.regression, lagging.line, [], by_line, by_line, 0) is None


def test_segments_take_the_slots_that_motion_leaves_or_none(wavy):
    r, line, found, _, by_line, _ = by(wavy, None)
    assert len(whole_curve(r, line, found, by_line, by_line, 2).candidate.terms) == 6
    assert whole_curve(r, line, found, by_line, by_line, 4) is None


def test_a_lag_is_found_by_pieces_alone(lagging):
    r, line, found, _, by_line, taken = by(lagging, None)
    best = memory(r, line, found, lagging.pool, by_line, by_line, taken)
    assert best.candidate.kind == "thermal-lag"
    assert not cancels(r.sessions, line, best.candidate.terms)


def test_a_lag_that_the_likelihood_does_not_show_is_left_to_the_noise(lagging, monkeypatch):
    monkeypatch.setattr("zerorate_tools.loop.search.cross_validation.family_p", lambda *_: 0.02)
    r, line, found, _, by_line, taken = by(lagging, None)
    assert memory(r, line, found, lagging.pool, by_line, by_line, taken) is None


def rival(search):
    """What remembers temperature and predicts best, and by what it is judged."""
    by_line = PiecesByLine(search.regression.sessions[0])
    curve = tuple(replace(search.line[0], power=k) for k in (2, 3))
    return remembering(search.line, curve, search.pool, by_line), by_line


def test_what_remembers_predicts_no_wave(wavy):
    other, by_line = rival(wavy)
    best = whole_curve(wavy.regression, wavy.line, [], by_line, by_line, 0)
    assert other.nats < by_line(wavy.line, (), best.candidate.terms).sum() - 3.0


@pytest.mark.parametrize(
    "nats, left, beside, taken",
    [
        (1000.0, 1.0, [], True),
        (5.0, 1.0, [], False),
        (5.0, 0.85, [], True),
        (5.0, 0.85, ["power-on-transient"], False),
    ],
)
def test_segments_that_a_memory_equals_must_be_clear(wavy, monkeypatch, nats, left, beside, taken):
    lag = next(c for c in wavy.pool if c.kind == "thermal-lag")
    monkeypatch.setattr(
        "zerorate_tools.loop.search.cross_validation.remembering",
        lambda *_: Remembering((), lag, np.inf),
    )
    regression, line, _, judged, by_line, _ = by(wavy, Kernels(nats, left))
    better = whole_curve(regression, line, [], Kernels(1000.0), by_line, 0)
    better.decision = replace(better.decision, session_gains=np.array([nats]))
    before = [Found(c, better.decision) for kind in beside for c in wavy.pool if c.kind == kind][:1]
    one = OneRecording(regression, line, wavy.pool, judged, 0, False, before)
    one._bend_often(better, (), by_line)
    assert [f.candidate.kind for f in one.found] == ([SEGMENTS] if taken else beside)
    assert better.confounded_with == (["thermal-lag"] if taken else [])


def test_a_lag_takes_the_place_of_what_feigned_it(lagging):
    other, by_line = rival(lagging)
    beside = lagging.pool, by_line, by_line, 0
    found = of_memory(lagging.regression, lagging.line, [], other, *beside)
    assert found[-1].candidate.kind == "thermal-lag"
    assert not of_memory(lagging.regression, lagging.line, found, other, *beside)


def test_a_lag_is_none_where_a_hysteresis_predicts_as_well(lagging):
    (session,) = simulate(5, [("thermal-hysteresis", 20.0)], sessions=1, bare=True).sessions
    for search, alike in ((Search([session]), True), (lagging, False)):
        by_line = PiecesByLine(search.regression.sessions[0])
        lag = next(c for c in search.pool if c.kind == "thermal-lag" and c.terms[0].lag_s > 100.0)
        assert is_like_hysteresis(search.line, (), lag, search.pool, by_line) == alike


def test_a_decay_that_only_stands_against_a_warm_up_cancels():
    (session,) = simulate(5, sessions=1, bare=True).sessions
    session.sources["temp"] = 40.0 - 18.0 * np.exp(-session.time_s() / 900.0)
    line = [Term("temp", centre=30.0)]
    assert cancels([session], line, [Term("one", decay_s=960.0)])


def test_a_slope_of_its_own_reaches_beyond_a_piece_by_its_margin():
    (session,) = simulate(1, sessions=1, bare=True).sessions
    temp = session.sources["temp"]
    lo, hi = temp.min(), temp.max()
    part = PiecesByLine(session).parts[0]
    seen = session.block_mean(temp)[part.available]
    at_edge, beyond = (held(Term("temp", lo - m, hi + m), [part]) for m in (0.0, 3.0))
    for term in (at_edge, held(Term("temp"), [part])):
        assert (term.lo, term.hi) == (seen.min(), seen.max())
    assert beyond.lo == pytest.approx(seen.min() - 3.0)


def test_operators_that_are_all_but_the_same_share_their_effect():
    (session,) = simulate(2, sessions=1, bare=True).sessions
    alike = [Term("temp", centre=25.0, memory="play", width=w) for w in (4.0, 4.0001)]
    together, alone = ordinary(alike, [session]), ordinary(alike[:1], [session])
    assert np.abs(together).max() < 2 * np.abs(alone).max()
