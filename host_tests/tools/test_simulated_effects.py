"""A simulated effect adds what its description says, and no more."""

import numpy as np
import pytest
from zerorate_tools.errors import BadDescription
from zerorate_tools.simulate import simulate, simulate_sessions

from .test_simulate import device, moved

UP_AND_DOWN = {
    "start_degc": 20.0,
    "temperature": [{"to": 50.0, "minutes": 30}, {"to": 20.0, "minutes": 30}],
}
SUPPLY = {"vdd_mv": {"kind": "square", "low": 3200.0, "high": 3300.0, "period_s": 600.0}}
LOAD = {"load": {"kind": "levels", "low": 0.0, "high": 100.0, "mean_s": 200.0}}


def effect_dps(effect, minutes=60, odr_hz=1.0, **more):
    """What one effect adds, (n, 3) dps, and the truth it happened in."""
    recording, truth = simulate(device(minutes, odr_hz, effect=[effect], **more))
    return truth.bias_lsb / recording.scales.gyro_lsb_per_dps, truth


def seconds(truth):
    return np.arange(len(truth.temp_degc))


def low(truth):
    """Where the supply is at its low level."""
    return seconds(truth) % 600 >= 300


@pytest.mark.parametrize(
    ("effect", "expected"),
    [
        ({"kind": "kink", "knee_degc": 35.0}, lambda of: np.maximum(of.temp_degc - 35, 0)),
        ({"kind": "peak-temperature"}, lambda of: (seconds(of) > 1800) * (50 - of.temp_degc)),
        ({"kind": "thermal-rate"}, lambda of: np.gradient(of.temp_degc) * 60),
        ({"kind": "power-on", "tau_s": 300.0}, lambda of: np.exp(-seconds(of) / 300)),
        ({"kind": "drift"}, lambda of: seconds(of) / 3600),
        ({"kind": "step", "at_s": 1000.0}, lambda of: seconds(of) >= 1000),
        ({"kind": "step", "at_degc": 30.0}, lambda of: of.temp_degc > 30),
        ({"kind": "linear-g", "matrix": [[0, 0, -2], [0, 0, 0], [0, 0, 0]]}, lambda of: -2.0),
        ({"kind": "supply"}, lambda of: -0.1 * low(of)),
        ({"kind": "supply-temperature"}, lambda of: -0.1 * low(of) * (of.temp_degc - 25)),
    ],
)
def test_an_effect_adds_its_waveform(effect, expected):
    added, truth = effect_dps(
        {**effect, "dps": [0.1, 0, 0]}, every_session=UP_AND_DOWN, channels=SUPPLY
    )
    assert added[:, 0] == pytest.approx(0.1 * expected(truth), abs=1e-6)
    assert not added[:, 1:].any()


def test_hysteresis_parts_heating_from_cooling():
    hysteresis = {"kind": "hysteresis", "width_degc": 4.0, "dps": 0.1}
    added, truth = effect_dps(hysteresis, every_session=UP_AND_DOWN)
    at = np.abs(truth.temp_degc - 35) < 0.01
    heating, cooling = added[:1800, 0][at[:1800]], added[1800:, 0][at[1800:]]
    assert heating == pytest.approx(-0.1) and cooling == pytest.approx(0.1)


def test_a_thermometer_that_lags_reads_late():
    sensor = {"temp_lag_s": 60.0}
    recording, truth = simulate(device(60, 1.0, sensor=sensor, every_session=UP_AND_DOWN))
    late = truth.temp_degc - recording.temp_degc()
    assert late[1700] == pytest.approx(1.0, abs=0.01)
    assert late[3500] == pytest.approx(-1.0, abs=0.01)


def test_a_thermometer_that_moves_in_steps_reads_within_half_a_step():
    stepped = {"temp_step_lsb": 32.0}
    recording, truth = simulate(device(60, 1.0, sensor=stepped, every_session=UP_AND_DOWN))
    assert set(recording.columns["temp"] % 32) == {0}
    assert recording.temp_degc() == pytest.approx(truth.temp_degc, abs=16.5 / 340)


