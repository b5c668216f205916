"""What the benches find of firmware and tools, and that a limit which is missed is said."""

import numpy as np
import pytest
from zerorate_bench import deceived
from zerorate_bench.accuracy import second_power_on
from zerorate_bench.cost_report import replay_speed
from zerorate_bench.deceived import WORLDS, judged, made
from zerorate_bench.heading_simulated import Case, outcome
from zerorate_bench.limits import COST, verdicts
from zerorate_bench.own_axes import one_device
from zerorate_bench.peers import PEERS, Source
from zerorate_tools.peers import given
from zerorate_tools.simulate import simulate

MOST_GROWTH = 1.2


def test_a_recording_ten_times_as_long_takes_no_more_memory():
    short, long = replay_speed((0.3, 3.0), runs=1).values()
    assert long["peak_bytes"] <= MOST_GROWTH * short["peak_bytes"]


@pytest.mark.parametrize("worse", [{}, {"heap_bytes_per_update": 0.1}])
def test_a_limit_of_cost_that_is_missed_is_said(worse):
    costs = {"instructions": 480.0, "instructions_c": 470.0, "cycles": 480.0, "cycles_worst": 12e3}
    ways = {"alone": costs, "bursts": costs}
    found = {
        "native": {"thumb": ways, "rv32": ways},
        "heap_bytes_per_update": 0.0,
        "replay_samples_per_s": 2_500_000.0,
        "replay_by_hours": {"1": {"peak_bytes": 300e6}, "100": {"peak_bytes": 330e6}},
    }
    missed = [one["figure"] for one in verdicts(found | worse, COST) if not one["met"]]
    assert len(missed) == len(worse)


def test_on_the_mild_part_the_order_is_zerorate_imufusion_ten_seconds():
    pytest.importorskip("imufusion")
    peers = {name: PEERS[name] for name in ("mean of the first 10 s", "imufusion", "zerorate")}
    found = second_power_on("warm-up-a", peers, seeds=(1,))
    errors = [found[name]["all"] for name in found]
    assert errors == sorted(errors, reverse=True)
    assert errors[-1] > 0


@pytest.mark.parametrize("name", ["in_motion", "gravity"])
def test_a_source_is_measured_from_nothing_with_its_honesty(name):
    recording, truth = simulate("never-rests", session=1, seed=4)
    source = Source(name)
    source.truth_dps = [truth.bias_lsb / recording.scales.gyro_lsb_per_dps]
    bias = source([given(recording)])[0]
    assert not bias[0].any()
    assert np.abs(bias[-1] - source.truth_dps[0][-1]).max() < 0.3
    assert source.learned > 100
    assert np.mean(source.within) >= 0.9


def test_strides_that_turn_as_steadily_as_a_bias_leave_tens_of_mdps():
    errors = []
    for seed in (11, 12, 14):
        recording, truth = simulate("never-rests", session=1, seed=seed)
        bias = Source("in_motion")([given(recording)])[0]
        error = bias - truth.bias_lsb / recording.scales.gyro_lsb_per_dps
        errors.append(1000 * np.sqrt(np.mean(error[12000:] ** 2)))
    assert max(errors) < 25


@pytest.mark.parametrize("number", [0, 2])
def test_a_robot_on_a_floor_whose_gyroscope_is_right_gets_no_matrix(number):
    assert not outcome(Case("robot", number, off=False))["found"]


def test_a_resting_device_is_never_sure_of_a_wrong_bias(monkeypatch):
    monkeypatch.setitem(WORLDS, "rest", lambda start: deceived.Bout(np.zeros((len(start.t_s), 3))))
    found = judged(made("rest", 1, True))
    assert found["sure_s"] == 0 and found["worst_mdps"] == 0 and found["honest"] > 0.8


def test_the_filters_own_entries_save_heading_in_the_hand_and_not_on_a_floor():
    hand, robot = (one_device(Case(kind, 0, True)) for kind in ("hand", "robot"))
    assert hand["left"] < 0.005 and hand["after"] < hand["before"] / 3
    assert robot["left"] > 0.005
