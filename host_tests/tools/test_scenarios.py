"""The bundled scenarios are what the benches take them for."""

import numpy as np
import pytest
from zerorate_tools.simulate import (
    bundled_names,
    load_description,
    reference,
    simulate,
    simulate_sessions,
)
from zerorate_tools.simulate.channels import CHANNELS
from zerorate_tools.simulate.effects import EFFECTS
from zerorate_tools.simulate.motion import MOTIONS

from .test_simulate import AXES, OTHERS


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
    one_hertz.sensor.odr_hz = 1.0
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
