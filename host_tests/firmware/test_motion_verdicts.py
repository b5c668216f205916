"""Which windows in motion teach, which are refused, and what is kept of them."""

import numpy as np
import pytest
from zerorate.motion import least_squares, motion_verdict
from zerorate.motion.motion_settings import motion_state
from zerorate_tools.layout import MOTION, MOTION_REASON, MOTION_SETTINGS

from .motion_words import Q12, Q14, SETTINGS, UPPER, numbers, put_all
from .motions import stored, value_at


@pytest.fixture
def state():
    return motion_state(SETTINGS)


@pytest.fixture
def window(state):
    """A state whose window of full length moved to and fro, agrees and stays level."""
    stage = SETTINGS[MOTION_SETTINGS.SHORTEST_STAGE] + 3
    state[MOTION.STAGE], state[MOTION.LENGTH] = stage, 1 << stage
    state[MOTION.ACCEPTED] = 3
    state[MOTION.TAPER_SUM] = 1024 << stage
    state[MOTION.UP] = Q12 << stage
    state[MOTION.TRAFFIC] = state[MOTION.TILTED] = 2 * SETTINGS[MOTION_SETTINGS.LEAST_TRAFFIC] << 7
    put_all(state, MOTION.KNOWN_P, np.eye(3)[UPPER] * 100)
    put_all(state, MOTION.BIAS, np.zeros(3))
    put_all(state, MOTION.PRIOR_MEAN, np.zeros(3))
    put_all(state, MOTION.HELD_NOISE, np.full(3, 1000.0))
    put_all(state, MOTION.NOISE_ENERGY, np.full(3, 1000.0))
    for i in range(3):
        stored(state, least_squares.place(i, i), -50.0)
    return state


def said(state):
    """What the window taught, and whether it did."""
    return motion_verdict.finish(state, SETTINGS), state[MOTION.MOTION_REASON]


LEARNED = (1, MOTION_REASON.LEARNED)
LEAST = SETTINGS[MOTION_SETTINGS.LEAST_TRAFFIC] << 7
LEAST_TILT = SETTINGS[MOTION_SETTINGS.LEAST_TILT] << 7
LEAST_UP = SETTINGS[MOTION_SETTINGS.LEAST_UP] << 7


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        ({}, "LEARNED"),
        ({"FAST": 1}, "TOO_FAST"),
        ({"TRAFFIC": LEAST, "TILTED": 0}, "LEARNED"),
        ({"TRAFFIC": LEAST - 1, "TILTED": 0}, "HARDLY_MOVES"),
        ({"TRAFFIC": LEAST - 1, "TILTED": LEAST}, "LEARNED"),
        ({"TRAFFIC": LEAST_TILT, "TILTED": LEAST_TILT}, "LEARNED"),
        ({"TRAFFIC": LEAST_TILT, "TILTED": LEAST_TILT - 1}, "HARDLY_MOVES"),
        ({"TRAFFIC": LEAST_TILT - 1, "TILTED": LEAST_TILT}, "HARDLY_MOVES"),
        ({"TRAFFIC": 2 * LEAST_TILT, "TILTED": LEAST_TILT}, "LEARNED"),
        ({"TRAFFIC": 2 * LEAST_TILT + 1, "TILTED": LEAST_TILT}, "HARDLY_MOVES"),
        ({"TURN_SUM": LEAST, "TRAFFIC": 2 * LEAST, "TILTED": 0}, "LEARNED"),
        ({"TURN_SUM": -LEAST, "TRAFFIC": 2 * LEAST, "TILTED": 0}, "LEARNED"),
        ({"TURN_SUM": LEAST, "TRAFFIC": 2 * LEAST - 1, "TILTED": 0}, "HARDLY_MOVES"),
        ({"TURN_SUM": -LEAST, "TRAFFIC": 2 * LEAST - 1, "TILTED": 0}, "HARDLY_MOVES"),
        ({"UP": LEAST_UP}, "LEARNED"),
        ({"UP": LEAST_UP - 1}, "LOST"),
        ({"UP": -LEAST_UP}, "LOST"),
    ],
)
def test_a_window_teaches_where_it_moves_to_and_fro_about_an_upright(window, words, reason):
    for name, value in words.items():
        window[getattr(MOTION, name)] = value
    assert said(window) == (reason == "LEARNED", getattr(MOTION_REASON, reason))


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize(
    ("accepted", "sigmas", "reason"),
    [(3, 3.99, "LEARNED"), (3, 4.01, "TURNED"), (3, -4.01, "TURNED"), (2, 40.0, "LEARNED")],
)
def test_four_sigma_contradict_what_three_windows_agree_on(window, axis, accepted, sigmas, reason):
    window[MOTION.ACCEPTED] = accepted
    put_all(window, MOTION.KNOWN_P, np.diag([100.0, 400.0, 2500.0])[UPPER])
    stored(window, MOTION.PRIOR_MEAN + 2 * axis, 7.0)
    stored(window, MOTION.BIAS + 2 * axis, 7.0 + sigmas * [10, 20, 50][axis])
    learned = reason == "LEARNED"
    assert said(window) == (learned, getattr(MOTION_REASON, reason))
    kept = value_at(window, MOTION.BIAS + 2 * axis)
    assert kept == pytest.approx(7 + sigmas * [10, 20, 50][axis] if learned else 7, rel=1e-6)
    assert window[MOTION.ACCEPTED] == accepted + learned
    assert (window[MOTION.REFUSED], window[MOTION.AGAINST]) == (1 - learned, 1 - learned)


