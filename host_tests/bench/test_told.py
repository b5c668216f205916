"""What is told everything is a floor: nobody else comes below it."""

import numpy as np
import pytest
from zerorate_bench.told import told_everything, told_the_future
from zerorate_tools.simulate import simulate_sessions

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