def test_scale_errors_are_in_the_reading_and_not_in_the_true_bias():
    motion = [{"kind": "swing", "s": 60, "dps": 100.0, "axis": "x"}]
    matrix = [[0.03, 0, 0], [0.01, 0, 0], [0, 0, 0]]
    scale = {"kind": "scale", "matrix": matrix, "dps": 1.0}
    recording, truth = simulate(device(1, 50.0, effect=[scale], **moved(motion)))
    assert (truth.bias_lsb == 0).all()
    rate = truth.rate_dps[:, 0]
    assert recording.gyro_dps()[:, :2] == pytest.approx(np.c_[1.03 * rate, 0.01 * rate], abs=0.004)


def test_a_delay_between_stamp_and_reading_shows_in_motion():
    motion = [{"kind": "swing", "s": 60, "dps": 100.0, "axis": "z", "hz": 0.5}]
    late = {"kind": "timing", "delay_ms": 20.0, "clock_ppm": 1000.0, "jitter_us": 100.0}
    recording, truth = simulate(device(1, 100.0, effect=[late], **moved(motion)))
    assert recording.gyro_dps()[2:, 2] == pytest.approx(truth.rate_dps[:-2, 2], abs=0.004)
    assert recording.columns["t_us"][-1] == pytest.approx(59.99e6 * 1.001, abs=500)
    assert (np.diff(recording.columns["t_us"]) >= 0).all()


def test_the_square_of_a_channel_arrives_late():
    late = {"kind": "channel", "source": "load", "span": 100.0, "power": 2, "delay_s": 150.0}
    recording, truth = simulate(device(60, 1.0, effect=[{**late, "dps": 0.1}], channels=LOAD))
    load = recording.columns["load"] / 100
    assert truth.bias_lsb[150:, 0] / 1000 == pytest.approx(0.1 * load[:-150] ** 2, abs=0.004)


def test_an_unrecorded_cause_leaves_no_column():
    hidden = {"draught": {"kind": "wander", "std": 1.0, "tau_s": 900.0, "recorded": False}}
    effect = {"kind": "channel", "source": "draught", "dps": 0.1}
    recording, truth = simulate(device(60, 1.0, effect=[effect], channels=hidden))
    assert "draught" not in recording.columns
    assert truth.bias_lsb.std() > 10


def test_an_effect_of_wanted_size_has_it_over_all_sessions():
    effect = {"kind": "thermal-rate", "rms_dps": [0.01, 0.02, 0.03]}
    sized = device(60, 1.0, effect=[effect], every_session=UP_AND_DOWN, sessions=3)
    parts = [truth.bias_lsb - truth.bias_lsb.mean(axis=0) for _, truth in simulate_sessions(sized)]
    rms = np.sqrt((np.concatenate(parts) ** 2).mean(axis=0)) / 1000
    assert rms == pytest.approx([0.01, 0.02, 0.03], rel=0.02)


def test_a_matrix_of_wanted_size_keeps_its_proportions():
    faces = [
        bout
        for face in ("+x", "-y", "-z")
        for bout in ({"kind": "pose", "s": 5, "face": face}, {"kind": "rest", "s": 15})
    ]
    matrix = [[1.0, 0, 0], [0, 0, 0], [0.5, 0, 0]]
    effect = {"kind": "linear-g", "matrix": matrix, "rms_dps": 0.01}
    _, truth = simulate(device(1, effect=[effect], every_session={"motion": faces}))
    bias_dps = truth.bias_lsb[truth.still] / 1000
    added = bias_dps - bias_dps.mean(axis=0)
    assert np.sqrt((added**2).mean()) == pytest.approx(0.01, rel=0.02)
    assert added[:, 2] == pytest.approx(added[:, 0] / 2)
    assert (added[:, 1] == 0).all()


def test_beyond_temperature_the_size_is_what_a_parabola_leaves():
    effect = {"kind": "kink", "rms_dps": 0.02, "beyond_temperature": True, "knee_degc": 35.0}
    _, truth = simulate(device(60, 1.0, effect=[effect], every_session=UP_AND_DOWN))
    warm = truth.temp_degc - 25
    basis = np.stack([np.ones_like(warm), warm, warm**2], axis=1)
    left = truth.bias_lsb - basis @ np.linalg.lstsq(basis, truth.bias_lsb, rcond=None)[0]
    assert np.sqrt((left**2).mean()) / 1000 == pytest.approx(0.02, rel=0.02)


def test_an_effect_that_cannot_show_cannot_be_sized():
    with pytest.raises(BadDescription, match="does not show"):
        simulate(device(effect=[{"kind": "thermal-rate", "rms_dps": 0.1}]))
