"""What is kept and published of windows in motion beside the same in floats."""

import numpy as np
import pytest
from zerorate.motion import least_squares, posterior, thermal
from zerorate.motion.motion_settings import motion_state
from zerorate_tools.layout import MOTION, MOTION_SETTINGS

from .motion_words import SETTINGS, UPPER, numbers, positive, put_all, put_words
from .motions import stored, value_at


@pytest.fixture
def state():
    return motion_state(SETTINGS)


@pytest.fixture(params=range(4))
def draw(request):
    return np.random.default_rng(request.param)


def packed_at(state, i):
    """(slope, covariance, variance) of axis i."""
    for k in range(3):
        thermal.unpack(state, MOTION.T + 2 * k, MOTION.TEMP_SLOPES + 3 * i + k)
    return numbers(state, MOTION.T, 3)


@pytest.mark.parametrize("degrees", [-3.0, 0.0, 0.25, 20.0])
def test_the_slope_over_temperature_is_a_kalman_filters(state, draw, degrees):
    """Two states an axis, bias and slope: carried along the slope, then told by the window."""
    thermal.forget_slopes(state, SETTINGS)
    start = value_at(SETTINGS, MOTION_SETTINGS.TEMP_SLOPE_START)
    walk = value_at(SETTINGS, MOTION_SETTINGS.BIAS_WALK)
    assert packed_at(state, 0) == pytest.approx([0, 0, start], rel=1e-5)
    means, variances = draw.normal(0, 1e5, 3), draw.uniform(1e7, 1e8, 3)
    put_all(state, MOTION.PRIOR_MEAN, means)
    for i in range(3):
        stored(state, thermal.variance_at(i), variances[i])
    slopes, covariances, spreads = np.zeros(3), np.zeros(3), np.full(3, start)
    for there in (degrees, -degrees / 2, degrees):
        change = round(there * 340)
        state[MOTION.THEN_TEMP_Q8] = 1000
        state[MOTION.TEMP_Q8], state[MOTION.AGE_NODES] = 1000 + 256 * change, 64
        put_all(state, MOTION.PRIOR_MEAN, means)
        thermal.carry(state, SETTINGS, 1)
        assert (state[MOTION.THEN_TEMP_Q8], state[MOTION.AGE_NODES]) == (1000 + 256 * change, 0)
        means = means + slopes * change
        grown = 2 * covariances * change + spreads * change**2
        variances = variances + np.maximum(grown, 0) + 64 * walk
        covariances = covariances + spreads * change
        spreads = spreads + start * abs(change) / 2 ** SETTINGS[MOTION_SETTINGS.BEND]
        found = [value_at(state, thermal.variance_at(i)) for i in range(3)]
        assert numbers(state, MOTION.PRIOR_MEAN, 3) == pytest.approx(means, rel=1e-4, abs=1)
        assert found == pytest.approx(variances, rel=1e-4)
        biases, after = means + draw.normal(0, 1e4, 3), variances * draw.uniform(0.1, 0.9, 3)
        put_all(state, MOTION.BIAS, biases)
        for i in range(3):
            stored(state, least_squares.place(i, i), -after[i])
            thermal.learn_slope(state, i)
            stored(state, thermal.variance_at(i), after[i])
        gain = covariances / variances
        slopes = slopes + gain * (biases - means)
        spreads = np.maximum(spreads - gain**2 * (variances - after), 0)
        covariances, variances, means = gain * after, after, biases
        found = np.array([packed_at(state, i) for i in range(3)]).T
        assert found[0] == pytest.approx(slopes, rel=1e-3, abs=1e-3)
        assert found[1] == pytest.approx(covariances, rel=1e-3, abs=1e-3)
        assert found[2] == pytest.approx(spreads, rel=1e-3, abs=start * 1e-4)
    state[MOTION.NOW_TEMP_Q8] = state[MOTION.THEN_TEMP_Q8] + 256 * 170
    for i in range(3):
        thermal.present(state, i)
        at_present = biases[i] + 170 * slopes[i]
        assert value_at(state, MOTION.T1) == pytest.approx(at_present, rel=1e-3)


def test_nothing_is_carried_while_nothing_is_known(state):
    before = state[MOTION.KNOWN_P : MOTION.PRIOR_MEAN + 6]
    state[MOTION.TEMP_Q8], state[MOTION.AGE_NODES] = 1 << 16, 64
    thermal.carry(state, SETTINGS, 0)
    assert state[MOTION.KNOWN_P : MOTION.PRIOR_MEAN + 6] == before
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
    known = positive(draw, usual * 4)
    bias, misfit = draw.normal(0, 3, 3) * usual**0.5, draw.uniform(0.1, 3)
    turns = np.rint(draw.normal(0, 40, (3, 3)))
    put_all(state, MOTION.KNOWN_P, known[UPPER])
    put_all(state, MOTION.BIAS, bias)
    put_words(state, MOTION.TURN_MEAN, turns.ravel())
    state[MOTION.MISFIT_Q16] = round(misfit * (1 << 16))
    spread = 4 * misfit * known
    spread += np.diag((turns**2).sum(axis=1) * 2.0**22 * 0.01**2)
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


def test_the_mean_turn_follows_windows_by_what_each_taught(state, draw):
    before, turns = np.rint(draw.normal(0, 500, (3, 3))), draw.normal(0, 3e5, 3)
    put_words(state, MOTION.TURN_MEAN, before.ravel())
    put_words(state, MOTION.TURN_SUM, turns)
    state[MOTION.TAPER_SUM] = taper = 51000
    gains = draw.uniform(0, 1, 3)
    for i in range(3):
        stored(state, thermal.variance_at(i), 8.0)
        stored(state, least_squares.place(i, i), -8.0 * (1 - gains[i]))
        posterior.follow_turn(state, i)
    expected = before + gains[:, None] * (turns * 1024 / taper - before)
    assert list(state[MOTION.TURN_MEAN : MOTION.TURN_MEAN + 9]) == pytest.approx(
        expected.ravel(), abs=1.5
    )
