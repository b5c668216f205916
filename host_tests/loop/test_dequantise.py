"""A temperature in coarse steps."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from zerorate_tools.loop.read.dequantise import dequantise, step_lsb

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
