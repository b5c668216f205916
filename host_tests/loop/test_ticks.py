"""Samples summed over ticks of time."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from zerorate_tools.loop.read.bad_readings import saturated
from zerorate_tools.loop.read.blocks import dequantise, step_lsb
from zerorate_tools.loop.read.earth import EARTH_DPS, can_be_earth, earth_of
from zerorate_tools.loop.read.gate import CannotClose
from zerorate_tools.loop.read.still import deviation_of, still_stretch
from zerorate_tools.loop.read.ticks import read_ticks
from zerorate_tools.recordings import Recording, Scales, write_recording


def read(path, t_us, odr_hz):
    rng = np.random.default_rng(2)
    words = {n: rng.integers(-40, 40, len(t_us)) for n in ("gx", "gy", "gz", "ax", "ay", "az")}
    scales = Scales("MPU-6050", odr_hz, 131.0, 16384.0)
    write_recording(Recording({"t_us": t_us, **words}, scales, path.stem), path)
    return read_ticks(path)


@pytest.mark.parametrize(
    ("every_s", "odr_hz"), [(15.0, 0.0666667), (14.9999925, 1 / 15), (0.99999, 1.0)]
)
def test_slow_samples_have_a_tick_each_though_their_rate_is_not_quite_what_it_says(
    tmp_path, every_s, odr_hz
):
    t_us = np.rint(np.arange(400) * every_s * 1e6).astype(np.int64)
    assert (read(tmp_path / "slow.parquet", t_us, odr_hz).count == 1).all()


def test_slow_samples_that_come_early_or_late_have_a_tick_each(tmp_path):
    jitter = np.random.default_rng(1).uniform(-0.2, 0.2, 400)
    t_us = np.rint((np.arange(400) + jitter) * 1e6).astype(np.int64)
    ticks = read(tmp_path / "late.parquet", t_us, 1.0)
    assert (ticks.count == 1).all() and ticks.start_us == t_us[0] - 500_000


def test_quick_samples_begin_with_the_first_tick(tmp_path):
    t_us = 5_000_000 + np.arange(1000) * 40_000
    ticks = read(tmp_path / "quick.parquet", t_us, 25.0)
    assert ticks.start_us == 5_000_000 and (ticks.count == 25).all()


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


HZ, N = 50.0, 30000


@pytest.fixture
def written(tmp_path):
    """Ten minutes of white noise of 0.05 dps; keep: samples that stay."""

    def write(hz=HZ, moving=(), keep=slice(None), n=N):
        gyro = np.random.default_rng(1).normal(0, 10, (n, 3))
        gyro[slice(*moving) if moving else slice(0)] *= 40
        columns = {"t_us": (np.arange(n) * 1e6 / hz).astype(np.int64)}
        columns.update({a: np.rint(v).astype(np.int32) for a, v in zip(("gx", "gy", "gz"), gyro.T)})
        columns = {name: values[keep] for name, values in columns.items()}
        path = tmp_path / "run.parquet"
        write_recording(Recording(columns, Scales("X", hz, 200.0), "run"), path)
        return path

    return write


@pytest.mark.parametrize(("hz", "each_s"), [(50.0, 0.1), (12.5, 0.1), (5.0, 0.2), (2.0, 0.5)])
def test_what_is_quiet_throughout_is_one_stretch(written, hz, each_s):
    rate, seconds = still_stretch(written(hz))
    assert seconds == pytest.approx(each_s)
    assert len(rate) * seconds == pytest.approx(N / hz, rel=0.01)


def test_white_noise_falls_with_the_square_root_of_time_to_minutes(written):
    tau_s, deviation = deviation_of(written())
    expected = 0.05 / np.sqrt(HZ * tau_s[:, None])
    few = tau_s < 10
    assert tau_s[-1] == pytest.approx(200, rel=0.01)
    assert np.abs(deviation[few] / expected[few] - 1).max() < 0.2


def test_motion_ends_a_stretch(written):
    rate, each_s = still_stretch(written(moving=(9000, 10000)))
    assert 395 <= len(rate) * each_s <= 400


def test_a_lost_tick_is_bridged_and_many_make_the_ticks_longer(written):
    lost = np.ones(N, bool)
    lost[1000:1008] = False
    assert still_stretch(written(keep=lost))[1] == 0.1
    bursts = np.arange(N) % 50 < 20
    rate, each_s = still_stretch(written(keep=bursts))
    assert each_s == 1.0 and len(rate) >= 599


def test_a_slow_recording_has_ticks_of_one_row(written):
    rate, each_s = still_stretch(written(hz=1 / 15, n=200))
    assert each_s == 15.0 and len(rate) == 200


def test_too_short_a_rest_is_a_sentence(written):
    with pytest.raises(CannotClose, match="run: never still for 450 s; leave it at rest longer"):
        still_stretch(written(hz=1 / 15, n=20))


UP = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]])


def ticks(columns=None, **more):
    """Three ticks, one pose each. columns: attitude as columns give it; more: of the scales."""
    scales = Scales("MPU-6050", 25.0, 131.0, 16384.0, more=more)
    return SimpleNamespace(count=np.ones(3), accel=UP, attitude=columns, scales=scales)


def test_without_a_latitude_nothing_is_removed_and_all_of_it_is_said_to_be_left():
    earth = earth_of(ticks())
    assert not earth.rate_dps.any() and earth.unknown_dps == EARTH_DPS
    assert "4.2 mdps" in earth.said and "latitude_deg" in earth.said


def test_gravity_and_latitude_give_the_vertical_part():
    earth = earth_of(ticks(latitude_deg=30.0))
    assert earth.rate_dps == pytest.approx(UP * EARTH_DPS / 2)
    assert earth.unknown_dps == pytest.approx(EARTH_DPS * np.sqrt(3) / 2)


def test_attitude_and_latitude_give_all_of_it():
    quarter_left = np.sqrt(0.5)  # nose to the north: east is to the right
    attitude = np.tile([quarter_left, 0.0, 0.0, quarter_left], (3, 1))
    earth = earth_of(ticks(columns=attitude, latitude_deg=0.0))
    assert earth.rate_dps == pytest.approx(np.tile([EARTH_DPS, 0.0, 0.0], (3, 1)), abs=1e-9)
    assert earth.unknown_dps == 0.0


def test_a_constant_attitude_may_travel_in_the_scales():
    quarter_left = [2.0, 0.0, 0.0, 2.0]  # of any length
    earth = earth_of(ticks(latitude_deg=0.0, attitude=quarter_left))
    assert earth.rate_dps == pytest.approx(np.tile([EARTH_DPS, 0.0, 0.0], (3, 1)), abs=1e-9)


@pytest.mark.parametrize(("dps_per_g", "may_be"), [(0.004, True), (0.02, False)])
def test_a_small_effect_of_acceleration_may_be_earth(dps_per_g, may_be):
    assert can_be_earth(np.vstack([UP, -UP]) * dps_per_g, EARTH_DPS) is may_be


WARMING = 20 + 8 * (1 - np.exp(-np.arange(3600) / 400))


@pytest.mark.parametrize("step", [0.1, 0.5, 1.0])
def test_the_slope_over_a_coarse_temperature_is_the_slope(step):
    raw = np.round(WARMING / step) * step
    change, stairs = np.diff(WARMING[::60]), np.diff(raw[::60])
    course = np.diff(dequantise(raw / step)[::60]) * step
    plain, better = (float(v @ change / (v @ v)) for v in (stairs, course))
    assert abs(better - 1) < 0.06
    assert abs(better - 1) <= abs(plain - 1)


def test_what_wavers_between_steps_is_left_as_it_is():
    wavering = WARMING + 0.3 * np.random.default_rng(1).normal(size=len(WARMING))
    assert dequantise(wavering) is wavering


def test_a_noise_of_a_sixth_of_a_step_is_seen_through():
    noise = np.random.default_rng(2).normal(0, 1 / 6, (len(WARMING), 25))
    read = np.round(8 * WARMING[:, None] + noise).mean(axis=1)

    def error_of_changes(course):
        return np.diff(
            (course - 8 * WARMING)[: len(course) // 20 * 20].reshape(-1, 20).mean(1)
        ).std()

    assert error_of_changes(dequantise(read)) < 0.7 * error_of_changes(read)


def test_a_constant_is_left_as_it_is():
    assert (dequantise(np.full(50, 7.0)) == 7.0).all()


@given(st.lists(st.tuples(st.integers(-40, 40), st.integers(6, 60)), min_size=1, max_size=30))
def test_a_course_never_leaves_the_steps_by_more_than_half_a_jump(stays):
    raw = np.concatenate([np.full(length, float(level)) for level, length in stays])
    jump = np.abs(np.diff(raw)).max(initial=1.0)
    assert (np.abs(dequantise(raw) - raw) <= jump / 2 + 1e-9).all()


@pytest.mark.parametrize(
    "step, noise, seen", [(170, 0, 170), (170, 20, 170), (32, 40, 0), (1, 9, 0)]
)
def test_the_step_of_a_channel_is_known_where_it_stands_on_levels(step, noise, seen):
    samples = 340 * WARMING[:, None] + noise * np.random.default_rng(3).normal(size=(3600, 4))
    assert step_lsb((step * np.round(samples / step)).mean(axis=1)) == seen
