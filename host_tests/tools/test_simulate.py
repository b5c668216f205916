"""A simulated device does what its description says; the bundled scenarios are sound."""

import numpy as np
import pytest
from zerorate_tools.errors import BadDescription
from zerorate_tools.recordings import read_recording
from zerorate_tools.simulate import (
    bundled_names,
    load_description,
    read_truth,
    simulate,
    simulate_sessions,
    simulate_to_files,
)


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


def test_one_session_alone_is_the_same_as_among_all():
    noisy = device(1, 10.0, sensor={"gyro_noise_dps": 0.05}, sessions=2)
    every = list(simulate_sessions(noisy))
    alone, _ = simulate(noisy, session=2)
    np.testing.assert_array_equal(alone.columns["gy"], every[1][0].columns["gy"])


@pytest.mark.parametrize(
    ("more", "rms_dps"),
    [
        ({"sensor": {"gyro_noise_dps": 0.05, "gyro_noise_at_hz": 100.0, "odr_hz": 100.0}}, 0.05),
        ({"sensor": {"gyro_noise_dps": 0.05, "gyro_noise_at_hz": 100.0, "odr_hz": 1.0}}, 0.005),
        ({"sensor": {"gyro_noise_dps_rt_hz": 0.005, "odr_hz": 50.0}}, 0.025),
        ({"noise": {"coloured_dps": 0.1, "coloured_exponent": 2.0}}, 0.1),
        ({"noise": {"telegraph_dps": 0.1, "telegraph_mean_s": 20.0}}, 0.05),
    ],
)
def test_noise_has_the_given_rms(more, rms_dps):
    recording, _ = simulate(device(60, **more))
    assert recording.gyro_dps().std() == pytest.approx(rms_dps, rel=0.05)


def allan_deviation(values, m):
    """Plain two-sample deviation of neighbouring means of m."""
    means = values[: len(values) // m * m].reshape(-1, m, 3).mean(axis=1)
    return np.sqrt((np.diff(means, axis=0) ** 2).mean() / 2)


@pytest.mark.parametrize("m", [64, 1024])
def test_flicker_keeps_the_allan_deviation_flat_at_the_given_floor(m):
    _, truth = simulate(device(24 * 60, 2.0, noise={"bias_instability_dps": 0.01}))
    assert allan_deviation(truth.bias_lsb / 1000, m) == pytest.approx(0.01, rel=0.25)


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


def test_files_hold_the_recordings_and_the_truth_only_where_asked(tmp_path):
    sessions = device(1, sessions=2, bias={"b0": 0.5})
    files = simulate_to_files(sessions, tmp_path / "run.csv.gz", truth=tmp_path / "truth.parquet")
    assert [file.name for file in files] == ["run-1.csv.gz", "run-2.csv.gz"]
    truth = read_truth(tmp_path / "truth-2.parquet")
    assert (truth.bias_lsb == 500).all()
    assert len(truth.attitude) == len(read_recording(files[1]))
    simulate_to_files(sessions, tmp_path / "alone.parquet", session=2)
    assert sorted(p.name for p in tmp_path.glob("alone*")) == ["alone.parquet"]


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
        (
            device(every_session={"temperature": [{"to": 5, "s": 0}]}),
            "s is 0; write a number above 0",
        ),
        (device(sessions=2.5), "sessions is 2.5; write 1 or more"),
        (device(sessions=0), "sessions is 0"),
        (device(sessions=10001), "sessions is 10001"),
        (device(effect=[{"kind": "magic"}]), "effect 'magic' is unknown; choose of hysteresis"),
        (device(effect=[{"dps": 1.0}]), "effect None is unknown"),
        (device(effect=[{"kind": "drift", "rms_dps": 1, "session": 2}]), "drift does not show"),
        (device(effect=[{"kind": "kink", "at": 3}]), "effect kink"),
        (device(effect=[{"kind": "timing", "late_ms": 3}]), "effect timing.late_ms is unknown"),
        (
            device(effect=[{"kind": "supply", "dps": 1}]),
            "no channel 'vdd_mv'; add .channels.vdd_mv",
        ),
        (device(channels={"load": {"kind": "none"}}), "channel load"),
        (
            device(channels={"load": {"kind": "constant", "value": np.inf}}),
            "load: it is not one fi",
        ),
        (device(latitude_deg=10**400), "latitude_deg is 10"),
        (device(sensor={"odr_hz": 1e12}), "session 1 has over 100,000,000 samples"),
        *(
            (device(every_session={"motion": [{"kind": kind, "s": s} | how]}), told)
            for kind, s, how, told in (
                ("rest", [[], 2], {}, r"s is \[\[\], 2\]; write \[low, high\]"),
                ("hand", [3, 1], {}, r"s is \[3, 1\]; write \[low, high\]"),
                ("rest", [1, 2, 3], {}, "a motion has no duration"),
                ("turn", 2, {"deg": 9, "axis": [1]}, "motion turn: "),
                ("tilt", 2, {"hz": 1e308}, "motion tilt: "),
            )
        ),
        (
            device(effect=[{"kind": "linear-g", "matrix": [[np.inf] * 3] * 3, "dps": 1}]),
            "linear-g: w",
        ),
        ("nowhere", "no such file.*warm-up-a"),
    ],
)
def test_an_impossible_description_is_refused_in_one_line(description, complaint):
    with pytest.raises(BadDescription, match=complaint) as raised:
        simulate(description)
    assert "\n" not in str(raised.value)


def test_a_session_that_is_not_described_is_refused():
    with pytest.raises(BadDescription, match="no session 3; choose of 1 to 2"):
        simulate("warm-up-a", session=3)


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


UP_AND_DOWN = {
    "start_degc": 20.0,
    "temperature": [{"to": 50.0, "minutes": 30}, {"to": 20.0, "minutes": 30}],
}
SUPPLY = {"vdd_mv": {"kind": "square", "low": 3200.0, "high": 3300.0, "period_s": 600.0}}


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


def test_an_effect_of_wanted_size_has_it_over_all_sessions():
    effect = {"kind": "thermal-rate", "rms_dps": [0.01, 0.02, 0.03]}
    sized = device(60, 1.0, effect=[effect], every_session=UP_AND_DOWN, sessions=3)
    parts = [truth.bias_lsb - truth.bias_lsb.mean(axis=0) for _, truth in simulate_sessions(sized)]
    rms = np.sqrt((np.concatenate(parts) ** 2).mean(axis=0)) / 1000
    assert rms == pytest.approx([0.01, 0.02, 0.03], rel=0.02)
