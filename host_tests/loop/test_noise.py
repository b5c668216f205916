"""Noise colours and the cross products under them."""

import numpy as np
import pytest
from zerorate_bench.loop.simulated import flicker, simulate
from zerorate_tools.allan import Noise, overlapping
from zerorate_tools.loop.read.lines import find, spectrum
from zerorate_tools.loop.search.select import Search


def test_the_deviation_of_fitted_noise_is_the_deviation_of_the_noise():
    rng = np.random.default_rng(3)
    rate = np.column_stack([flicker(rng, 8000, 1.0) for _ in range(8)])
    tau, deviation = overlapping(rate, 20.0)
    at = np.searchsorted(tau, 2000.0)
    expected = Noise(20.0, 0.0, 1.0, 0.0).deviation(tau[at : at + 1])
    assert np.sqrt((deviation[at] ** 2).mean()) == pytest.approx(expected[0], rel=0.1)


def test_a_drift_of_twice_the_floor_is_found_beside_a_walking_noise():
    found = Search(simulate(5000012, [("time-drift", 2.0)]).sessions[:-1]).run().found
    assert [f.candidate.kind for f in found] == ["time-drift"]


N, STEP_S = 3600, 1.0


def coloured(rng):
    walk = np.cumsum(rng.normal(0, 2e-4, (N, 3)), axis=0)
    pink = np.column_stack([flicker(rng, N, 1e-3) for _ in range(3)])
    return rng.normal(0, 3e-3, (N, 3)) + pink + walk


def lines(rates):
    spectra = [spectrum(r, STEP_S, 4096) for r in rates]
    return find(spectra[:-1], spectra[-1:], 2.0 * 4096 / N, 10 / N)


def test_coloured_noise_has_no_lines():
    for seed in range(20):
        rng = np.random.default_rng(seed)
        assert lines([coloured(rng) for _ in range(4)]) == []


@pytest.mark.parametrize("seed", [216, 372])
def test_the_humps_of_a_walk_in_one_short_recording_are_no_lines(seed):
    rng = np.random.default_rng(seed)
    rate = rng.normal(0, 1e-3, (880, 3)) + np.cumsum(rng.normal(0, 2e-4, (880, 3)), axis=0)
    assert find([spectrum(rate, STEP_S, 1024)], [], 2.0 * 1024 / 880, 10 / 880) == []


@pytest.mark.parametrize("period_s", [7.3, 60.0, 240.0])
def test_a_line_is_found_with_its_period_and_amplitude(period_s):
    rng = np.random.default_rng(1)
    t = np.arange(N) * STEP_S
    size = np.array([4e-3, 1e-3, 3e-3])
    rates = [
        coloured(rng) + np.outer(np.sin(2 * np.pi * t / period_s + rng.uniform(0, 6)), size)
        for _ in range(4)
    ]
    (line,) = lines(rates)
    assert 1 / line.hz == pytest.approx(period_s, rel=0.06) and line.in_holdout
    assert line.amplitude_dps[0] == pytest.approx(size[0], rel=0.3)
