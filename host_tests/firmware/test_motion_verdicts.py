"""Which windows in motion teach, which are refused, and what is kept of them."""

import numpy as np
import pytest
from zerorate.motion import in_motion, motion_verdict, traversal
from zerorate.motion.motion_settings import motion_state
from zerorate_tools.layout import MOTION, MOTION_REASON, MOTION_SETTINGS

from .motions import (
    Q12,
    Q14,
    SETTINGS,
    STATES,
    covariance_at,
    numbers,
    packed_at,
    put_all,
    put_words,
    value_at,
)


@pytest.fixture
def state():
    return motion_state(SETTINGS)


@pytest.fixture
def window(state):
    """A state whose window of full length moved to and fro, and stays level."""
    stage = SETTINGS[MOTION_SETTINGS.SHORTEST_STAGE] + 3
    state[MOTION.STAGE], state[MOTION.LENGTH] = stage, 1 << stage
    state[MOTION.ACCEPTED] = 3
    state[MOTION.UP] = Q12 << stage
    state[MOTION.TRAFFIC] = state[MOTION.TILTED] = 2 * SETTINGS[MOTION_SETTINGS.LEAST_TRAFFIC] << 7
    return state


def said(state):
    """Whether the rows of the window are looked at, and what it taught."""
    state[MOTION.JOB] = SOLVE
    in_motion.open_rows(state, SETTINGS)
    return state[MOTION.JOB] == SOLVE, state[MOTION.MOTION_REASON]


SOLVE = 2
PATIENCE = SETTINGS[MOTION_SETTINGS.PATIENCE]
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


def test_a_contradiction_that_lasts_is_a_clear_start(window):
    put_all(window, MOTION.BIAS, [1e4, 2e4, 3e4])
    for number in range(1, PATIENCE):
        window[MOTION.MOTION_REASON] = MOTION_REASON.TURNED
        assert motion_verdict.finish(window, SETTINGS) == 1
        assert (window[MOTION.REFUSED], window[MOTION.AGAINST]) == (number, number)
    window[MOTION.MOTION_REASON] = MOTION_REASON.LEARNED
    assert motion_verdict.finish(window, SETTINGS) == 1
    assert (window[MOTION.REFUSED], window[MOTION.AGAINST]) == (PATIENCE - 1, 0)
    for number in range(1, PATIENCE + 1):
        assert window[MOTION.ACCEPTED] == 3 + PATIENCE + number - 1
        window[MOTION.MOTION_REASON] = MOTION_REASON.TURNED
        assert motion_verdict.finish(window, SETTINGS) == (number < PATIENCE)
    assert_clear(window)


def assert_clear(window):
    new = motion_state(SETTINGS)
    for name in ("ACCEPTED", "AGAINST", "STAGE", "LENGTH", "ROWS_SEEN", "MOTION_QUALITY_Q8"):
        assert window[getattr(MOTION, name)] == new[getattr(MOTION, name)], name
    assert window[MOTION.KNOWN : MOTION.HELD_STRAY] == new[MOTION.KNOWN : MOTION.HELD_STRAY]
    assert window[MOTION.LENGTH] == 1 << SETTINGS[MOTION_SETTINGS.SHORTEST_STAGE]
    assert not numbers(window, MOTION.BIAS, 3).any()


def test_a_way_lost_for_long_is_a_clear_start(window):
    window[MOTION.UP] = 0
    for _ in range(PATIENCE):
        assert window[MOTION.ACCEPTED] == 3
        assert said(window) == (0, MOTION_REASON.LOST)
    assert_clear(window)


def test_what_hardly_moves_is_no_contradiction_however_long(window):
    window[MOTION.TRAFFIC] = window[MOTION.TILTED] = 0
    for number in range(1, 20):
        assert said(window) == (0, MOTION_REASON.HARDLY_MOVES)
        assert (window[MOTION.REFUSED], window[MOTION.AGAINST]) == (number, 0)
    assert window[MOTION.ACCEPTED] == 3


def test_windows_double_until_they_are_the_longest(state):
    state[MOTION.TRAFFIC] = 1 << 28
    shortest = SETTINGS[MOTION_SETTINGS.SHORTEST_STAGE]
    for stage in range(shortest, shortest + 3):
        assert (state[MOTION.STAGE], state[MOTION.LENGTH]) == (stage, 1 << stage)
        assert said(state) == (1, MOTION_REASON.GROWING)
        in_motion.grow(state, SETTINGS)
    assert state[MOTION.LENGTH] == SETTINGS[MOTION_SETTINGS.LONGEST]
    state[MOTION.LENGTH] = 16
    state[MOTION.TRAFFIC] = 0
    in_motion.grow(state, SETTINGS)
    assert (state[MOTION.LENGTH], state[MOTION.REFUSED]) == (16, 1)


@pytest.mark.parametrize(("accepted", "beside"), [(0, True), (7, True), (8, False)])
def test_while_little_is_known_motion_is_what_is_beside_a_steady_turn(window, accepted, beside):
    steady = [300, -20, 7]
    put_words(window, MOTION.TURN_SUM, [turn << 7 for turn in steady])
    window[MOTION.ACCEPTED], window[MOTION.PASS] = accepted, 1
    in_motion.begin_traversal(window, SETTINGS)
    assert list(window[MOTION.TURN_MEAN : MOTION.TURN_MEAN + 3]) == (steady if beside else [0] * 3)
    put_all(window, MOTION.BIAS, np.zeros(3))
    put_words(window, MOTION.R, Q14 * np.eye(3).ravel())
    at, extra = MOTION.NODES_RING, np.array([5, -3, 1])
    put_words(window, at, (2 * (np.array(steady) + extra) // 2) << 15)
    traversal.remove_bias(window, at)
    turn = extra if beside else extra + steady
    assert list(window[MOTION.TURN_SUM : MOTION.TURN_SUM + 3]) == list(turn)
    assert window[MOTION.TRAFFIC] == np.abs(turn).sum()
    assert traversal.tilting(window, 0) == abs(turn[0])


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


def test_before_a_bias_is_known_it_may_be_anything(window):
    motion_verdict.know_nothing(window, SETTINGS)
    start = value_at(SETTINGS, MOTION_SETTINGS.START_VARIANCE)
    entry = value_at(SETTINGS, MOTION_SETTINGS.MATRIX_ERROR)
    force = value_at(SETTINGS, MOTION_SETTINGS.FORCE_ERROR)
    expected = np.diag([start] * 3 + [entry] * 9 + [force] * 3)
    assert covariance_at(window) == pytest.approx(expected, rel=1e-5)
    assert not packed_at(window, MOTION.MEAN, STATES).any()
    # by the settings: 20 dps, 1 %, 5 mg and 50 mg, of the half windows that a row sums
    push = value_at(window, MOTION.PUSH)
    assert push == pytest.approx((0.05 * (1 << 24)) ** 2 * 64 * 2.66, rel=1e-3)
    assert np.sqrt(force * push) == pytest.approx(0.005 * (1 << 24), rel=1e-3)
    assert np.sqrt(start * push) == pytest.approx(np.radians(20) / 8 * (1 << 24), rel=1e-3)
    assert np.sqrt(entry * push) == pytest.approx(0.01 * (1 << 24), rel=1e-3)
