"""Sums and least squares of a window in motion beside the same in floats."""

import numpy as np
import pytest
from zerorate.motion import least_squares, regression
from zerorate.motion.motion_settings import motion_settings, motion_state
from zerorate_tools.layout import COMPONENT, MOTION, MOTION_SETTINGS

from .motion_words import (
    Q12,
    Q14,
    SETTINGS,
    SIZE,
    UPPER,
    numbers,
    positive,
    put_all,
    put_words,
    symmetric,
)
from .motions import stored, value_at


@pytest.fixture
def state():
    return motion_state(SETTINGS)


@pytest.fixture(params=range(4))
def draw(request):
    return np.random.default_rng(request.param)


def summed(state, stage, even, draw, mean_m):
    """(M, y, t) of a window whose sums were taken by the kernels, as numbers."""
    n = 1 << stage
    t = (2 * np.arange(n) + 1 - n) / n
    m = mean_m + draw.uniform(-0.3, 0.3, (n, 3))
    y = draw.uniform(-1, 1, n)
    state[MOTION.STAGE] = stage
    for k in range(n):
        regression.taper(state, k, stage, even)
        put_words(state, MOTION.SUM_R, m[k] * Q14 * n)
        regression.regressors(state, MOTION.SUM_R, stage)
        regression.first_sums(state, MOTION.SUMS + SIZE, round(y[k] * Q12))
        regression.second_sums(state, MOTION.SUMS + SIZE)
    return m, y, t


@pytest.mark.parametrize("even", [0, 1])
@pytest.mark.parametrize("stage", [4, 5, 7])
def test_the_sums_of_a_window_are_those_of_the_tapered_fit(state, draw, stage, even):
    mean_m = draw.uniform(-1, 1, 3)
    m, y, t = summed(state, stage, even, draw, mean_m)
    taper = 1 - t**4
    weight = np.ones(len(t)) if even else taper
    shapes = [(21 / 5 * t**2 - 1) * taper, (15 / 7 * t**3 - t) * taper]
    at = MOTION.SUMS + SIZE

    def near(name, expected, unit):
        word = at + getattr(COMPONENT, name)
        found = np.array(state[word : word + np.size(expected)]) / unit
        assert found == pytest.approx(np.ravel(expected), abs=len(t) * 0.004), name

    assert state[MOTION.TAPER_SUM] / 1024 == pytest.approx(weight.sum(), abs=0.2)
    near("SUM_MM", (m.T * weight @ m)[UPPER], 1 << 18)
    near("SUM_MY", m.T * weight @ y, 1 << 16)
    near("SUM_M", weight @ m, Q14)
    near("SUM_Y", weight @ y, Q12)
    near("SHAPES_M", [shape @ m for shape in shapes], Q14)
    near("SHAPES_Y", [shape @ y for shape in shapes], Q12)
    put_words(state, MOTION.CENTRE + 3, [0, 5 << stage, 0])
    regression.centre(state, at, 3, stage)
    centred = m - weight @ m / weight.sum()
    near("SUM_MM", (centred.T * weight @ centred)[UPPER], 1 << 18)
    near("SUM_MY", centred.T * weight @ y, 1 << 16)
    near("SUM_Y", [weight @ y / weight.sum()], Q12)
    left = np.array(state[MOTION.CENTRE + 3 : MOTION.CENTRE + 6]) / (Q14 << stage)
    assert -left == pytest.approx(weight @ m / weight.sum(), abs=0.003)


def test_what_a_bias_about_the_vertical_would_turn_is_taken_from_a_row(state, draw):
    vertical, row = draw.normal(size=3), draw.uniform(-1, 1, 3)
    vertical /= np.linalg.norm(vertical)
    put_words(state, MOTION.VERTICAL, vertical * Q14)
    put_words(state, MOTION.M, row * Q14)
    regression.look_past_vertical(state)
    left = np.array(state[MOTION.M : MOTION.M + 3]) / Q14
    assert left == pytest.approx(row - row @ vertical * vertical, abs=3e-4)


