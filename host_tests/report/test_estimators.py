"""The estimators shown are those of the firmware's state."""

import numpy as np
import pytest
from zerorate import Corrector, Sensor
from zerorate_tools.errors import ZerorateError
from zerorate_tools.layout import AXIS, ESTIMATOR, SETTINGS, axis_at
from zerorate_tools.recordings import open_recording, read_recording
from zerorate_tools.replay import replay
from zerorate_tools.report.estimators import moments


@pytest.fixture(scope="module")
def log(outcome):
    return outcome("an effect").logs[0]


@pytest.fixture(scope="module")
def seen(log):
    return moments([log], every_s=300.0)


def test_one_moment_every_five_minutes(log, seen):
    samples = len(read_recording(log))
    assert len(seen) == -(-samples // 300)
    assert np.diff([m.minute for m in seen])[:-1] == pytest.approx(5.0)


def test_the_last_moment_is_the_state_that_a_replay_ends_in(log, seen):
    state = np.frombuffer(replay(log).state, "<i4")
    scales = open_recording(log).scales
    settings = Corrector(
        Sensor(
            *(scales.odr_hz, scales.gyro_lsb_per_dps, scales.accel_lsb_per_g),
            *(scales.temp_lsb_per_degc, scales.temp_offset_degc),
        )
    ).settings
    for axis in range(3):
        first = axis_at(settings, axis) + AXIS.ESTIMATORS + ESTIMATOR.EST_BIAS_Q8
        biases = state[first :: settings[SETTINGS.ESTIMATOR_WORDS]] / 256 / scales.gyro_lsb_per_dps
        biases = biases[: settings[SETTINGS.ESTIMATOR_COUNT]]
        shown = [e.bias_dps for e in seen[-1].axes[axis]]
        assert shown[0] == pytest.approx(biases[0])
        assert set(np.round(shown, 9)) <= set(np.round(biases, 9))


def test_a_histogram_holds_its_bias_and_its_edges_rise(seen):
    for m in seen:
        for held in m.axes:
            for e in held:
                assert np.all(np.diff(e.edges_dps) > 0)
                assert e.edges_dps[0] <= e.bias_dps <= e.edges_dps[-1]
                bins = Corrector().settings[SETTINGS.BINS]
                assert len(e.readings) == len(e.edges_dps) - 1 == bins


def test_three_short_and_five_long_are_held_at_most_and_one_learns(seen):
    for held in seen[-1].axes:
        count = {kind: sum(e.kind == kind for e in held) for kind in ("any", "short", "long")}
        assert count["any"] == 1 and 1 <= count["short"] <= 3 and 1 <= count["long"] <= 5
        assert sum(e.in_use for e in held) == 1


def test_what_was_learned_outlasts_the_power_cut(outcome):
    logs = outcome("an effect").logs[:2]
    both = moments(logs, every_s=600.0)
    first = [m for m in both if m.recording == both[0].recording][-1]
    then = next(m for m in both if m.recording != first.recording)
    kept = {round(e.temp_degc) for e in then.axes[0] if e.kind == "long"}
    assert kept & {round(e.temp_degc) for e in first.axes[0] if e.kind == "long"}


def test_a_sensor_that_the_firmware_cannot_take_is_said(tmp_path, outcome):
    from dataclasses import replace as changed

    from zerorate_tools.recordings import write_recording

    whole = read_recording(outcome("nothing").logs[0])
    odd = changed(whole, scales=changed(whole.scales, gyro_lsb_per_dps=9000.0))
    write_recording(odd, tmp_path / "odd.parquet")
    with pytest.raises(ZerorateError, match="gyro_lsb_per_dps"):
        moments([tmp_path / "odd.parquet"])
