"""Peers are given the same samples and find what they can."""

from dataclasses import replace

import numpy as np
import pytest
from zerorate import Corrector
from zerorate.rest import fit
from zerorate_bench.accuracy import second_power_on
from zerorate_bench.bayes import believed, segments, told_everything, told_the_future
from zerorate_bench.motion import bayes_error, with_flicker
from zerorate_bench.peers import HOW, PEERS, ardupilot_cubic, px4_cubic
from zerorate_tools.layout import ESTIMATOR, SETTINGS
from zerorate_tools.peers import given
from zerorate_tools.simulate import simulate, simulate_sessions

CURVED = {
    "name": "curved",
    "seed": 1,
    "sensor": {"odr_hz": 50.0, "gyro_noise_dps": 0.05},
    "bias": {"b0": [1.0, -0.5, 0.2], "b1": [0.03, -0.02, 0.01], "b2": [4e-4, -2e-4, 1e-4]},
    "session": [
        {"start_degc": 20.0, "temperature": [{"to": 40.0, "minutes": 10}]},
        {"start_degc": 25.0, "temperature": [{"to": 35.0, "minutes": 2}]},
    ],
}
# noise of 0.05 dps over some 500 readings a degree, and a curve of second order held by a third
CUBIC_DPS = 0.02


@pytest.fixture(scope="module")
def second_of_a():
    pytest.importorskip("imufusion")
    peers = {name: PEERS[name] for name in ("mean of the first 10 s", "imufusion", "zerorate")}
    return second_power_on("warm-up-a", peers, seeds=(1,))


def test_on_the_mild_part_the_order_is_zerorate_imufusion_ten_seconds(second_of_a):
    errors = [second_of_a[name]["all"] for name in second_of_a]
    assert errors == sorted(errors, reverse=True)
    assert errors[-1] > 0


def test_the_first_seconds_are_judged_apart(second_of_a):
    assert second_of_a["imufusion"]["first"] > 2 * second_of_a["imufusion"]["all"]


@pytest.mark.parametrize("cubic", [px4_cubic, ardupilot_cubic])
def test_a_cubic_fitted_on_the_first_power_on_holds_in_the_second(cubic):
    sessions, truths = [], []
    for recording, truth in simulate_sessions(CURVED):
        sessions.append(given(recording, truth.still))
        truths.append(truth.bias_lsb / recording.scales.gyro_lsb_per_dps)
    assert np.abs(cubic(sessions)[1] - truths[1]).max() < CUBIC_DPS


def test_of_every_row_the_table_says_how_it_came_about():
    assert set(HOW) == set(PEERS)


FLICKERING = {
    "name": "flickering",
    "seed": 3,
    "sensor": {"odr_hz": 25.0, "gyro_noise_dps": 0.05},
    "bias": {"b0": [1.0, -0.5, 0.2], "b1": [0.01, 0.02, 0.03]},
    "noise": {"bias_instability_dps": 0.002},
    "session": [{"start_degc": 20.0, "temperature": [{"to": 30.0, "minutes": 30}]}],
}
# the spectrum of half an hour, in bands, is not quite the one that made it
SPECTRUM_OF_HALF_AN_HOUR = 1.03


@pytest.mark.parametrize("samples", [9, 25, 75, 251, 751])
def test_no_mean_of_readings_around_a_moment_comes_below_who_is_told_the_spectra(samples):
    recording, truth = next(iter(simulate_sessions(FLICKERING)))
    true_dps = truth.bias_lsb / recording.scales.gyro_lsb_per_dps
    window = np.ones(samples) / samples
    error = [
        np.convolve(recording.gyro_dps()[:, axis], window, "valid")
        - true_dps[samples // 2 : len(true_dps) - samples // 2, axis]
        for axis in range(3)
    ]
    floor_dps = told_the_future(FLICKERING, 3)
    assert np.sqrt(np.mean(np.square(error))) > floor_dps / SPECTRUM_OF_HALF_AN_HOUR


def test_who_is_told_the_future_leaves_less_than_who_follows():
    left_dps = np.sqrt(np.mean(np.square(told_everything(FLICKERING, 3)[1500:])))
    assert 0.001 < told_the_future(FLICKERING, 3) < left_dps


PARTS = range(1, 7)


def rests_so_far(recording, truth, samples):
    """The mean of every reading at rest before each of those samples, dps."""
    still = truth.still[:, None]
    sums = np.cumsum(recording.gyro_dps() * still, axis=0)
    return sums[samples] / np.cumsum(still, axis=0)[samples]


@pytest.fixture(scope="module", params=[1, 2])
def judged(request):
    """Of parts with that flicker noise, mdps: error, one sigma, and error of the mean of rests."""
    scene = with_flicker("rests-30", request.param / 1000)
    scene = replace(scene, bias=replace(scene.bias, b1=0.0))
    rows = []
    for part in PARTS:
        recording, truth = simulate(scene, session=1, seed=part)
        error, sigma = bayes_error(scene, recording, truth)
        samples = np.arange(999, len(truth.still), 1000)[-len(error) :]
        true_dps = truth.bias_lsb[samples] / recording.scales.gyro_lsb_per_dps
        rows.append((error, sigma, rests_so_far(recording, truth, samples) - true_dps))
    return [np.concatenate(column) for column in zip(*rows)]


def test_the_truth_is_within_two_sigma_as_often_as_gaussian_noise_is(judged):
    error, sigma, _ = judged
    assert 0.92 < np.mean(np.abs(error) < 2 * sigma) < 0.99


def test_its_error_is_below_that_of_the_mean_of_all_rests(judged):
    error, _, of_the_mean = judged
    assert np.sqrt(np.mean(error**2)) < np.sqrt(np.mean(of_the_mean**2))


def test_what_comes_after_a_moment_changes_nothing_of_it():
    n, hz = 2500, 25.0
    rate_dps = np.random.default_rng(1).normal(0.0, 0.05, (n, 3))
    still, temp_degc = np.arange(n) % 500 < 250, np.linspace(0.0, 5.0, n)
    moments = np.array([10.0, 30.0, 50.0])
    found = []
    for later_dps in (0.0, 1.0):
        rate_dps[1250:] += later_dps
        rests = segments(rate_dps, temp_degc, still, hz, 0.05)
        found.append(believed(rests, moments, moments / 20, 1 / hz))
    np.testing.assert_array_equal(*found)


@pytest.fixture
def corrector():
    """One estimator with 2000 samples at 25 degC and a bias of 350 LSB, weighed for the line."""
    made = Corrector(document=True)
    s, c = made.state, made.settings
    first = c[SETTINGS.AXES] + c[SETTINGS.FIRST_SHORT]
    s[first : first + 4] = type(s)("i", [-3740, -3740 << 4, 350 << 8, 2000])
    fit.weigh(s, c, c[SETTINGS.AXES])
    return made


@pytest.mark.parametrize("before", [0, 1, -40])
@pytest.mark.parametrize("after", [-5000, -16, 16, 5000])
def test_a_line_through_a_point_that_moves_meanwhile_stays_at_its_bias(corrector, before, after):
    s, c = corrector.state, corrector.settings
    a = c[SETTINGS.AXES]
    mean_temp_q4 = a + c[SETTINGS.FIRST_SHORT] + ESTIMATOR.EST_MEAN_TEMP_Q4
    s[mean_temp_q4] += before
    fit.centre(s, c, a, 1)
    s[mean_temp_q4] += after
    fit.add_covariance(s, c, a, 1)
    fit.settle(s, c, a)
    for temp_q4 in (-3740 << 4, -3700 << 4):
        assert fit.line_q8(s, a, temp_q4) == 350 << 8