def test_the_normal_equations_are_solved_as_numpy_solves_them(state, draw):
    state[MOTION.STAGE] = stage = 7
    weights, prior = draw.uniform(0.5, 2, 3), positive(draw)
    bias, mean = draw.normal(size=(2, 3))
    sums = np.stack([positive(draw, 2.0**26) for _ in range(3)])
    with_y = draw.normal(0, 2.0**18, (3, 3))
    for i in range(3):
        put_words(state, MOTION.SUMS + SIZE * i + COMPONENT.SUM_MM, sums[i][UPPER])
        put_words(state, MOTION.SUMS + SIZE * i + COMPONENT.SUM_MY, with_y[i])
    put_all(state, MOTION.OMEGA, weights)
    put_all(state, MOTION.PRIOR, prior[UPPER])
    put_all(state, MOTION.BIAS, bias)
    put_all(state, MOTION.PRIOR_MEAN, mean)
    for n in range(6):
        least_squares.matrix_element(state, n)
    for i in range(3):
        least_squares.right_side(state, i)
    matrix = prior + np.tensordot(weights, sums, 1) * 2.0 ** (2 * stage - 42)
    right = weights @ with_y * 2.0 ** (stage - 16) + prior @ (mean - bias)
    for k in range(3):
        least_squares.sweep(state, k)
    found = [value_at(state, least_squares.place(i, 3)) for i in range(3)]
    assert found == pytest.approx(np.linalg.solve(matrix, right), rel=1e-4, abs=1e-5)
    least_squares.covariance(state, MOTION.KNOWN_P)
    inverse = np.linalg.inv(matrix)
    assert symmetric(numbers(state, MOTION.KNOWN_P, 6)) == pytest.approx(inverse, rel=1e-4)
    # what is swept is put back to be swept again
    least_squares.spread_prior(state)
    for k in range(3):
        least_squares.sweep(state, k)
    least_squares.covariance(state, MOTION.PRIOR)
    assert symmetric(numbers(state, MOTION.PRIOR, 6)) == pytest.approx(matrix, rel=1e-3, abs=1e-3)


@pytest.mark.parametrize("size", [0.1, 1.0, 8.0])
def test_a_step_is_no_longer_than_what_stays_linear(state, draw, size):
    state[MOTION.STAGE] = 7
    limit = 0.7 * (1 << 24) / 128
    slope = size * limit * draw.choice([-1, 1], 3) * [0.2, 1, 0.5]
    for i in range(3):
        stored(state, least_squares.place(i, 3), slope[i])
    least_squares.step(state)
    expected = slope * min(1, 1 / size)
    assert numbers(state, MOTION.SLOPE, 3) == pytest.approx(expected, rel=1e-5)


def noise_of(state, i, slope, stage):
    """Noise energy of component i beside the fit, Q24 rad^2 a node, by the words of the kernel."""
    at = MOTION.SUMS + SIZE * i
    m = np.reshape(state[at + COMPONENT.SHAPES_M : at + COMPONENT.SHAPES_M + 6], (2, 3))
    y = np.array(state[at + COMPONENT.SHAPES_Y : at + COMPONENT.SHAPES_Y + 2])
    left = y - m @ slope * 2.0 ** (stage - 26)
    # the mean squares of the two shapes under the taper, each summed with half the weight
    t = (2 * np.arange(4096) + 1 - 4096) / 4096
    taper = 1 - t**4
    squares = np.mean(np.square([21 / 5 * t**2 - 1, 15 / 7 * t**3 - t]) * taper, axis=1)
    return (left**2 / squares).sum() / 2 / 2**stage


