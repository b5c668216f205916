"""Noise, floors, intervals and chances, and what a candidate must reach."""

import numpy as np
import pytest
from scipy.stats import chi2
from zerorate_bench.loop.simulated import flicker, simulate
from zerorate_tools.allan import Noise, overlapping
from zerorate_tools.loop.fit.regression import Regression, floor_dps, noise_of
from zerorate_tools.loop.fit.resampling import NullRatios, block_bootstrap, null_ratios, rms
from zerorate_tools.loop.read.lines import find, spectrum
from zerorate_tools.loop.search import decide
from zerorate_tools.loop.search.select import Search

from . import dense
from .dense import A, B, C


def test_an_interval_of_an_rms_is_wider_where_rows_are_alike():
    rng = np.random.default_rng(0)
    rows = rng.normal(size=(600, 1))
    low, high = block_bootstrap([rows[:200], rows[200:]], rms)
    assert low < rms(rows) < high
    assert high - low == pytest.approx(2 * 1.96 / np.sqrt(2 * 600), rel=0.25)
    slow = np.repeat(rng.normal(size=(40, 1)), 15, axis=0)
    slow_low, slow_high = block_bootstrap([slow], rms)
    assert (slow_high - slow_low) / (high - low) == pytest.approx(np.sqrt(15), rel=0.35)


def test_the_chance_of_an_irrelevant_candidate_is_chi_squared_s_where_its_ratios_are():
    theory = NullRatios.of(3.0, 6.0, 3)
    assert theory.inflation == 1.0
    for ratio in (1.0, 7.8, 20.0):
        assert theory.survival(ratio) == pytest.approx(chi2.sf(ratio, 3))
        assert theory.survival(ratio, 2) == pytest.approx(chi2.sf(ratio, 6))
    below = NullRatios.of(2.0, 2 / 3, 3)
    assert (below.mean, below.variance) == (3, 6)
    above = NullRatios.of(10.0, 200 / 3, 3)
    assert (above.mean, above.inflation) == (10.0, 10 / 3)
    assert above.variance == pytest.approx(max(200 / 3, 2 * 10**2 / 3))
    wide = NullRatios.of(5.0, 100.0, 2)
    assert wide.variance == 100.0
    draws = np.random.default_rng(0).gamma(5 * 5 / 100, 100 / 5, 200_000)
    assert wide.survival(8.0) == pytest.approx((draws > 8).mean(), rel=0.03)


def test_the_floor_is_the_lowest_deviation_up_to_a_third_of_the_longest_session():
    regression = Regression([dense.white(1, 60), dense.white(2, 300)])
    tau = np.geomspace(20.0, 300 * 20 / 3, 2000)
    lowest = [n.deviation(tau).min() for n in noise_of(regression, [])]
    assert floor_dps(regression, []) == pytest.approx(lowest, rel=1e-3)


def test_surrogates_of_white_noise_reach_what_theory_says_and_a_true_effect_does_not_raise_them():
    made = [dense.white(seed, 60) for seed in (1, 2)]
    quiet = null_ratios(Regression(made), [], [A], [B, C])
    assert 1.0 <= quiet.inflation < 1.6 and quiet.dof == 3
    moved = Regression([dense.following(s, dps=50.0) for s in made])
    with_effect = null_ratios(moved, [], [A], [B, C])
    assert with_effect.mean == pytest.approx(quiet.mean, rel=0.05)
    left_in = null_ratios(moved, [], [B], [A])
    assert left_in.mean > 1.5 * quiet.mean


@pytest.mark.parametrize(
    ("family", "level"), [("catalogue", 2.5e-3), ("generic", 5e-5), ("step", 2e-3)]
)
def test_a_family_s_chance_is_that_of_one_times_all_that_were_tried(family, level):
    assert decide.family_p(20.0, 3, 5.0) == pytest.approx(5 * chi2.sf(20.0, 3))
    assert decide.family_p(1.0, 3, 5.0) == 1.0
    least = decide.smallest_ratio(family, 3, 7.0)
    assert decide.family_p(least, 3, 7.0) == pytest.approx(level)


@pytest.mark.parametrize(
    ("columns", "tests"),
    [
        (np.zeros((5, 3)), 1.0),
        (np.ones((5, 1)), 1.0),
        (np.eye(5)[:, :3] * [1.0, 9.0, 0.1], 3.0),
        (np.array([[1.0, 0.6, 0.0], [0.0, 0.8, 0.0]]), np.sqrt([1.6, 0.4]).sum() ** 2 / 2),
    ],
)
def test_columns_count_as_many_tests_as_they_are_apart(columns, tests):
    assert decide.effective(columns) == pytest.approx(tests)


def test_the_deviation_of_fitted_noise_is_the_deviation_of_the_noise():
    rng = np.random.default_rng(3)
    rate = np.column_stack([flicker(rng, 8000, 1.0) for _ in range(8)])
    tau, deviation = overlapping(rate, 20.0)
    at = np.searchsorted(tau, 2000.0)
    expected = Noise(20.0, 0.0, 1.0, 0.0).deviation(tau[at : at + 1])
    assert np.sqrt((deviation[at] ** 2).mean()) == pytest.approx(expected[0], rel=0.1)


def test_a_drift_of_twice_the_floor_is_found_beside_a_walking_noise():
    found = Search(simulate(5000012, [("time-drift", 2.0)]).sessions[:-1]).run().found
    assert [f.candidate.kind for f in found] == ["time-drift"]


N, STEP_S = 3600, 1.0


def coloured(rng):
    walk = np.cumsum(rng.normal(0, 2e-4, (N, 3)), axis=0)
    pink = np.column_stack([flicker(rng, N, 1e-3) for _ in range(3)])
    return rng.normal(0, 3e-3, (N, 3)) + pink + walk


def lines(rates):
    spectra = [spectrum(r, STEP_S, 4096) for r in rates]
    return find(spectra[:-1], spectra[-1:], 2.0 * 4096 / N, 10 / N)


def test_coloured_noise_has_no_lines():
    for seed in range(20):
        rng = np.random.default_rng(seed)
        assert lines([coloured(rng) for _ in range(4)]) == []


@pytest.mark.parametrize("seed", [216, 372])
def test_the_humps_of_a_walk_in_one_short_recording_are_no_lines(seed):
    rng = np.random.default_rng(seed)
    rate = rng.normal(0, 1e-3, (880, 3)) + np.cumsum(rng.normal(0, 2e-4, (880, 3)), axis=0)
    assert find([spectrum(rate, STEP_S, 1024)], [], 2.0 * 1024 / 880, 10 / 880) == []


@pytest.mark.parametrize("period_s", [7.3, 60.0, 240.0])
def test_a_line_is_found_with_its_period_and_amplitude(period_s):
    rng = np.random.default_rng(1)
    t = np.arange(N) * STEP_S
    size = np.array([4e-3, 1e-3, 3e-3])
    rates = [
        coloured(rng) + np.outer(np.sin(2 * np.pi * t / period_s + rng.uniform(0, 6)), size)
        for _ in range(4)
    ]
    (line,) = lines(rates)
    assert 1 / line.hz == pytest.approx(period_s, rel=0.06) and line.in_holdout
    assert line.amplitude_dps[0] == pytest.approx(size[0], rel=0.3)