@pytest.mark.parametrize(
    ("axis", "times", "reason"), [(0, 511, "LEARNED"), (0, 513, "TURNED"), (2, 513, "LEARNED")]
)
def test_a_tilt_that_is_far_louder_than_before_is_a_turn_and_a_heading_is_not(
    window, axis, times, reason
):
    stored(window, MOTION.NOISE_ENERGY + 2 * axis, 1000.0 * times)
    assert said(window)[1] == getattr(MOTION_REASON, reason)


def test_what_is_learned_is_held_for_the_next_window(window):
    window[MOTION.AGAINST] = 4
    assert said(window) == LEARNED
    assert numbers(window, MOTION.KNOWN_P, 6) == pytest.approx(50 * np.eye(3)[UPPER])
    held = numbers(window, MOTION.HELD_NOISE, 3)
    assert held == pytest.approx([250, 250, 800], rel=1e-4)
    assert (window[MOTION.ACCEPTED], window[MOTION.AGAINST], window[MOTION.REFUSED]) == (4, 0, 0)


def test_a_turn_that_lasts_widens_what_is_known_after_patience(window):
    patience = SETTINGS[MOTION_SETTINGS.PATIENCE]
    for number in range(1, patience + 1):
        assert numbers(window, MOTION.KNOWN_P, 6) == pytest.approx(100 * np.eye(3)[UPPER])
        stored(window, MOTION.BIAS, 1e4)
        stored(window, MOTION.NOISE_ENERGY, 2000.0)
        assert said(window) == (0, MOTION_REASON.TURNED)
        assert (window[MOTION.REFUSED], window[MOTION.AGAINST]) == (number, number % patience)
    assert numbers(window, MOTION.KNOWN_P, 6) == pytest.approx(25600 * np.eye(3)[UPPER])
    assert numbers(window, MOTION.HELD_NOISE, 3) == pytest.approx([2000, 1000, 1000])
    assert window[MOTION.ACCEPTED] == 3


def test_a_way_lost_for_long_is_a_clear_start(window):
    window[MOTION.UP] = 0
    for _ in range(SETTINGS[MOTION_SETTINGS.PATIENCE]):
        assert window[MOTION.ACCEPTED] == 3
        assert said(window) == (0, MOTION_REASON.LOST)
    new = motion_state(SETTINGS)
    for name in ("ACCEPTED", "AGAINST", "STAGE", "LENGTH", "MISFIT_Q16", "MOTION_QUALITY_Q8"):
        assert window[getattr(MOTION, name)] == new[getattr(MOTION, name)], name
    assert window[MOTION.LENGTH] == 1 << SETTINGS[MOTION_SETTINGS.SHORTEST_STAGE]
    assert not numbers(window, MOTION.BIAS, 3).any()