@pytest.mark.parametrize("stage", [4, 7])
def test_noise_is_what_the_slope_leaves_of_the_neighbouring_shapes(state, draw, stage):
    state[MOTION.STAGE] = stage
    slope = draw.normal(0, 2.0**16, 3)
    put_all(state, MOTION.SLOPE, slope)
    for i, floor_rad in enumerate([0.005, 0.005, 0.01]):
        at = MOTION.SUMS + SIZE * i
        put_words(state, at + COMPONENT.SHAPES_M, draw.normal(0, Q14, 6))
        put_words(state, at + COMPONENT.SHAPES_Y, draw.normal(0, 20 * Q12, 2))
        least_squares.noise(state, i)
        expected = noise_of(state, i, slope, stage) + (floor_rad * Q12) ** 2
        assert value_at(state, MOTION.OMEGA + 2 * i) == pytest.approx(expected, rel=0.02)
        put_words(state, at + COMPONENT.SHAPES_M, np.zeros(8))
        least_squares.noise(state, i)
        assert value_at(state, MOTION.OMEGA + 2 * i) == pytest.approx(
            (floor_rad * Q12) ** 2, rel=2e-3
        )


def test_weights_are_one_over_noise_and_false_turn(state, draw):
    """Both tilts alike, none below what earlier windows had; the scale's error by the mean turn."""
    state[MOTION.STAGE] = stage = 6
    energies, held = draw.uniform(1e3, 1e5, (2, 3))
    turns, taper = draw.normal(0, 3e5, 3), 51000
    put_all(state, MOTION.OMEGA, energies)
    put_all(state, MOTION.HELD_NOISE, held)
    put_words(state, MOTION.TURN_SUM, turns)
    state[MOTION.TAPER_SUM] = taper
    squares = draw.uniform(0.2, 1, (3, 3)) * 2.0**26
    for i in range(3):
        at = MOTION.SUMS + SIZE * i + COMPONENT.SUM_MM
        put_words(state, at, positive(draw, 1e6)[UPPER])
        for word, square in zip((0, 3, 5), squares[i]):
            state[at + word] = int(square)
    least_squares.weights(state, SETTINGS)
    energies[:2] = energies[:2].mean()
    used = np.maximum(energies, held)
    false = ((turns / taper * 2**21) ** 2).sum() * 0.01**2
    spread = [SETTINGS[MOTION_SETTINGS.TILT_SPREAD]] * 2 + [
        SETTINGS[MOTION_SETTINGS.HEADING_SPREAD]
    ]
    of_m = squares.sum(axis=1) * 2.0 ** (2 * stage - 42)
    assert numbers(state, MOTION.NOISE_ENERGY, 3) == pytest.approx(used, rel=1e-5)
    expected = 1 / (spread * used + of_m * false)
    assert numbers(state, MOTION.OMEGA, 3) == pytest.approx(expected, rel=1e-4)
    least_squares.held_weights(state, SETTINGS)
    assert numbers(state, MOTION.OMEGA, 3) == pytest.approx(1 / (spread * held), rel=1e-5)


def test_the_documents_own_slope_looks_at_no_other_axis(state, draw):
    settings = motion_settings(document=True)
    state[MOTION.STAGE] = stage = 5
    energies = draw.uniform(1e3, 1e5, 3)
    put_all(state, MOTION.OMEGA, energies)
    for i in range(3):
        at = MOTION.SUMS + SIZE * i
        own, with_y = draw.uniform(0.2, 1) * 2.0**26, draw.normal(0, 2.0**18)
        state[at + COMPONENT.SUM_MM + (0, 3, 5)[i]] = int(own)
        state[at + COMPONENT.SUM_MY + i] = int(with_y)
        least_squares.own_slope(state, i)
        own *= 2.0 ** (2 * stage - 42)
        slope = with_y * 2.0 ** (stage - 16) / own
        assert value_at(state, MOTION.SLOPE + 2 * i) == pytest.approx(slope, rel=1e-4)
        least_squares.own_variance(state, settings, i)
        variance = -value_at(state, least_squares.place(i, i))
        assert variance == pytest.approx(20 * energies[i] / own, rel=1e-4)
