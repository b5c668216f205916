"""A simulated device does what its description says, and tells the truth about it apart."""

import numpy as np
import pytest
from zerorate_tools.errors import BadDescription
from zerorate_tools.recordings import read_recording
from zerorate_tools.simulate import (
    bundled_names,
    load_description,
    read_truth,
    reference,
    simulate,
    simulate_sessions,
    simulate_to_files,
)
from zerorate_tools.simulate.channels import CHANNELS
from zerorate_tools.simulate.effects import EFFECTS
from zerorate_tools.simulate.motion import MOTIONS

AXES = ("gx", "gy", "gz")
OTHERS = ("ax", "ay", "az", "temp")


def device(minutes=10, odr_hz=20.0, **more):
    """A quiet device, at rest unless `more` says otherwise."""
    quiet = {"odr_hz": odr_hz, "gyro_noise_dps": 0.0, "accel_noise_g": 0.0, "temp_noise_degc": 0.0}
    given = {k: more.pop(k) for k in ("sensor", "every_session") if k in more}
    return {
        "sensor": {**quiet, "gyro_lsb_per_dps": 1000.0, **given.get("sensor", {})},
        "every_session": {"minutes": minutes, **given.get("every_session", {})},
        **more,
    }


def moved(motion):
    """A range of 250 dps, and this motion."""
    return {"sensor": {"gyro_lsb_per_dps": 131.0}, "every_session": {"motion": motion}}


def effect_dps(effect, minutes=60, odr_hz=1.0, **more):
    """What one effect adds, (n, 3) dps, and the truth it happened in."""
    recording, truth = simulate(device(minutes, odr_hz, effect=[effect], **more))
    return truth.bias_lsb / recording.scales.gyro_lsb_per_dps, truth


WARM_UP = {"start_degc": 20.0, "temperature": [{"to": 50.0, "minutes": 30}, {"minutes": 30}]}
UP_AND_DOWN = {
    "start_degc": 20.0,
    "temperature": [{"to": 50.0, "minutes": 30}, {"to": 20.0, "minutes": 30}],
}


# The same words give the same device


def test_the_same_seed_gives_the_same_recording_bit_for_bit():
    first, second, other = (simulate("car", seed=seed)[0] for seed in (3, 3, 4))
    assert all((first.columns[n] == second.columns[n]).all() for n in first.columns)
    assert (first.columns["gx"] != other.columns["gx"]).mean() > 0.5


def test_an_effect_disturbs_no_noise():
    noisy = {"sensor": {"gyro_noise_dps": 0.05}, "noise": {"random_walk_dps": 0.001}}
    without, _ = simulate(device(**noisy))
    moved, _ = simulate(device(**noisy, effect=[{"kind": "step", "at_s": 0.0, "dps": 1.0}]))
    assert set(moved.columns["gx"] - without.columns["gx"]) == {1000}


def test_one_session_alone_is_the_same_as_among_all():
    every = list(simulate_sessions("warm-up-c"))
    alone, _ = simulate("warm-up-c", session=2)
    np.testing.assert_array_equal(alone.columns["gy"], every[1][0].columns["gy"])


# Noise


def test_white_noise_has_the_given_rms_and_block_means_have_less_of_it():
    for odr_hz, expected in ((100.0, 0.05), (1.0, 0.005)):
        noisy = {"gyro_noise_dps": 0.05, "gyro_noise_at_hz": 100.0, "odr_hz": odr_hz}
        recording, _ = simulate(device(60, sensor=noisy))
        assert recording.gyro_dps().std() == pytest.approx(expected, rel=0.05)


def test_white_noise_by_its_density_follows_the_bandwidth():
    recording, _ = simulate(device(60, sensor={"gyro_noise_dps_rt_hz": 0.005, "odr_hz": 50.0}))
    assert recording.gyro_dps().std() == pytest.approx(0.005 * 5, rel=0.05)


