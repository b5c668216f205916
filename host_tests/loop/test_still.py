"""What of a recording counts as rest."""

import numpy as np
import pytest
from zerorate_tools.loop.read.still import still_ticks
from zerorate_tools.loop.read.ticks import read_ticks
from zerorate_tools.recordings import Recording, Scales, write_recording

ODR = 20
SCALES = Scales("MPU-6050", float(ODR), 131.0, None, 340.0, 36.53)


@pytest.fixture
def still(tmp_path):
    """(m,) bool of a rate in dps and a temperature in degC, each a sample."""

    def of(rate_dps, temp_degc):
        n = len(rate_dps)
        rng = np.random.default_rng(3)
        columns = {"t_us": np.arange(n, dtype=np.int64) * (1_000_000 // ODR)}
        for name in ("gx", "gy", "gz"):
            columns[name] = np.round((rate_dps + rng.normal(0, 0.05, n)) * 131).astype(np.int32)
        columns["temp"] = np.round((temp_degc - 36.53) * 340).astype(np.int32)
        path = tmp_path / "run.parquet"
        write_recording(Recording(columns, SCALES, "run"), path)
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


# Rest is rest at any rate


RATES_HZ = [1 / 15, 1.0, 2.0, 4.0, 5.0, 10.0]
NOISES_DPS = [0.05, 0.35, 1.0]


@pytest.fixture
def slow(tmp_path):
    """(m,) bool of two hours at a rate, with white noise and a turn that the rate is given by."""

    def of(odr_hz, noise_dps, has_accel, turn_dps=0.0):
        rng = np.random.default_rng(7)
        at_s = np.arange(0, 9000, 1 / odr_hz)
        turning = (at_s >= 4000) & (at_s < 4300)
        columns = {"t_us": np.rint(at_s * 1e6).astype(np.int64)}
        for name in ("gx", "gy", "gz"):
            rate = 1.3 + turn_dps * turning + rng.normal(0, noise_dps, len(at_s))
            columns[name] = np.round(rate * 131).astype(np.int32)
        if has_accel:
            for name, g in (("ax", 0.0), ("ay", 0.0), ("az", 1.0)):
                force = g + rng.normal(0, 0.004, len(at_s))
                columns[name] = np.round(force * 16384).astype(np.int32)
        scales = Scales("MPU-6050", odr_hz, 131.0, 16384.0 if has_accel else None)
        path = tmp_path / "slow.parquet"
        write_recording(Recording(columns, scales, "slow"), path)
        ticks = read_ticks(path)
        return still_ticks(ticks), np.arange(len(ticks.count)) * ticks.tick_s

    return of


@pytest.mark.parametrize("has_accel", [False, True])
@pytest.mark.parametrize("noise_dps", NOISES_DPS)
@pytest.mark.parametrize("odr_hz", RATES_HZ)
def test_a_rest_at_any_rate_and_noise_is_used(slow, odr_hz, noise_dps, has_accel):
    resting, _ = slow(odr_hz, noise_dps, has_accel)
    assert resting.mean() > 0.95


@pytest.mark.parametrize("noise_dps", NOISES_DPS)
@pytest.mark.parametrize("odr_hz", RATES_HZ)
def test_a_turn_at_any_rate_and_noise_is_not(slow, odr_hz, noise_dps):
    resting, at_s = slow(odr_hz, noise_dps, has_accel=False, turn_dps=3.0)
    assert not resting[(at_s >= 4020) & (at_s < 4280)].any()
    assert resting[(at_s < 3500) | (at_s > 5100)].mean() > 0.95
