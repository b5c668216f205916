"""What pieces left out of one recording tell by themselves."""

from dataclasses import replace

import numpy as np
import pytest
from zerorate_bench.loop.simulated import simulate
from zerorate_tools.loop.fit.line import ordinary
from zerorate_tools.loop.fit.single import PiecesByLine, held
from zerorate_tools.loop.search.cancels import cancels
from zerorate_tools.loop.search.curve import powers
from zerorate_tools.loop.search.hysteresis import is_like_hysteresis
from zerorate_tools.loop.search.select import Search, select
from zerorate_tools.model.term import Term


@pytest.fixture(scope="module")
def lagging():
    (session,) = simulate(5, [("thermal-lag", 20.0)], sessions=1, bare=True).sessions
    return Search([session])


@pytest.fixture
def wavy():
    """A bias that goes up and down twice over the range of temperature."""
    (session,) = simulate(5, sessions=1, bare=True).sessions
    temp = session.block_mean(session.sources["temp"])
    share = (temp - temp.min()) / np.ptp(temp)
    wave = 0.02 * np.sin(4 * np.pi * share)
    return Search([replace(session, rate_dps=session.rate_dps + wave[:, None])])


def test_a_curve_follows_what_no_cubic_does(wavy):
    session, line = wavy.regression.sessions[0], wavy.line
    by_line = PiecesByLine(session)
    (found,) = select([session], on_pieces=by_line).found
    assert found.candidate.kind == "temperature-curve"
    left = [
        np.nanstd(by_line.residual(line, t)) for t in (powers(wavy.pool), found.candidate.terms)
    ]
    assert left[1] < 0.7 * left[0]


def test_a_lag_is_no_curve_over_temperature(lagging):
    session = lagging.regression.sessions[0]
    (found,) = select([session], on_pieces=PiecesByLine(session)).found
    assert found.candidate.kind == "thermal-lag"
    assert not cancels([session], lagging.line, found.candidate.terms)


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
