"""A sum of play operators of fixed widths is as large as is likely, and taken where likelier."""

import numpy as np
import pytest
from zerorate_bench.loop.added_effects import PRANDTL_ISHLINSKII_KNOWN
from zerorate_bench.loop.simulated import simulate
from zerorate_tools.loop.fit.line import ordinary, shrunk
from zerorate_tools.loop.fit.regression import Regression, predicted
from zerorate_tools.loop.fit.shrunk import evidence
from zerorate_tools.loop.fit.single import PiecesByLine
from zerorate_tools.loop.search.catalogue import candidates
from zerorate_tools.loop.search.hysteresis import KIND
from zerorate_tools.loop.search.likely_hysteresis import likeliest, of_a_pair
from zerorate_tools.loop.search.select import select, straight_line
from zerorate_tools.loop.verify.judge import rms_dps, scored
from zerorate_tools.model.term import Term

LAG = Term("temp", lag_s=120.0, lag_mode="difference")


def regression_of(effects, seed=302_011, sessions=1):
    made = simulate(seed, effects, sessions, bare=True).sessions
    return Regression(made), straight_line(made)


def of_two(seed):
    """Two power-ons with a loop at twice the floor, and its likeliest form by the first."""
    first, second = simulate(seed, [(PRANDTL_ISHLINSKII_KNOWN, 2.0)], 2).sessions
    line = straight_line([first])
    candidate, _ = likeliest(Regression([first]), line)
    return first, second, [*line, *candidate.terms]


def left_of(second, terms, coefficients):
    return float(
        np.sqrt((rms_dps([scored(second, predicted(terms, coefficients, second))[0]]) ** 2).mean())
    )


def test_weights_as_large_as_is_likely_take_a_loop_from_a_power_on_that_they_have_not_seen():
    left = []
    for seed in range(302_200, 302_212):
        first, second, terms = of_two(seed)
        by_line = left_of(second, terms[:1], ordinary(terms[:1], [first]))
        left.append(left_of(second, terms, shrunk(Regression([first]), terms)) / by_line)
    assert np.exp(np.mean(np.log(left))) < 0.75


def test_what_the_noise_hides_has_no_weights():
    regression, line = regression_of([])
    terms = [*line, *likeliest_or_any(regression, line)]
    held, free = shrunk(regression, terms), regression.fit(terms).coefficients
    assert np.abs(held[1:]).max() < 0.3 * np.abs(free[1:]).max()


def likeliest_or_any(regression, line):
    """The form of another device, of the same temperatures, where noise shows none."""
    candidate, _ = likeliest(regression, line)
    return (candidate or of_likely(regression)).terms


def of_likely(regression):
    loud, line = regression_of([(PRANDTL_ISHLINSKII_KNOWN, 9.0)])
    return likeliest(loud, line)[0]


@pytest.mark.parametrize("seed", range(10_000, 10_008))
def test_noise_makes_no_hysteresis_likely(seed):
    regression, line = regression_of([], seed)
    assert of_a_pair(regression, line, (), candidates(regression.sessions), 0)[0] is None


def test_a_lag_is_likelier_than_a_hysteresis_where_there_is_one():
    regression, line = regression_of([("thermal-lag", 4.0)])
    assert evidence(regression, line, [LAG]) > likeliest(regression, line)[1] + 3.0


def test_a_loop_that_two_power_ons_show_is_named():
    sessions = simulate(303_070, [(PRANDTL_ISHLINSKII_KNOWN, 3.0)], 3).sessions
    (found,) = select(sessions[:-1]).found
    assert found.candidate.kind == KIND
    assert {t.memory for t in found.candidate.terms} == {"play"}


def test_a_lag_that_is_nearly_as_likely_is_named_beside_it():
    sessions = simulate(200_010, [("thermal-lag", 2.0)], 4).sessions
    (found,) = select(sessions[:-1]).found
    assert found.candidate.kind == KIND and "thermal-lag" in found.confounded_with


@pytest.mark.parametrize("seed", [302_301, 302_309, 302_313])
def test_a_bend_and_a_lag_of_one_of_two_power_ons_are_no_hysteresis(seed):
    effects = [("temperature-quadratic", 4.0), ("thermal-lag", 4.0)]
    first, _ = simulate(seed, effects, 2, bare=True).sessions
    found = select([first], on_pieces=PiecesByLine(first), judged_again=True).found
    bend, lag = (f.candidate.kind for f in found)
    assert bend in ("temperature-quadratic", "temperature-curve") and lag == "thermal-lag"
