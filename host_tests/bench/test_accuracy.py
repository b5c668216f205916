"""Peers are given the same samples and find what they can."""

import numpy as np
import pytest
from zerorate_bench.accuracy import second_power_on
from zerorate_bench.peers import HOW, PEERS, ardupilot_cubic, px4_cubic
from zerorate_tools.peers import given
from zerorate_tools.simulate import simulate_sessions

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
