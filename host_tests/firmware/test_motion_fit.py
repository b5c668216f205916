"""Rows of a window in motion, and the filter that takes them, beside the same in floats."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from zerorate.motion import attitude, least_squares, regression
from zerorate.motion.motion_settings import motion_state
from zerorate_tools.layout import MOTION, MOTION_REASON, MOTION_SETTINGS

from .motions import (
    Q12,
    Q14,
    SETTINGS,
    SIZE,
    STATES,
    covariance_at,
    packed_at,
    positive,
    put_all,
    put_covariance,
    put_packed,
    put_rotation,
    put_words,
    stored,
)

LONGEST = SETTINGS[MOTION_SETTINGS.LONGEST]
SETTLED = 8  # windows
PUSH = 3e14


@pytest.fixture
def state():
    state = motion_state(SETTINGS)
    stored(state, MOTION.PUSH, PUSH)
    return state


def bells(t):
    """Both bells, the slopes that go with them (less, by t / 2), and the third shape."""
    rest = 1 - t**2
    shapes = [6 * t * rest**2, 2 * (7 * t**2 - 1) * rest**2, 11 * t * rest**2 * (3 * t**2 - 1)]
    return [rest**3, 2 * t * rest**3], shapes


@pytest.mark.parametrize("stage", [4, 5, 7])
def test_the_rows_are_the_sums_under_both_bells(state, draw, stage):
    n = 1 << stage
    t = (2 * np.arange(n) + 1 - n) / n
    turns = Rotation.from_rotvec(draw.normal(0, 1, (n, 3)))
    halves, seen = draw.uniform(-0.2, 0.2, (n, 3)), draw.uniform(-1, 1, (n, 3))
    for k in range(n):
        put_rotation(state, MOTION.Q, turns[k], 1 << 28)
        attitude.rotation(state)
        put_words(state, MOTION.HALF, halves[k] * Q14)
        put_words(state, MOTION.Y, seen[k] * Q12)
        regression.weights(state, k, stage, 0)
        regression.rows(state)
    (first, second), shapes = bells(t)
    both = halves + np.vstack([np.zeros(3), halves[:-1]])
    of = turns.as_matrix()
    for r, (bell, shape, i) in enumerate(
        [(first, 0, 0), (first, 0, 1), (first, 0, 2), (second, 1, 0), (second, 1, 1)]
    ):
        row = np.array(state[MOTION.WINDOW_ROWS + SIZE * r : MOTION.WINDOW_ROWS + SIZE * (r + 1)])
        assert row[0] / Q12 == pytest.approx(shapes[shape] @ seen[:, i], abs=n * 0.006)
        assert row[1:4] / Q14 == pytest.approx(bell @ of[:, i], abs=n * 0.004)
        by = np.einsum("m,mj,mk->jk", bell, of[:, i], both)
        assert row[4:13] / Q14 == pytest.approx(by.ravel(), abs=n * 0.003)
        # a force that is too large along an axis of the part tilts the level frame's y or x
        tilting = [-of[:, 1], of[:, 0], 0 * of[:, 2]][i]
        assert row[13:] / Q14 == pytest.approx(shapes[shape] @ tilting, abs=n * 0.004)
    stray = np.array(state[MOTION.STRAY : MOTION.STRAY + 2]) / Q12
    assert stray == pytest.approx([shapes[1] @ seen[:, 2], shapes[2] @ seen[:, 2]], abs=n * 0.006)


def filled(state, draw, accepted):
    """A full window's state with a random row 0 and knowledge; (row, matrix, mean, bias, push)."""
    state[MOTION.STAGE], state[MOTION.LENGTH], state[MOTION.ACCEPTED] = 7, LONGEST, accepted
    row = np.rint(draw.normal(0, 8000, SIZE))
    row[0] *= 3
    put_words(state, MOTION.WINDOW_ROWS, row)
    matrix, mean = positive(draw, 1e-3), draw.normal(0, 1e5, STATES)
    bias, push = draw.normal(0, 1e5, 3), 10.0 ** draw.uniform(13, 15)
    put_covariance(state, matrix)
    put_packed(state, MOTION.MEAN, mean)
    put_all(state, MOTION.BIAS, bias)
    stored(state, MOTION.PUSH, push)
    return row, matrix, mean, bias, push


def taken(state, r=0):
    """The kernels' row r, up to the noise that it tells."""
    least_squares.innovate(state, SETTINGS, r)
    for j in range(STATES):
        least_squares.look(state, r, j)
    least_squares.weigh(state, r)


@pytest.mark.parametrize(("accepted", "far"), [(0, 1.0), (SETTLED - 1, 1e3), (SETTLED, 1e3)])
def test_a_row_moves_and_narrows_as_a_kalman_filter_with_students_tails(state, draw, accepted, far):
    row, matrix, mean, bias, push = filled(state, draw, accepted)
    h = row[1:] * np.repeat([2.0 ** (7 - 15), 2.0**-14], [12, 3])
    off = mean - np.concatenate([bias, np.zeros(STATES - 3)])
    expected = h @ matrix @ h + 2
    # so far that its square is `far` of what was expected
    said = h @ off + np.sqrt(far * push * expected)
    row[0] = np.rint(said / 4096)
    put_words(state, MOTION.WINDOW_ROWS, row)
    innovation = row[0] * 4096 - h @ off
    square = innovation**2 / expected / push
    tail = (4 + square) / 5 if accepted >= SETTLED else 1
    taken(state)
    for_sure = state[MOTION.MOTION_REASON] == MOTION_REASON.TURNED
    assert for_sure == (accepted >= SETTLED and square > 16)
    gain = matrix @ h / (expected + 2 * (tail - 1))
    least_squares.move(state)
    for n in range(STATES):
        least_squares.narrow(state, n)
    moved = packed_at(state, MOTION.MEAN, STATES)
    assert moved == pytest.approx(mean + gain * innovation, rel=2e-3, abs=300)
    left = matrix - np.outer(gain, matrix @ h)
    assert covariance_at(state) == pytest.approx(left, abs=2e-5 * matrix.max())
