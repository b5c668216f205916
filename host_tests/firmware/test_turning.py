"""An apparent rest may be a turn: what lies along gravity does not refute a bias that is known."""

import numpy as np
import pytest
from zerorate_tools.peers.firmware import Decision, firmware
from zerorate_tools.peers.given import given
from zerorate_tools.recordings import Recording, Scales

HZ = 50
LSB_PER_DPS = 131.0
LSB_PER_G = 16384
NOISE_DPS = 0.05
BIAS_DPS = np.array([0.4, -0.7, 1.1])
SHAKEN = "shaken"


def recorded(*parts, warms_degc=0.0):
    """A recording, z up; a part is seconds and its rate, dps, or SHAKEN."""
    rng = np.random.default_rng(1)
    rate, accel = [], []
    for seconds, what in parts:
        n = seconds * HZ
        shaken = 20.0 if what is SHAKEN else 0.0
        rate.append(np.zeros((n, 3)) + (0 if what is SHAKEN else what))
        rate[-1] += rng.standard_normal((n, 3)) * (NOISE_DPS + shaken)
        accel.append([0, 0, 1] + rng.standard_normal((n, 3)) * (0.002 + shaken / 100))
    gyro = np.round((np.concatenate(rate) + BIAS_DPS) * LSB_PER_DPS).astype(np.int64)
    force = np.round(np.concatenate(accel) * LSB_PER_G).astype(np.int64)
    n = len(gyro)
    noise = rng.standard_normal(n) * 6
    columns = {"t_us": np.arange(n) * (1_000_000 // HZ)}
    columns["temp"] = np.round(np.linspace(-3000, -3000 + 340 * warms_degc, n) + noise).astype(int)
    columns |= {f"g{axis}": gyro[:, i] for i, axis in enumerate("xyz")}
    columns |= {f"a{axis}": force[:, i] for i, axis in enumerate("xyz")}
    scales = Scales("MPU-6050", float(HZ), LSB_PER_DPS, LSB_PER_G, 340.0, 36.53)
    return given(Recording(columns, scales, "turns"))


def followed(*parts, warms_degc=0.0):
    """Error and one sigma, dps, at the end of each second."""
    bias, sigma, _ = Decision().states(recorded(*parts, warms_degc=warms_degc))
    return (bias - BIAS_DPS)[HZ - 1 :: HZ], sigma[HZ - 1 :: HZ]


KNOWN = (100, 0.0)
ABOUT_Z = np.array([0.0, 0.0, 1.0])


@pytest.mark.parametrize("dps", [0.1, -0.25, 2.0, -8.0])
def test_a_known_bias_stands_through_ten_turns_of_half_a_minute(dps):
    turns = [part for _ in range(10) for part in ((30, dps * ABOUT_Z), (2, SHAKEN))]
    error, sigma = followed(KNOWN, (2, SHAKEN), *turns)
    assert np.abs(error[100:]).max() < 0.02
    assert sigma[110:, 2].max() > 0.5 * min(abs(dps), 7.0)  # it may have moved as well


JUMP_DPS = np.array([1.5, 0.0, 1.0])


def test_a_jump_is_no_slope_over_temperature():
    error, _ = followed(KNOWN, (2, SHAKEN), (120, JUMP_DPS), warms_degc=1.0)
    assert np.abs(error[-30:] - JUMP_DPS).max() < 0.02


@pytest.mark.parametrize("warms_degc", [0.0, 5.0])
def test_a_jump_outlasts_a_power_off(warms_degc):
    first = recorded(KNOWN, (2, SHAKEN), (120, JUMP_DPS), warms_degc=warms_degc)
    second = recorded((2, SHAKEN), (30, JUMP_DPS))
    bias = firmware()([first, second])[1]
    assert np.abs(bias[HZ] - BIAS_DPS - JUMP_DPS)[[0, 2]].max() < 0.05


def test_a_bias_that_moves_across_gravity_is_no_turn():
    jump = np.array([0.5, 0.0, 0.6])
    error, _ = followed(KNOWN, (2, SHAKEN), (90, jump))
    assert np.abs(error[-1] - jump).max() < 0.02


def test_one_unbroken_rest_tells_at_last_that_it_is_no_turn():
    error, sigma = followed(KNOWN, (2, SHAKEN), (270, 0.6 * ABOUT_Z))
    off = np.abs(error - 0.6 * ABOUT_Z)[102:, 2]
    assert off[-1] < 0.02
    assert np.mean(off[10:] < 2 * sigma[112:, 2]) == 1.0


def test_what_is_hardly_known_is_given_up_as_before():
    error, _ = followed((20, 2.0 * ABOUT_Z), (2, SHAKEN), (90, 0.0))
    assert np.abs(error[-1]).max() < 0.02


def test_a_rest_that_agrees_ends_what_was_held_back():
    _, sigma = followed(KNOWN, (2, SHAKEN), (30, 2.0 * ABOUT_Z), (10, SHAKEN), (30, 0.0))
    assert sigma[130, 2] > 1.0
    assert sigma[-1, 2] == pytest.approx(sigma[100, 2], rel=0.05)
