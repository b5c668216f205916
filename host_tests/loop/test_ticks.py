"""Samples summed over ticks of time."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from zerorate_tools.loop.read.bad_readings import saturated
from zerorate_tools.loop.read.blocks import dequantise
from zerorate_tools.loop.read.earth import EARTH_DPS, can_be_earth, earth_of
from zerorate_tools.loop.read.gate import CannotClose
from zerorate_tools.loop.read.still import deviation_of, still_stretch
from zerorate_tools.loop.read.ticks import read_ticks
from zerorate_tools.recordings import Recording, Scales, write_recording

HZ, N = 50.0, 30000


@pytest.fixture
def written(tmp_path):
    """White noise of 0.05 dps at times in s, ten minutes of it by default."""

    def write(hz=HZ, at_s=None):
        at_s = np.arange(N) / hz if at_s is None else at_s
        columns = {"t_us": np.rint(at_s * 1e6).astype(np.int64)}
        noise = np.random.default_rng(1).normal(0, 10, (3, len(at_s)))
        columns |= zip(("gx", "gy", "gz"), np.rint(noise).astype(np.int32))
        path = tmp_path / "run.parquet"
        write_recording(Recording(columns, Scales("X", hz, 200.0), "run"), path)
        return path

    return write


@pytest.mark.parametrize(
    ("odr_hz", "every_s", "jitter_s", "each", "before_us"),
    [
        *((0.0666667, 15.0, 0, 1, 7_500_000), (1 / 15, 14.9999925, 0, 1, 7_500_000)),
        *((1.0, 0.99999, 0, 1, 500_000), (1.0, 1.0, 0.2, 1, 500_000), (25.0, 0.04, 0, 25, 0)),
    ],
    ids=["slow", "slow and early", "early", "early or late", "quick"],
)
def test_slow_samples_have_a_tick_each_and_quick_ones_begin_with_the_first(
    written, odr_hz, every_s, jitter_s, each, before_us
):
    jitter = np.random.default_rng(1).uniform(-jitter_s, jitter_s, 400)
    ticks = read_ticks(written(odr_hz, 5.0 + np.arange(400) * every_s + jitter))
    assert (ticks.count == each).all()
    assert ticks.start_us == round(5e6 + 1e6 * jitter[0]) - before_us


NOISE_DPS, LIMIT_DPS = 0.3, 422.0


@pytest.mark.parametrize("limit_dps", [LIMIT_DPS, 600.0])
def test_every_sample_at_the_limit_is_saturated(limit_dps):
    rate = np.random.default_rng(1).normal(0.0, NOISE_DPS, (6000, 3))
    rate[:, 0] += 500.0 * np.sin(2.0 * np.pi * np.arange(6000) / 100.0)
    beyond = np.abs(rate[:, 0]) > limit_dps + 1.0
    rate[:, 0] = np.clip(rate[:, 0], -limit_dps, limit_dps)
    found = saturated(rate)
    assert found[beyond].all() and not found[np.abs(rate[:, 0]) < limit_dps - 1.0].any()


@pytest.mark.parametrize("rate_dps", [0.0, 30.0, 300.0])
def test_rest_and_a_turntable_at_a_constant_rate_are_not_saturated(rate_dps):
    rate = np.random.default_rng(2).normal(0.0, NOISE_DPS, (60_000, 3))
    rate[10_000:50_000, 2] += rate_dps
    assert saturated(rate).mean() < 0.001


def test_white_noise_falls_with_the_square_root_of_time_to_minutes(written):
    tau_s, deviation = deviation_of(written())
    expected = 0.05 / np.sqrt(HZ * tau_s[:, None])
    few = tau_s < 10
    assert tau_s[-1] == pytest.approx(200, rel=0.01)
    assert np.abs(deviation[few] / expected[few] - 1).max() < 0.2


def test_a_lost_tick_is_bridged_and_many_make_the_ticks_longer(written):
    at_s = np.arange(N) / HZ
    assert still_stretch(written(at_s=np.delete(at_s, slice(1000, 1008))))[1] == 0.1
    rate, each_s = still_stretch(written(at_s=at_s[np.arange(N) % 50 < 20]))
    assert each_s == 1.0 and len(rate) >= 599


def test_a_rest_has_thirty_ticks_or_a_sentence_says_so(written):
    assert len(still_stretch(written(1 / 15, 15.0 * np.arange(30)))[0]) == 30
    with pytest.raises(CannotClose, match="run: never still for 450 s; leave it at rest longer"):
        still_stretch(written(1 / 15, 15.0 * np.arange(29)))


UP = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]])
_QUARTER_LEFT = [2.0, 0.0, 0.0, 2.0]  # nose to the north: east is to the right


@pytest.mark.parametrize(
    ("attitude", "more", "rate", "unknown"),
    [
        (None, {}, 0 * UP, 1.0),
        (None, {"latitude_deg": 30.0}, UP / 2, np.sqrt(3) / 2),
        (np.tile(_QUARTER_LEFT, (3, 1)) / np.sqrt(8), {"latitude_deg": 0.0}, [1.0, 0, 0], 0.0),
        (None, {"latitude_deg": 0.0, "attitude": _QUARTER_LEFT}, [1.0, 0, 0], 0.0),
    ],
    ids=["no latitude", "gravity", "attitude", "a constant attitude"],
)
def test_of_earths_rate_what_gravity_and_attitude_tell_is_known(attitude, more, rate, unknown):
    scales = Scales("MPU-6050", 25.0, 131.0, 16384.0, more=more)
    earth = earth_of(SimpleNamespace(count=np.ones(3), accel=UP, attitude=attitude, scales=scales))
    assert earth.rate_dps == pytest.approx(np.broadcast_to(rate, (3, 3)) * EARTH_DPS, abs=1e-9)
    assert earth.unknown_dps == pytest.approx(EARTH_DPS * unknown)


@pytest.mark.parametrize(
    ("dps_per_g", "sigma", "may_be"),
    [(0.004, 0.0, True), (0.0043, 0.0, False), (0.0043, 0.0001, True), (0.0043, 0.00001, False)],
    ids=["as Earth", "more", "as far as is known as Earth", "more by far more than its sigma"],
)
def test_a_small_effect_of_acceleration_may_be_earth(dps_per_g, sigma, may_be):
    """UP and back differ by 2 g, and so does their effect, by 2 times what three sigma are."""
    covariance = np.tile(sigma**2 * np.eye(3), (3, 1, 1))
    assert can_be_earth(UP, dps_per_g * np.eye(3), covariance, EARTH_DPS) is may_be


WARMING = 20 + 8 * (1 - np.exp(-np.arange(3600) / 400))


@pytest.mark.parametrize("step", [0.1, 0.5, 1.0])
def test_the_slope_over_a_coarse_temperature_is_the_slope(step):
    raw = np.round(WARMING / step) * step
    change, stairs = np.diff(WARMING[::60]), np.diff(raw[::60])
    course = np.diff(dequantise(raw / step)[::60]) * step
    plain, better = (float(v @ change / (v @ v)) for v in (stairs, course))
    assert abs(better - 1) < 0.06
    assert abs(better - 1) <= abs(plain - 1)


@given(st.lists(st.tuples(st.integers(-40, 40), st.integers(6, 60)), min_size=1, max_size=30))
def test_a_course_never_leaves_the_steps_by_more_than_half_a_jump(stays):
    raw = np.concatenate([np.full(length, float(level)) for level, length in stays])
    jump = np.abs(np.diff(raw)).max(initial=1.0)
    assert (np.abs(dequantise(raw) - raw) <= jump / 2 + 1e-9).all()
