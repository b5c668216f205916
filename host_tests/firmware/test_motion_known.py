"""What is kept and published of windows in motion beside the same in floats."""

import numpy as np
import pytest
from zerorate.motion import least_squares, posterior, thermal
from zerorate.motion.motion_settings import motion_state
from zerorate_tools.layout import MOTION, MOTION_SETTINGS

from .motion_words import (
    SETTINGS,
    covariance_at,
    numbers,
    packed_at,
    positive,
    put_all,
    put_covariance,
    put_packed,
)
from .motions import stored, value_at

PUSH = 3e14


@pytest.fixture
def state():
    state = motion_state(SETTINGS)
    stored(state, MOTION.PUSH, PUSH)
    return state


@pytest.fixture(params=range(4))
def draw(request):
    return np.random.default_rng(request.param)


def slopes_at(state):
    """Slopes, their covariances with the biases, their variances: (3, 3)."""
    return packed_at(state, MOTION.TEMP_SLOPES, 9).reshape(3, 3).T


@pytest.mark.parametrize("degrees", [-3.0, 0.0, 0.25, 20.0])
def test_the_slope_over_temperature_is_a_kalman_filters(state, draw, degrees):
    """Two states an axis, bias and slope: carried along the slope, then told by a row."""
    thermal.forget_slopes(state, SETTINGS)
    start = value_at(SETTINGS, MOTION_SETTINGS.TEMP_SLOPE_START) / PUSH
    walk = value_at(SETTINGS, MOTION_SETTINGS.BIAS_WALK) / PUSH
    assert slopes_at(state) == pytest.approx(np.outer([0, 0, start], np.ones(3)), rel=1e-5)
    means, matrix = draw.normal(0, 1e5, 3), positive(draw, 1e-6, 12)
    slopes, covariances, spreads = np.zeros(3), np.zeros(3), np.full(3, start)
    put_covariance(state, matrix)
    put_packed(state, MOTION.MEAN, means)
    for there in (degrees, -degrees / 2, degrees):
        change = round(there * 340)
        state[MOTION.THEN_TEMP_Q8] = 1000
        state[MOTION.TEMP_Q8], state[MOTION.AGE_NODES] = 1000 + 256 * change, 64
        removed = numbers(state, MOTION.BIAS, 3)
        thermal.carry(state, SETTINGS, 1)
        assert (state[MOTION.THEN_TEMP_Q8], state[MOTION.AGE_NODES]) == (1000 + 256 * change, 0)
        means = means + slopes * change
        grown = 2 * covariances * change + spreads * change**2
        matrix[range(3), range(3)] += np.maximum(grown, 0) + 64 * walk
        covariances = covariances + spreads * change
        spreads = spreads + start * abs(change) / 2 ** SETTINGS[MOTION_SETTINGS.BEND]
        assert packed_at(state, MOTION.MEAN, 3) == pytest.approx(means, rel=1e-3, abs=1)
        assert covariance_at(state) == pytest.approx(matrix, rel=1e-3, abs=1e-10)
        moved = numbers(state, MOTION.BIAS, 3) - removed
        assert moved == pytest.approx(slopes * change, rel=1e-3, abs=1)
        # what a row tells a slope goes through its own bias
        variances = matrix.diagonal()[:3].copy()
        share, innovation = draw.uniform(-0.9, 0.9, 3), draw.normal(0, 1e5)
        put_all(state, MOTION.WITH, share * np.sqrt(variances))
        stored(state, MOTION.EXPECTED, 1.0)
        stored(state, MOTION.ROW_INNOVATION, innovation)
        for i in range(3):
            thermal.learn_slope(state, i)
        gain = covariances / variances
        slopes = slopes + gain * share * np.sqrt(variances) * innovation
        spreads = np.maximum(spreads - gain**2 * share**2 * variances, 0)
        covariances = covariances * (1 - share**2)
        matrix[range(3), range(3)] = variances * (1 - share**2)
        put_covariance(state, matrix)
        found = slopes_at(state)
        assert found[0] == pytest.approx(slopes, rel=2e-3, abs=1e-2)
        assert found[1] == pytest.approx(covariances, rel=2e-3, abs=start * 1e-3)
        assert found[2] == pytest.approx(spreads, rel=2e-3, abs=start * 1e-3)
    state[MOTION.NOW_TEMP_Q8] = state[MOTION.THEN_TEMP_Q8] + 256 * 170
    put_all(state, MOTION.SLOPE, [1e5, -2e5, 3e5])
    at_present = [1e5, -2e5, 3e5] + 170 * slopes
    found = []
    for i in range(3):
        thermal.present(state, i)
        found.append(value_at(state, MOTION.T1))
    assert found == pytest.approx(at_present, rel=1e-3, abs=10)


