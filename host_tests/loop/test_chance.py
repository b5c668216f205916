"""Floors, intervals and chances, beside noise that is drawn."""

import numpy as np
import pytest
from scipy.stats import chi2
from zerorate_tools.loop.fit.intervals import block_bootstrap, rms
from zerorate_tools.loop.fit.regression import Regression, floor_dps, noise_of
from zerorate_tools.loop.fit.surrogates import NullRatios, null_ratios

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
