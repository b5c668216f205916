"""What of a recording counts as rest."""

from dataclasses import replace

import numpy as np
import pytest
from zerorate_bench.loop.rests import NOISES_DPS, RATES_HZ, share_used, shares_with_turn
from zerorate_tools.loop.read.still import still_ticks
from zerorate_tools.loop.read.ticks import read_ticks
from zerorate_tools.recordings import Recording, Scales

from .power_ons import SCALES as WITH_ACCELEROMETER
from .power_ons import turning, written

ODR = 20
SCALES = Scales("MPU-6050", float(ODR), 131.0, None, 340.0, 36.53)


@pytest.fixture
def still(tmp_path):
    """(m,) bool of a rate in dps and a temperature in degC, each a sample."""

    def of(rate_dps, temp_degc):
        columns = turning(3, rate_dps, ODR)
        columns["temp"] = np.round((temp_degc - 36.53) * 340).astype(np.int32)
        [path] = written(tmp_path, [Recording(columns, SCALES, "run")])
        return still_ticks(read_ticks(path))

    return of


def test_a_steep_part_on_a_fast_ramp_is_still(still):
    at_s = np.arange(ODR * 2400) / ODR
    temp = 20 + np.abs((at_s - 300) % 1200 - 600) * 2.5 / 60  # up and down without a hold
    assert still(0.35 * temp, temp).mean() > 0.99


def test_a_turn_on_a_fast_ramp_is_no_rest(still):
    at_s = np.arange(ODR * 2400) / ODR
    temp = 20 + np.clip(at_s - 300, 0, 840) * 2.5 / 60
    turning = (at_s >= 600) & (at_s < 700)
    resting = still(0.35 * temp + 5.0 * turning, temp)
    assert not resting[600:700].any() and resting[:590].all() and resting[710:].all()


def test_a_turn_that_sets_in_slowly_is_motion_to_its_ends(still):
    at_s = np.arange(ODR * 900) / ODR
    swing = 2.0 * (1 - np.cos(2 * np.pi * np.clip(at_s - 400, 0, 60) / 60))
    resting = still(swing, np.full(len(at_s), 25.0))
    assert not resting[404:456].any()
    assert resting[:395].all() and resting[465:].all()


def test_a_bias_that_settles_up_to_a_turn_is_at_rest_before_it(still):
    at_s = np.arange(ODR * 1800) / ODR
    turning = 30.0 * ((at_s >= 150) & (at_s < 165))
    resting = still(0.6 * np.exp(-at_s / 110) + turning, np.full(len(at_s), 25.0))
    assert resting[:110].all() and resting[210:].all() and not resting[150:165].any()


def test_what_stays_where_a_knock_put_it_is_at_rest(still):
    at_s = np.arange(ODR * 1800) / ODR
    knocks = 40.0 * (np.abs((at_s - 600) % 100 - 1) < 1) * (at_s >= 600) * (at_s < 702)
    bias = 0.6 * ((at_s >= 600) & (at_s < 700))
    resting = still(bias + knocks, np.full(len(at_s), 25.0))
    assert resting[570:597].all() and resting[605:697].all() and resting[705:].all()
    assert not resting[600:602].any() and not resting[700:702].any()


def test_a_motion_that_the_recording_begins_with_is_motion_until_it_died_down(still):
    at_s = np.arange(ODR * 1800) / ODR
    resting = still(2.0 * np.exp(-at_s / 8), np.full(len(at_s), 25.0))
    assert not resting[:25].any() and resting[40:].all()


def test_what_shakes_as_a_recording_begins_or_ends_is_no_rest(tmp_path):
    rng, seconds = np.random.default_rng(4), 600
    at_s = np.arange(int(ODR) * seconds) / ODR
    shaken = (at_s < 60) | (at_s >= 540)
    columns = turning(4, np.zeros(len(at_s)), ODR)
    columns["temp"] = np.zeros(len(at_s), np.int32)
    for name, g in zip(("ax", "ay", "az"), (0.0, 0.0, 1.0)):
        noise = rng.normal(0, np.where(shaken, 0.3, 0.004))
        columns[name] = np.round((g + noise) * 16384).astype(np.int32)
    [path] = written(tmp_path, [Recording(columns, replace(WITH_ACCELEROMETER, odr_hz=ODR), "run")])
    resting = still_ticks(read_ticks(path))
    assert resting[:50].mean() < 0.2 and resting[550:].mean() < 0.2
    assert resting[75:525].all()


def test_a_device_mostly_in_motion_keeps_its_rests(still):
    at_s = np.arange(ODR * 1200) / ODR
    moving = at_s % 100 >= 19
    hand = np.repeat(np.random.default_rng(5).normal(0, 30, 2400), ODR // 2) * moving
    resting = still(hand, np.full(len(at_s), 25.0))
    assert resting.sum() > 0.8 * 228 and not resting[25:98].any()


@pytest.mark.parametrize("accel", [False, True])
@pytest.mark.parametrize("noise_dps", NOISES_DPS)
@pytest.mark.parametrize("odr_hz", RATES_HZ)
def test_a_rest_at_any_rate_and_noise_is_used(tmp_path, odr_hz, noise_dps, accel):
    assert share_used(tmp_path, odr_hz, noise_dps, accel) > 95


@pytest.mark.parametrize("noise_dps", NOISES_DPS)
@pytest.mark.parametrize("odr_hz", RATES_HZ)
def test_a_turn_at_any_rate_and_noise_is_not(tmp_path, odr_hz, noise_dps):
    turn, beside = shares_with_turn(tmp_path, odr_hz, noise_dps)
    assert turn == 0
    assert beside > 95