def allan_deviation(values, m):
    """Plain two-sample deviation of neighbouring means of m."""
    means = values[: len(values) // m * m].reshape(-1, m, 3).mean(axis=1)
    return np.sqrt((np.diff(means, axis=0) ** 2).mean() / 2)


@pytest.mark.parametrize("m", [16, 64, 256, 1024])
def test_flicker_keeps_the_allan_deviation_flat_at_the_given_floor(m):
    _, truth = simulate(device(24 * 60, 2.0, noise={"bias_instability_dps": 0.01}))
    assert allan_deviation(truth.bias_lsb / 1000, m) == pytest.approx(0.01, rel=0.25)


def test_a_random_walk_starts_at_zero_and_spreads_with_the_root_of_time():
    ends = []
    for seed in range(60):
        _, truth = simulate(device(10, 1.0, noise={"random_walk_dps": 0.003}), seed=seed)
        assert (truth.bias_lsb[0] == 0).all()
        ends.append(truth.bias_lsb[-1] / 1000)
    assert np.std(ends) == pytest.approx(0.003 * np.sqrt(600), rel=0.2)


def test_telegraph_noise_has_two_levels():
    _, truth = simulate(device(noise={"telegraph_dps": 0.1, "telegraph_mean_s": 20.0}))
    assert sorted(set((truth.bias_lsb[:, 0] / 1000).round(6))) == [-0.05, 0.05]


def test_steeper_noise_has_the_given_rms():
    _, truth = simulate(device(noise={"coloured_dps": [0.1, 0.2, 0.3], "coloured_exponent": 2.0}))
    assert (truth.bias_lsb / 1000).std(axis=0) == pytest.approx([0.1, 0.2, 0.3], rel=1e-6)


def test_outliers_are_in_the_reading_and_not_in_the_truth():
    loud = {"outlier_dps": 5.0, "outlier_per_hour": 600.0}
    recording, truth = simulate(device(60, noise=loud))
    assert (truth.bias_lsb == 0).all()
    assert 400 < (recording.columns["gx"] != 0).sum() < 800


def test_a_louder_session_is_louder():
    sessions = [{"noise_scale": 1.0}, {"noise_scale": 3.0}]
    quiet, loud = simulate_sessions(device(sensor={"gyro_noise_dps": 0.05}, session=sessions))
    assert loud[0].gyro_dps().std() == pytest.approx(3 * quiet[0].gyro_dps().std(), rel=0.05)


# Motion and attitude


@pytest.mark.parametrize("kind", ["swing", "stride", "wave", "hand"])
def test_periodic_motion_returns_and_its_rates_integrate_to_the_attitude(kind):
    motion = [{"kind": "rest", "s": 5}, {"kind": kind, "s": 30, "dps": 60.0}]
    recording, truth = simulate(device(1, 100.0, **moved(motion)))
    moving = ~truth.still
    assert 20 < np.abs(truth.rate_dps[moving]).max() < 400
    assert np.abs(truth.rate_dps[moving].mean(axis=0)).max() < 0.5
    by_scipy = _integrated(truth.rate_dps, 0.01)
    assert np.abs(by_scipy - truth.attitude).max() < 1e-9
    assert recording.gyro_dps() == pytest.approx(truth.rate_dps, abs=0.004)


def _integrated(rate_dps, dt_s):
    """Attitude by one rotation after the other, with SciPy."""
    from scipy.spatial.transform import Rotation

    now, out = Rotation.identity(), []
    for turn in Rotation.from_rotvec(np.radians(rate_dps) * dt_s):
        now = now * turn
        out.append(now.as_quat(canonical=False)[[3, 0, 1, 2]])
    return np.array(out)


def test_at_rest_the_accelerometer_sees_one_g_up():
    for face, axis, sign in (("+z", 2, 1), ("-x", 0, -1), ("-z", 2, -1)):
        recording, _ = simulate(device(every_session={"face": face}))
        assert recording.accel_g().mean(axis=0)[axis] == pytest.approx(sign, abs=1e-3)


def test_gravity_follows_the_turntable_about_a_level_axis():
    recording, truth = simulate("turntable")
    last = recording.accel_g()[-200:].mean(axis=0)
    turned = np.radians(truth.rate_dps[:, 0].sum() / 100)
    assert np.degrees(turned) == pytest.approx(0.5 * 1800, rel=0.01)
    assert last[1:] == pytest.approx([np.sin(turned), np.cos(turned)], abs=0.02)


def test_the_car_turns_about_the_vertical_only_and_stays_turned():
    _, truth = simulate("car")
    assert np.abs(truth.rate_dps[:, :2]).max() < 1e-9
    assert np.abs(truth.rate_dps[:, 2]).max() > 1.0


def test_poses_put_each_face_up_in_turn():
    faces = ["+x", "-y", "-z", "+z"]
    motion = [
        b for f in faces for b in ({"kind": "pose", "s": 5, "face": f}, {"s": 15, "kind": "rest"})
    ]
    recording, _ = simulate(device(80 / 60, 50.0, every_session={"motion": motion}))
    seen = recording.accel_g()[950::1000]
    expected = [[1, 0, 0], [0, -1, 0], [0, 0, -1], [0, 0, 1]]
    assert seen == pytest.approx(np.array(expected, float), abs=1e-3)


def test_half_a_turn_of_heading_turns_the_share_of_earths_rate():
    motion = [
        {"kind": "rest", "s": 60},
        {"kind": "turn", "s": 10, "deg": 180.0, "axis": "vertical"},
    ]
    flat = device(2, every_session={"motion": motion}, latitude_deg=48.0)
    recording, truth = simulate(flat)
    earth = 360 / 86164.0905
    level, up = earth * np.cos(np.radians(48)), earth * np.sin(np.radians(48))
    assert truth.rate_dps[0] == pytest.approx([0, level, up])
    assert truth.rate_dps[-1] == pytest.approx([0, -level, up])
    assert recording.scales.more["latitude_deg"] == 48.0
    assert truth.still[:1000].all()


def test_vibration_shakes_the_accelerometer_at_any_rate_and_turns_nothing():
    for odr_hz in (1.0, 100.0):
        motion = [{"kind": "vibration", "s": 600, "g": 0.3}]
        recording, truth = simulate(device(10, odr_hz, every_session={"motion": motion}))
        assert recording.accel_g().std(axis=0) == pytest.approx([0.3] * 3, rel=0.15)
        assert truth.still.all()


# Bias and effects


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


# Outside any catalogue


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


# Effects of a wanted size


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


# The bundled scenarios


def test_all_bundled_scenarios_are_sound():
    assert set(bundled_names()) >= {"warm-up-a", "warm-up-b", "warm-up-c", "day", "never-rests"}
    for name in bundled_names():
        assert load_description(name).name == name


@pytest.mark.parametrize("letter", "abc")
def test_the_warm_up_is_that_of_the_comparison(letter):
    first, second = simulate_sessions(f"warm-up-{letter}")
    for (recording, truth), minutes, low, high in ((first, 40, 20, 45), (second, 20, 17, 44)):
        assert recording.duration_s == pytest.approx(minutes * 60, abs=1)
        assert truth.temp_degc[[0, -1]] == pytest.approx([low, high], abs=0.01)
        assert truth.still[:1500].all() and not truth.still[1500:5500].any()
        assert truth.still[5500:7500].all() and not truth.still[7500:11500].any()
        assert (np.abs(recording.columns["gx"]) < 32767).all()
        moving = truth.rate_dps[~truth.still]
        assert (moving.std(axis=0) > 60).all()
        noise = recording.gyro_dps() - truth.rate_dps - truth.bias_lsb / 131
        assert noise.std() == pytest.approx(0.05, rel=0.02)


def rms_mdps(error_dps):
    return 1000 * np.sqrt((error_dps**2).mean())


@pytest.mark.parametrize(("letter", "mean", "cubic"), [("a", 416, 7), ("b", 966, 15)])
def test_the_warm_up_leaves_others_what_they_measured_on_theirs(letter, mean, cubic):
    (first, known), (second, truth) = simulate_sessions(f"warm-up-{letter}")
    bias = truth.bias_lsb / 131
    ten_seconds = second.gyro_dps()[:1000].mean(axis=0)
    assert rms_mdps(bias - ten_seconds) == pytest.approx(mean, rel=0.02)
    warm, rate = first.temp_degc()[known.still] - 30, first.gyro_dps()[known.still]
    fits = [np.polyfit(warm, rate[:, axis], 3) for axis in range(3)]
    guess = np.stack([np.polyval(fit, second.temp_degc() - 30) for fit in fits], axis=1)
    assert rms_mdps(bias - guess) == pytest.approx(cubic, rel=0.12)


def test_the_warm_ups_differ_in_bias_walk_and_lag():
    a, b, c = (simulate(f"warm-up-{letter}") for letter in "abc")
    assert a[1].bias_lsb[0] / 131 == pytest.approx([0.655, -0.5025, 0.2525], abs=0.001)
    assert b[1].bias_lsb[-1] / 131 == pytest.approx([7.52, -5.74, 3.26], abs=0.001)
    walk = (c[1].bias_lsb - b[1].bias_lsb) / 131
    steps = np.diff(walk[::100], axis=0)
    assert steps.std() == pytest.approx(0.003, rel=0.05)
    assert (c[1].temp_degc - c[0].temp_degc())[-3000:].mean() == pytest.approx(0.254, abs=0.03)


def test_the_device_that_never_rests_never_rests():
    _, truth = simulate("never-rests")
    assert not truth.still.any()
    periodic = np.abs(truth.rate_dps).max(axis=1).reshape(-1, 200).max(axis=1) > 20
    assert periodic.mean() > 0.6
    assert np.abs(truth.bias_lsb / 131).max() == pytest.approx(6, abs=0.3)


def test_the_device_that_rests_for_30_percent_does():
    _, truth = simulate("rests-30")
    assert truth.still.mean() == pytest.approx(0.3, abs=0.05)


def test_the_day_moves_half_the_time_over_25_degc():
    one_hertz = load_description("day")
    one_hertz.sensor.odr_hz = 2.0
    recording, truth = simulate(one_hertz)
    assert recording.duration_s == pytest.approx(86400, abs=1)
    assert truth.still.mean() == pytest.approx(0.5, abs=0.05)
    assert np.ptp(truth.temp_degc) == pytest.approx(25, abs=0.5)


@pytest.mark.parametrize("name", ["hysteresis", "late-load", "unrecorded"])
def test_the_chamber_scenarios_differ_by_their_effect_alone(name):
    plain, truth = simulate("nothing", session=2)
    other, changed = simulate(name, session=2)
    added = (changed.bias_lsb - truth.bias_lsb) / 131
    assert 0.005 < added.std() < 0.05
    assert (other.columns["temp"] == plain.columns["temp"]).all()
    assert set(other.columns) == set(plain.columns) == {"t_us", *AXES, *OTHERS, "vdd_mv", "load"}
    assert np.abs((other.gyro_lsb() - plain.gyro_lsb()) / 131 - added).max() < 1.01 / 131


def test_the_reference_names_every_entry_that_is_taken():
    text = reference()
    for name in ("gyro_noise_at_hz = none", "turntable", "late", "peak-temperature", "delay_s=0.0"):
        assert name in text
    for kinds in (MOTIONS, CHANNELS, EFFECTS):
        assert set(kinds) <= {line.split()[0] for line in text.splitlines() if line.strip()}


# Files, and what is refused


def test_files_hold_the_recordings_and_the_truth_only_where_asked(tmp_path):
    sessions = device(1, sessions=2, bias={"b0": 0.5})
    files = simulate_to_files(sessions, tmp_path / "run.csv.gz", truth=tmp_path / "truth.parquet")
    assert [file.name for file in files] == ["run-1.csv.gz", "run-2.csv.gz"]
    truth = read_truth(tmp_path / "truth-2.parquet")
    assert (truth.bias_lsb == 500).all()
    assert len(truth.attitude) == len(read_recording(files[1]))
    simulate_to_files(sessions, tmp_path / "alone.parquet", session=2)
    assert sorted(p.name for p in tmp_path.glob("alone*")) == ["alone.parquet"]


def test_the_recording_says_nothing_of_the_effect():
    effect = {"kind": "kink", "knee_degc": 35.0, "dps": 0.01}
    recording, _ = simulate(device(effect=[effect]))
    assert set(recording.columns) == {"t_us", *AXES, *OTHERS}
    assert recording.scales.more == {}


def test_yaml_and_toml_describe_alike(tmp_path):
    (tmp_path / "d.toml").write_text("seed = 4\n[every_session]\nminutes = 1.0\n")
    (tmp_path / "d.yaml").write_text("seed: 4\nevery_session: {minutes: 1.0}\n")
    toml, yaml = (simulate(tmp_path / name)[0] for name in ("d.toml", "d.yaml"))
    np.testing.assert_array_equal(toml.columns["gx"], yaml.columns["gx"])


@pytest.mark.parametrize(
    ("description", "complaint"),
    [
        ({}, "session 1 has no duration; add minutes"),
        ({"sensors": {}}, "sensors is unknown; choose of name"),
        ({"sensor": {"odr": 1}}, "sensor.odr is unknown"),
        ({"sensor": {"odr_hz": "fast"}}, "sensor.odr_hz is 'fast'"),
        ({"bias": {"b0": [1, 2]}}, "bias.b0 is .1, 2.; write one number or .x, y, z."),
        (device(every_session={"motion": [{"kind": "fly", "s": 1}]}), "motion 'fly' is unknown"),
        (device(every_session={"motion": [{"kind": "rest"}]}), "a motion has no duration"),
        (device(every_session={"motion": [{"kind": "rest", "s": 1, "dps": 1}]}), "motion rest"),
        (device(every_session={"temperature": [{"to": 5}]}), "a temperature has no duration"),
        (device(effect=[{"kind": "magic"}]), "effect 'magic' is unknown; choose of hysteresis"),
        (device(effect=[{"dps": 1.0}]), "effect None is unknown"),
        (device(effect=[{"kind": "kink", "at": 3}]), "effect kink"),
        (device(effect=[{"kind": "timing", "late_ms": 3}]), "effect timing.late_ms is unknown"),
        (
            device(effect=[{"kind": "supply", "dps": 1}]),
            "no channel 'vdd_mv'; add .channels.vdd_mv",
        ),
        (device(channels={"load": {"kind": "none"}}), "channel load"),
        ("nowhere", "No such file.*warm-up-a"),
    ],
)
def test_an_impossible_description_is_refused_in_one_line(description, complaint):
    with pytest.raises(BadDescription, match=complaint) as raised:
        simulate(description)
    assert "\n" not in str(raised.value)


def test_a_session_that_is_not_described_is_refused():
    with pytest.raises(BadDescription, match="no session 3; choose of 1 to 2"):
        simulate("warm-up-a", session=3)


def test_several_files_take_their_places_together_or_not_at_all(tmp_path):
    def stopped(sessions):
        raise KeyboardInterrupt

    sessions, truth = device(1, sessions=2), tmp_path / "truth.parquet"
    with pytest.raises(KeyboardInterrupt):
        simulate_to_files(sessions, tmp_path / "run.csv", truth=truth, done=stopped)
    assert not list(tmp_path.iterdir())
