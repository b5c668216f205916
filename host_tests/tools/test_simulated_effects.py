"""A simulated effect adds what its description says, and no more."""

import numpy as np
import pytest
from zerorate_tools.errors import BadDescription
from zerorate_tools.simulate import simulate, simulate_sessions

from .test_simulate import device, moved


def effect_dps(effect, minutes=60, odr_hz=1.0, **more):
    """What one effect adds, (n, 3) dps, and the truth it happened in."""
    recording, truth = simulate(device(minutes, odr_hz, effect=[effect], **more))
    return truth.bias_lsb / recording.scales.gyro_lsb_per_dps, truth


WARM_UP = {"start_degc": 20.0, "temperature": [{"to": 50.0, "minutes": 30}, {"minutes": 30}]}
UP_AND_DOWN = {
    "start_degc": 20.0,
    "temperature": [{"to": 50.0, "minutes": 30}, {"to": 20.0, "minutes": 30}],
}


def test_the_bias_is_the_given_polynomial_about_25_degc():
    bias = {"b0": [1, 2, 3], "b1": 0.1, "b2": 0.01, "b3": [0, 0, 0.001]}
    _, truth = simulate(device(60, 1.0, bias=bias, every_session=WARM_UP))
    warm = truth.temp_degc - 25
    expected = 3 + 0.1 * warm + 0.01 * warm**2 + 0.001 * warm**3
    assert truth.bias_lsb[:, 2] == pytest.approx(1000 * expected)


def test_each_power_on_has_an_offset_of_its_own():
    made = simulate_sessions(device(1, bias={"turn_on_dps": 0.02}, sessions=200))
    offsets = np.array([truth.bias_lsb[0] for _, truth in made]) / 1000
    assert offsets.std(axis=0) == pytest.approx([0.02] * 3, rel=0.2)


def test_hysteresis_parts_heating_from_cooling():
    hysteresis = {"kind": "hysteresis", "width_degc": 4.0, "dps": 0.1}
    added, truth = effect_dps(hysteresis, every_session=UP_AND_DOWN)
    at = np.abs(truth.temp_degc - 35) < 0.01
    heating, cooling = added[:1800, 0][at[:1800]], added[1800:, 0][at[1800:]]
    assert heating == pytest.approx(-0.1) and cooling == pytest.approx(0.1)


def test_thermal_rate_follows_the_slope_alone():
    added, _ = effect_dps({"kind": "thermal-rate", "dps": 0.1}, every_session=WARM_UP)
    assert added[900, 0] == pytest.approx(0.1)
    assert added[3000, 0] == pytest.approx(0.0)


def test_a_sensor_lag_decays_after_the_ramp():
    added, _ = effect_dps({"kind": "sensor-lag", "tau_s": 120.0, "dps": 1}, every_session=WARM_UP)
    assert added[1790, 0] == pytest.approx(-120 / 60, rel=0.01)
    assert added[1800 + 120, 0] == pytest.approx(-2 / np.e, rel=0.02)


def test_a_thermometer_that_lags_reads_late():
    recording, truth = simulate(device(60, 1.0, sensor={"temp_lag_s": 60.0}, every_session=WARM_UP))
    late = truth.temp_degc - recording.temp_degc()
    assert late[1700] == pytest.approx(1.0, abs=0.02)


def test_a_thermometer_that_moves_in_steps():
    stepped = {"temp_step_lsb": 32.0}
    recording, truth = simulate(device(60, 1.0, sensor=stepped, every_session=WARM_UP))
    assert set(recording.columns["temp"] % 32) == {0}
    assert recording.temp_degc() == pytest.approx(truth.temp_degc, abs=16.5 / 340)


def test_a_power_on_transient_restarts_at_each_power_on():
    effect = {"kind": "power-on", "tau_s": 300.0, "dps": 0.2}
    for _, truth in simulate_sessions(device(20, 1.0, effect=[effect], sessions=2)):
        assert truth.bias_lsb[[0, 300], 0] == pytest.approx([200, 200 / np.e])


