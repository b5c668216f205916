"""A sensor at the end of its range is noticed in physical units, without a rail of 16 bits."""

import numpy as np
import pytest
from zerorate_tools.loop.read.saturation import saturated

SWING_DPS, NOISE_DPS, LIMIT_DPS = 500.0, 0.3, 422.0


@pytest.fixture
def swings() -> np.ndarray:
    """(6000, 3) dps: a minute of swings about x at 1 Hz, its noise in it."""
    at_s = np.arange(6000) / 100.0
    rate = np.zeros((len(at_s), 3))
    rate[:, 0] = SWING_DPS * np.sin(2.0 * np.pi * at_s)
    return rate + np.random.default_rng(1).normal(0.0, NOISE_DPS, rate.shape)


def test_swings_within_the_range_are_not_saturated(swings):
    assert not saturated(swings).any()


def test_every_sample_at_the_limit_is_saturated(swings):
    beyond = np.abs(swings[:, 0]) > LIMIT_DPS + 1.0
    swings[:, 0] = np.clip(swings[:, 0], -LIMIT_DPS, LIMIT_DPS)
    found = saturated(swings)
    assert found[beyond].all()
    assert not found[np.abs(swings[:, 0]) < LIMIT_DPS - 1.0].any()


@pytest.mark.parametrize("rate_dps", [0.0, 30.0, 300.0])
def test_rest_and_a_turntable_at_a_constant_rate_are_not_saturated(rate_dps):
    rate = np.random.default_rng(2).normal(0.0, NOISE_DPS, (6000, 3))
    rate[1000:5000, 2] += rate_dps
    assert saturated(rate).mean() < 0.001