def test_nothing_is_carried_while_nothing_is_known(state):
    before = state[MOTION.KNOWN : MOTION.MEAN + 12]
    state[MOTION.TEMP_Q8], state[MOTION.AGE_NODES] = 1 << 16, 64
    thermal.carry(state, SETTINGS, 0)
    assert state[MOTION.KNOWN : MOTION.MEAN + 12] == before
    assert (state[MOTION.THEN_TEMP_Q8], state[MOTION.AGE_NODES]) == (1 << 16, 0)


def test_the_thermometer_is_followed_closely_and_as_a_windows_middle(state):
    thermal.follow_temperature(state, -500)
    near, behind = MOTION.NOW_TEMP_Q8, MOTION.TEMP_Q8
    assert (state[near], state[behind]) == (-500 * 256, -500 * 256)
    state[MOTION.FILLED] = 1
    for nodes in (4, 64):
        state[near] = state[behind] = 0
        for _ in range(nodes):
            thermal.follow_temperature(state, 1000)
        assert state[near] / 256000 == pytest.approx(1 - 0.75**nodes, abs=1e-4)
        assert state[behind] / 256000 == pytest.approx(1 - (63 / 64) ** nodes, abs=1e-3)


def test_what_is_published_is_the_mean_under_a_prior_with_cauchys_tails(state, draw):
    """Rounds of a normal prior of variance (usual^2 + b^2) / 2, by numpy."""
    lsb = value_at(SETTINGS, MOTION_SETTINGS.LSB_A_UNIT)
    usual = value_at(SETTINGS, MOTION_SETTINGS.USUAL)
    matrix = positive(draw, usual * 4 / PUSH, 12)
    bias = draw.normal(0, 3, 3) * usual**0.5
    put_covariance(state, matrix)
    put_packed(state, MOTION.MEAN, bias)
    spread = PUSH * matrix[:3, :3]
    found = np.zeros(3)
    posterior.know_prior(state)
    for _ in range(6):
        posterior.weigh_prior(state, SETTINGS)
        for k in range(3):
            least_squares.sweep(state, k)
        posterior.shrink(state, SETTINGS)
        prior = np.diag((usual + found**2) / 2)
        found = prior @ np.linalg.solve(spread + prior, bias)
        assert numbers(state, MOTION.SLOPE, 3) == pytest.approx(
            found, rel=2e-3, abs=usual**0.5 / 1e3
        )
    posterior.publish(state, SETTINGS)
    published = state[MOTION.MOTION_BIAS_Q8 : MOTION.MOTION_BIAS_Q8 + 3]
    assert list(published) == pytest.approx(found * lsb, rel=2e-3, abs=50)
    prior = (usual + bias**2) / 2
    own = spread.diagonal()
    sigma = np.sqrt(own * prior / (own + prior)) * lsb
    published = state[MOTION.MOTION_QUALITY_Q8 : MOTION.MOTION_QUALITY_Q8 + 3]
    assert list(published) == pytest.approx(sigma, rel=2e-3)