def test_a_kink_begins_at_its_knee():
    kink = {"kind": "kink", "knee_degc": 35.0, "dps": 0.01}
    added, truth = effect_dps(kink, every_session=WARM_UP)
    assert added[truth.temp_degc < 35].max() == 0
    assert added[-1, 0] == pytest.approx(0.15)


def test_the_highest_temperature_is_remembered():
    added, truth = effect_dps({"kind": "peak-temperature", "dps": 0.01}, every_session=UP_AND_DOWN)
    assert added[:1700].max() == pytest.approx(0)
    assert added[-1, 0] == pytest.approx(0.01 * (50 - truth.temp_degc[-1]))


def test_linear_g_and_squared_g_follow_the_face_that_is_up():
    matrix = [[0.1, 0, 0], [0, 0.1, 0], [0.02, 0, 0.1]]
    linear = {"kind": "linear-g", "matrix": matrix, "dps": 1}
    for face, expected in (("-x", [-0.1, 0, -0.02]), ("+z", [0, 0, 0.1])):
        added, _ = effect_dps(linear, every_session={"face": face})
        assert added[0] == pytest.approx(expected)
    added, _ = effect_dps({"kind": "squared-g", "dps": 0.1}, every_session={"face": "-x"})
    assert added[0] == pytest.approx([0.1, 0, 0])


def test_vibration_is_rectified():
    motion = [{"kind": "rest", "s": 60}, {"kind": "vibration", "s": 60, "g": 0.5}]
    rectified = {"kind": "vibration", "dps": 0.1}
    added, _ = effect_dps(rectified, 2, 100.0, every_session={"motion": motion})
    assert added[3000, 0] == pytest.approx(0, abs=1e-6)
    assert added[8000:11000, 0].mean() == pytest.approx(0.1 * 3 * 0.25, rel=0.05)


SUPPLY = {"vdd_mv": {"kind": "square", "low": 3200.0, "high": 3300.0, "period_s": 600.0}}


def test_supply_and_its_product_with_temperature():
    warm = {"start_degc": 35.0}
    added, _ = effect_dps({"kind": "supply", "dps": 2.0}, channels=SUPPLY)
    assert sorted(set(added[:, 0].round(6))) == [-0.2, 0.0]
    product = {"kind": "supply-temperature", "dps": 2.0}
    added, _ = effect_dps(product, channels=SUPPLY, every_session=warm)
    assert sorted(set(added[:, 0].round(6))) == [-2.0, 0.0]


def test_scale_errors_are_in_the_reading_and_not_in_the_true_bias():
    motion = [{"kind": "swing", "s": 60, "dps": 100.0, "axis": "x"}]
    matrix = [[0.03, 0, 0], [0.01, 0, 0], [0, 0, 0]]
    scale = {"kind": "scale", "matrix": matrix, "dps": 1.0}
    recording, truth = simulate(device(1, 50.0, effect=[scale], **moved(motion)))
    assert (truth.bias_lsb == 0).all()
    rate = truth.rate_dps[:, 0]
    assert recording.gyro_dps()[:, :2] == pytest.approx(np.c_[1.03 * rate, 0.01 * rate], abs=0.004)


def test_steps_lines_and_drift():
    added, _ = effect_dps({"kind": "step", "at_s": 1000.0, "dps": 0.3})
    assert added[[999, 1000], 0].tolist() == [0, pytest.approx(0.3)]
    added, truth = effect_dps({"kind": "step", "at_degc": 30.0, "dps": 1}, every_session=WARM_UP)
    assert ((added[:, 0] > 0) == (truth.temp_degc > 30)).all()
    added, _ = effect_dps({"kind": "drift", "dps": 0.3})
    assert added[1800, 0] == pytest.approx(0.15)
    added, _ = effect_dps({"kind": "periodic", "hz": 0.01, "dps": 0.1})
    assert np.abs(np.fft.rfft(added[:, 0])).argmax() == 36


