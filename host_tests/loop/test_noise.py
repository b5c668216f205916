"""Noise colours and the cross products under them."""

import numpy as np
import pytest
from zerorate_bench.loop.simulated import flicker
from zerorate_tools.allan import Noise, overlapping
from zerorate_tools.loop.fit import noise
from zerorate_tools.loop.fit.cross_products import (
    BridgedWhitener,
    GappyWhitener,
    Whitener,
    whitener,
)
from zerorate_tools.loop.fit.noise import noise_of
from zerorate_tools.loop.fit.regression import Regression
from zerorate_tools.loop.read.sessions import Session


def test_a_random_walk_is_diagonal_in_the_transform():
    n = 40
    walk = np.minimum.outer(np.arange(1, n + 1), np.arange(1, n + 1)).astype(float)
    basis = noise.transform(np.eye(n))
    covariance = basis @ walk @ basis.T
    assert covariance == pytest.approx(np.diag(noise.frequency(n) ** -2.0), abs=1e-8)


def test_factorised_products_equal_the_transform_where_nothing_is_missing():
    rng = np.random.default_rng(1)
    there = np.ones(30, bool)
    plain, gappy = Whitener(there), GappyWhitener(there)
    x, y = rng.normal(size=(30, 2)), rng.normal(size=(30, 2))
    wide = rng.normal(size=(30, 100))
    for columns in (y, y, wide):  # new, known, and too many to be kept
        a = plain.products(plain.prepare(x), plain.prepare(columns))
        b = gappy.products(gappy.prepare(x), gappy.prepare(columns))
        for one, other in zip(a, b):
            assert other == pytest.approx(one, rel=1e-6, abs=1e-9)
    assert gappy.logdet == pytest.approx(plain.logdet, rel=1e-9)


def test_short_gaps_are_bridged_and_long_ones_factorised():
    short, long = np.ones(60, bool), np.ones(60, bool)
    short[20:23], long[20:40] = False, False
    assert isinstance(whitener(short), BridgedWhitener)
    assert isinstance(whitener(long), GappyWhitener)


def session(rate):
    return Session("one", 20.0, 1, rate, np.ones(len(rate)), {})


def test_the_colour_of_a_known_noise_is_recovered():
    rng = np.random.default_rng(5)
    n = 1200
    rate = np.column_stack(
        [
            rng.normal(0, 1, n),
            rng.normal(0, 1, n) + np.cumsum(rng.normal(0, 0.3, n)),
            rng.normal(0, 0.3, n) + flicker(rng, n, 1.0),
        ]
    )
    white, walk, pink = noise_of(Regression([session(rate)]), [])
    assert white.white_dps == pytest.approx(1.0, rel=0.1) and white.walk_dps < 0.01
    assert walk.walk_dps == pytest.approx(0.3, rel=0.5)
    assert pink.flicker_dps == pytest.approx(1.0, rel=0.3)


def test_white_noise_falls_with_the_square_root_of_time():
    tau, deviation = overlapping(np.random.default_rng(2).normal(size=(20000, 1)), 0.5)
    assert deviation[0, 0] == pytest.approx(1.0, rel=0.05)
    at = np.searchsorted(tau, 50.0)
    assert deviation[at, 0] == pytest.approx(np.sqrt(0.5 / tau[at]), rel=0.15)


def test_the_deviation_of_fitted_noise_is_the_deviation_of_the_noise():
    rng = np.random.default_rng(3)
    rate = np.column_stack([flicker(rng, 8000, 1.0) for _ in range(8)])
    tau, deviation = overlapping(rate, 20.0)
    at = np.searchsorted(tau, 2000.0)
    expected = Noise(20.0, 0.0, 1.0, 0.0).deviation(tau[at : at + 1])
    assert np.sqrt((deviation[at] ** 2).mean()) == pytest.approx(expected[0], rel=0.1)


def test_too_short_a_rate_has_no_deviation():
    with pytest.raises(ValueError, match="9 samples"):
        overlapping(np.zeros((8, 3)), 1.0)
