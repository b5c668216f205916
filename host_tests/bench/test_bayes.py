"""Bayes' rule is right about its own error where it is told how the truth was made."""

from dataclasses import replace

import numpy as np
import pytest
from zerorate_bench.bayes import believed, segments
from zerorate_bench.flicker import bayes_error, with_flicker
from zerorate_tools.simulate import simulate

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