def test_a_delay_between_stamp_and_reading_shows_in_motion():
    motion = [{"kind": "swing", "s": 60, "dps": 100.0, "axis": "z", "hz": 0.5}]
    late = {"kind": "timing", "delay_ms": 20.0, "clock_ppm": 1000.0, "jitter_us": 100.0}
    recording, truth = simulate(device(1, 100.0, effect=[late], **moved(motion)))
    assert recording.gyro_dps()[2:, 2] == pytest.approx(truth.rate_dps[:-2, 2], abs=0.004)
    assert recording.columns["t_us"][-1] == pytest.approx(59.99e6 * 1.001, abs=500)
    assert (np.diff(recording.columns["t_us"]) >= 0).all()


POSE = {"kind": "pose", "s": 5}
LOAD = {"load": {"kind": "levels", "low": 0.0, "high": 100.0, "mean_s": 200.0}}


def test_the_square_of_a_channel_arrives_late():
    late = {"kind": "channel", "source": "load", "span": 100.0, "power": 2, "delay_s": 150.0}
    recording, truth = simulate(device(60, 1.0, effect=[{**late, "dps": 0.1}], channels=LOAD))
    load = recording.columns["load"] / 100
    assert truth.bias_lsb[150:, 0] / 1000 == pytest.approx(0.1 * load[:-150] ** 2, abs=0.004)


def test_a_product_a_knee_a_lag_and_a_rate_of_channels():
    product = {"kind": "channel", "source": "load", "times": "temp", "times_centre": 25.0, "dps": 1}
    added, truth = effect_dps(product, channels=LOAD, every_session=WARM_UP)
    assert np.corrcoef(added[:, 0], truth.temp_degc - 25)[0, 1] > 0.3
    knee = {"kind": "channel", "source": "load", "knee": 60.0, "dps": 0.01}
    added, _ = effect_dps(knee, channels=LOAD)
    assert added.min() == 0
    assert 0 < added.max() <= 0.4
    lag = {"kind": "channel", "source": "temp", "lag_s": 60.0, "rate": True, "dps": 0.1}
    added, _ = effect_dps(lag, every_session=WARM_UP)
    assert added[1700, 0] == pytest.approx(0.1, rel=0.01)


def test_an_unrecorded_cause_leaves_no_column():
    hidden = {"draught": {"kind": "wander", "std": 1.0, "tau_s": 900.0, "recorded": False}}
    effect = {"kind": "channel", "source": "draught", "dps": 0.1}
    recording, truth = simulate(device(60, 1.0, effect=[effect], channels=hidden))
    assert "draught" not in recording.columns
    assert truth.bias_lsb.std() > 10


def test_a_channel_is_counted_in_its_unit_and_a_copy_is_a_copy():
    channels = {
        "volt": {"kind": "constant", "value": 3.3, "lsb": 0.001},
        "volt_again": {"kind": "copy", "of": "volt", "lsb": 0.001},
    }
    recording, _ = simulate(device(1, channels=channels))
    assert set(recording.columns["volt"]) == set(recording.columns["volt_again"]) == {3300}


def test_an_effect_of_wanted_size_has_it_over_all_sessions():
    effect = {"kind": "thermal-rate", "rms_dps": [0.01, 0.02, 0.03]}
    sized = device(60, 1.0, effect=[effect], every_session=UP_AND_DOWN, sessions=3)
    parts = [truth.bias_lsb - truth.bias_lsb.mean(axis=0) for _, truth in simulate_sessions(sized)]
    rms = np.sqrt((np.concatenate(parts) ** 2).mean(axis=0)) / 1000
    assert rms == pytest.approx([0.01, 0.02, 0.03], rel=0.02)


def test_a_matrix_of_wanted_size_keeps_its_proportions():
    faces = [b for f in ("+x", "-y", "-z") for b in (POSE | {"face": f}, {"kind": "rest", "s": 15})]
    matrix = [[1.0, 0, 0], [0, 0, 0], [0.5, 0, 0]]
    effect = {"kind": "linear-g", "matrix": matrix, "rms_dps": 0.01}
    turned = {"minutes": 1, "effect": [effect], "every_session": {"motion": faces}}
    _, truth = simulate(device(**turned))
    added = (truth.bias_lsb / 1000 - truth.bias_lsb[truth.still].mean(axis=0) / 1000)[truth.still]
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