def test_what_hardly_moves_is_no_contradiction_however_long(window):
    window[MOTION.TRAFFIC] = window[MOTION.TILTED] = 0
    for number in range(1, 20):
        stored(window, MOTION.BIAS, 1e4)
        assert said(window) == (0, MOTION_REASON.HARDLY_MOVES)
        assert (window[MOTION.REFUSED], window[MOTION.AGAINST]) == (number, 0)
    assert value_at(window, MOTION.BIAS) == 0


def test_windows_double_until_they_are_the_longest(state):
    state[MOTION.TRAFFIC] = 1 << 28
    shortest = SETTINGS[MOTION_SETTINGS.SHORTEST_STAGE]
    for stage in range(shortest, shortest + 3):
        assert (state[MOTION.STAGE], state[MOTION.LENGTH]) == (stage, 1 << stage)
        state[MOTION.TAPER_SUM] = 1024 << stage
        assert said(state) == (0, MOTION_REASON.GROWING)
    assert state[MOTION.LENGTH] == SETTINGS[MOTION_SETTINGS.LONGEST]


@pytest.mark.parametrize(
    ("filled", "new", "fast", "begins", "reason"),
    [(16, 8, 0, 1, 0), (15, 8, 0, 0, 0), (16, 7, 0, 0, 0), (16, 8, 1, 0, MOTION_REASON.TOO_FAST)],
)
def test_a_window_begins_where_half_of_it_is_new(state, filled, new, fast, begins, reason):
    state[MOTION.FILLED], state[MOTION.NEW_NODES], state[MOTION.FAST] = filled, new, fast
    for head, first in ((20, 4), (3, 3 - 16 + SETTINGS[MOTION_SETTINGS.NODES])):
        state[MOTION.NEW_NODES], state[MOTION.HEAD] = new, head
        assert motion_verdict.start_window(state, SETTINGS) == begins
        assert state[MOTION.MOTION_REASON] == reason
        assert state[MOTION.NEW_NODES] == (0 if begins or fast else new)
        if begins:
            assert state[MOTION.FIRST_NODE] == first
            assert list(state[MOTION.START : MOTION.START + 4]) == [Q14, 0, 0, 0]


@pytest.mark.parametrize(
    ("length", "accepted", "tilt_rad", "heading_rad"),
    [(16, 0, 0.02, 0.05), (128, 0, 0.1, 0.3)],
)
def test_before_a_bias_is_known_the_prior_is_wide(state, length, accepted, tilt_rad, heading_rad):
    state[MOTION.FILLED] = state[MOTION.NEW_NODES] = state[MOTION.LENGTH] = length
    put_all(state, MOTION.PRIOR_MEAN, [1.0, 2.0, 3.0])
    assert motion_verdict.start_window(state, SETTINGS) == 1
    start = value_at(SETTINGS, MOTION_SETTINGS.START_VARIANCE)
    assert numbers(state, MOTION.KNOWN_P, 6) == pytest.approx(start * np.eye(3)[UPPER])
    assert not numbers(state, MOTION.PRIOR_MEAN, 3).any()
    held = np.square(np.array([tilt_rad, tilt_rad, heading_rad]) * Q12)
    assert numbers(state, MOTION.HELD_NOISE, 3) == pytest.approx(held, rel=1e-3)


def test_a_window_of_full_length_begins_from_what_is_known(window):
    window[MOTION.FILLED] = window[MOTION.NEW_NODES] = window[MOTION.LENGTH]
    put_all(window, MOTION.BIAS, [1.0, 2.0, 3.0])
    assert motion_verdict.start_window(window, SETTINGS) == 1
    assert numbers(window, MOTION.PRIOR_MEAN, 3) == pytest.approx([1, 2, 3])
    assert numbers(window, MOTION.KNOWN_P, 6) == pytest.approx(100 * np.eye(3)[UPPER])
