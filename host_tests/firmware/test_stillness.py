"""What counts as a rest, and what explain() says where there is none."""

import numpy as np
import pytest
from zerorate import Corrector, Sensor
from zerorate_bench.peers import Decision
from zerorate_tools.layout import GRAVITY
from zerorate_tools.peers import firmware, given
from zerorate_tools.recordings import Recording, Scales

from .played import LEARNED_LSB, LSB, estimators, play, rest

BIAS_DPS = (0.4, -0.3, 0.2)
RESTS_ALONE = {"motion": False, "gravity": False}


def turning(rate_dps, seconds=60, axis=0, seed=1):
    """A device that turns at a constant rate about a level axis (0, 1) or the vertical (2)."""
    frames = rest(seconds, seed, BIAS_DPS)
    angle = np.radians(rate_dps) * np.arange(len(frames)) / 100
    frames[:, 4 + axis] += rate_dps * LSB
    if axis < 2:
        frames[:, 2] += 16384 * (np.cos(angle) - 1)
        frames[:, 1 - axis] += 16384 * np.sin(angle) * (1 if axis == 0 else -1)
    return frames


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("rate_dps", [-3, -0.5, 0.1, 1])
def test_a_slow_turn_about_a_level_axis_is_never_learned(rate_dps, axis):
    off_lsb = []  # of eight devices: gravity hides a chance segment of the slowest turns
    for device in range(8):
        corrector, _ = play(rest(20, 7 + device, BIAS_DPS))
        for seed in range(3 * device, 3 * device + 3):
            play(turning(rate_dps, 60, axis, seed), corrector)
            off_lsb.append(corrector.bias_lsb(axis) - BIAS_DPS[axis] * LSB)
    assert np.sqrt(np.mean(np.square(off_lsb))) < LEARNED_LSB


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("rate_dps", [-3, -0.5, 0.1, 1])
def test_a_slow_turn_from_power_on_is_learned_by_no_estimator(rate_dps, axis):
    corrector, _ = play(rest(0.01), **RESTS_ALONE)
    before = estimators(corrector)
    play(turning(rate_dps, 120, axis), corrector)
    assert estimators(corrector) == before


def handled(seconds, seed):
    """A hand's motion of some 60 dps about all axes."""
    frames = rest(seconds, seed, BIAS_DPS)
    t = np.arange(len(frames)) / 100
    for axis, hz in enumerate((0.7, 1.1, 0.9)):
        frames[:, 4 + axis] += 60 * LSB * np.sin(2 * np.pi * hz * t + seed + axis)
    return frames


def test_rests_of_a_second_between_motions_are_learned():
    parts = []
    for seed in range(12):
        parts += [handled(4, seed), rest(1.1, 50 + seed, BIAS_DPS)]
    corrector, _ = play(np.concatenate([*parts, handled(1, 99)]))
    for axis in range(3):
        assert corrector.bias_lsb(axis) == pytest.approx(BIAS_DPS[axis] * LSB, abs=LEARNED_LSB)


@pytest.mark.parametrize("hz", [5.0, 20.0])
def test_the_crest_of_a_slow_wave_is_no_first_rest_of_eight_readings(hz):
    frames = rest(60, 1, BIAS_DPS, odr_hz=hz)
    frames[:, 6] += 20 * LSB * np.sin(np.arange(len(frames)))
    frames[96:104, 6] = (BIAS_DPS[2] + 1) * LSB
    corrector, _ = play(frames, Corrector(Sensor(odr_hz=hz), **RESTS_ALONE))
    assert [corrector.source(axis) for axis in range(3)] == [0, 0, 0]


def test_eight_readings_at_rest_are_learned_where_they_agree_with_what_is_known():
    moving = handled(3, 1)[:24]
    known = np.concatenate([rest(4, 1, BIAS_DPS, odr_hz=10), moving])
    corrector, _ = play(known, Corrector(Sensor(odr_hz=10.0), **RESTS_ALONE))
    before = estimators(corrector)
    play(np.concatenate([rest(0.8, 2, BIAS_DPS, odr_hz=10), moving]), corrector)
    assert estimators(corrector) != before


def test_a_turn_about_the_vertical_is_learned_once_it_insists():
    corrector, _ = play(turning(0, 30, axis=2))
    assert corrector.bias_lsb(2) == pytest.approx(0.2 * LSB, abs=LEARNED_LSB)
    play(turning(1, 20, axis=2, seed=2), corrector)
    assert corrector.bias_lsb(2) == pytest.approx(0.2 * LSB, abs=LEARNED_LSB)
    assert "held back" in corrector.explain()
    play(turning(1, 120, axis=2, seed=3), corrector)
    assert corrector.bias_lsb(2) == pytest.approx(1.2 * LSB, abs=LEARNED_LSB)


# Numbers of a sensor hub's own tests: 400 Hz, a bias of 150 mdps, 70 mdps of noise.


def hub(seconds, seed=1):
    frames = rest(seconds, seed, (0.15, 0.15, 0.15), odr_hz=400)
    return frames, Corrector(Sensor(odr_hz=400.0))


def test_a_hub_is_calibrated_within_20_s_to_20_mdps():
    frames, corrector = hub(20)
    frames[:, 4:] += np.random.default_rng(9).normal(0, 0.05 * LSB, (len(frames), 3))
    play(frames, corrector)
    for axis in range(3):
        assert corrector.source(axis) > 0
        assert abs(corrector.bias_lsb(axis) / LSB - 0.15) < 0.020


@pytest.mark.parametrize("hz", [2.0, 2.1, 4.3])
def test_a_sinusoid_of_550_mdps_is_no_rest(hz):
    frames, _ = hub(20)
    corrector = Corrector(Sensor(odr_hz=400.0), motion=False)  # which may learn from it
    wave = 0.55 * LSB * np.sin(2 * np.pi * hz * np.arange(len(frames)) / 400)
    frames[:, 4:] += wave[:, None]
    play(frames[:1], corrector)
    before = estimators(corrector)
    play(frames[1:], corrector)
    assert estimators(corrector) == before
    assert "the gyroscope sees motion" in corrector.explain()


def test_shaking_that_only_the_accelerometer_sees_is_said():
    frames = rest(20)
    frames[:, 0] += np.random.default_rng(4).normal(0, 1500, len(frames))
    corrector, _ = play(frames)
    assert corrector.source(0) == 0
    assert "the accelerometer sees motion" in corrector.explain()


HZ = 50
LSB_PER_DPS = 131.0
LSB_PER_G = 16384
NOISE_DPS = 0.05
BIAS_DPS_TURNING = np.array([0.4, -0.7, 1.1])
SHAKEN = "shaken"


def recorded(*parts, warms_degc=0.0, load_g=1.0):
    """A recording, z up; a part is seconds and its rate, dps, or SHAKEN; the last bears a load."""
    rng = np.random.default_rng(1)
    rate, accel = [], []
    for seconds, what in parts:
        n = seconds * HZ
        shaken = 20.0 if what is SHAKEN else 0.0
        rate.append(np.zeros((n, 3)) + (0 if what is SHAKEN else what))
        rate[-1] += rng.standard_normal((n, 3)) * (NOISE_DPS + shaken)
        load = load_g if len(accel) == len(parts) - 1 else 1.0
        accel.append([0, 0, load] + rng.standard_normal((n, 3)) * (0.002 + shaken / 100))
    gyro = np.round((np.concatenate(rate) + BIAS_DPS_TURNING) * LSB_PER_DPS).astype(np.int64)
    force = np.round(np.concatenate(accel) * LSB_PER_G).astype(np.int64)
    n = len(gyro)
    noise = rng.standard_normal(n) * 6
    columns = {"t_us": np.arange(n) * (1_000_000 // HZ)}
    columns["temp"] = np.round(np.linspace(-3000, -3000 + 340 * warms_degc, n) + noise).astype(int)
    columns |= {f"g{axis}": gyro[:, i] for i, axis in enumerate("xyz")}
    columns |= {f"a{axis}": force[:, i] for i, axis in enumerate("xyz")}
    scales = Scales("MPU-6050", float(HZ), LSB_PER_DPS, LSB_PER_G, 340.0, 36.53)
    return given(Recording(columns, scales, "turns"))


def followed(*parts, **how):
    """Error and one sigma, dps, at the end of each second."""
    bias, sigma, _ = Decision().states(recorded(*parts, **how))
    return (bias - BIAS_DPS_TURNING)[HZ - 1 :: HZ], sigma[HZ - 1 :: HZ]


KNOWN = (100, 0.0)
ABOUT_Z = np.array([0.0, 0.0, 1.0])


@pytest.mark.parametrize("dps", [0.1, -0.25, 2.0, -8.0])
def test_a_known_bias_stands_through_ten_turns_of_half_a_minute(dps):
    turns = [part for _ in range(10) for part in ((30, dps * ABOUT_Z), (2, SHAKEN))]
    error, sigma = followed(KNOWN, (2, SHAKEN), *turns)
    assert np.abs(error[100:]).max() < 0.02
    assert sigma[110:, 2].max() > 0.5 * min(abs(dps), 7.0)  # it may have moved as well


def test_a_turn_that_begins_and_ends_slowly_is_followed_and_doubted():
    ship = [(1, 0.25 * np.sin(2 * np.pi * second / 400) * ABOUT_Z) for second in range(400)]
    error, sigma = followed(KNOWN, (2, SHAKEN), *ship)
    assert np.abs(error[:, 2]).max() > 0.05
    wrong = np.abs(error[:, 2]) > np.maximum(0.02, 3 * sigma[:, 2])
    assert not wrong.any()
    assert (np.abs(error[:, :2]) < 0.02).all()


JUMP_DPS = np.array([1.5, 0.0, 1.0])


def test_a_jump_is_no_slope_over_temperature():
    error, _ = followed(KNOWN, (2, SHAKEN), (120, JUMP_DPS), warms_degc=1.0)
    assert np.abs(error[-30:] - JUMP_DPS).max() < 0.02


@pytest.mark.parametrize("warms_degc", [0.0, 5.0])
def test_a_jump_outlasts_a_power_off(warms_degc):
    first = recorded(KNOWN, (2, SHAKEN), (120, JUMP_DPS), warms_degc=warms_degc)
    second = recorded((2, SHAKEN), (30, JUMP_DPS))
    bias = firmware()([first, second])[1]
    assert np.abs(bias[HZ] - BIAS_DPS_TURNING - JUMP_DPS)[[0, 2]].max() < 0.05


def test_a_bias_that_moves_across_gravity_is_no_turn():
    jump = np.array([0.5, 0.0, 0.6])
    error, _ = followed(KNOWN, (2, SHAKEN), (90, jump))
    assert np.abs(error[-1] - jump).max() < 0.02


def test_a_rest_of_ten_halvings_tells_at_last_that_it_is_no_turn():
    error, sigma = followed(KNOWN, (2, SHAKEN), (1150, 0.6 * ABOUT_Z))
    off = np.abs(error - 0.6 * ABOUT_Z)[102:, 2]
    assert off[900] > 0.5  # a turn may last so long
    assert off[-1] < 0.02
    assert np.mean(off[10:] < 2 * sigma[112:, 2]) == 1.0


def test_a_bank_that_more_than_1_g_tells_leans_the_axis_of_a_turn():
    load_g = 1.1  # a bank of 25 degrees: 3 dps at 85 m/s
    bank = np.arccos(1 / load_g)
    turn = 3.0 * np.array([np.sin(bank), 0.0, np.cos(bank)])
    error, _ = followed(KNOWN, (2, SHAKEN), (400, turn), load_g=load_g)
    assert np.abs(error[100:]).max() < 0.02


def test_what_is_hardly_known_is_given_up_as_before():
    error, _ = followed((20, 2.0 * ABOUT_Z), (2, SHAKEN), (90, 0.0))
    assert np.abs(error[-1]).max() < 0.02


def test_a_rest_that_agrees_ends_what_was_held_back():
    _, sigma = followed(KNOWN, (2, SHAKEN), (30, 2.0 * ABOUT_Z), (10, SHAKEN), (30, 0.0))
    assert sigma[130, 2] > 1.0
    assert sigma[-1, 2] == pytest.approx(sigma[100, 2], rel=0.05)


def stopped(known_s, lsb_per_dps, noise_dps, hz=50.0):
    """A Corrector behind a rest so long, then a minute of 2 dps that nothing changes."""
    frames = rest(known_s + 60, 4, odr_hz=hz)
    noise = np.random.default_rng(4).normal(0, noise_dps, (len(frames), 3))
    frames[:, 4:] = (0.3 + noise) * lsb_per_dps
    frames[round(known_s * hz) :, 4:] = 2.0 * lsb_per_dps
    return play(frames, Corrector(Sensor(hz, gyro_lsb_per_dps=lsb_per_dps)))[0]


@pytest.mark.parametrize("known_s, lsb_per_dps", [(0, 131.0), (30, 131.0), (30, 16.4)])
def test_a_gyroscope_without_noise_teaches_no_source(known_s, lsb_per_dps):
    corrector = stopped(known_s, lsb_per_dps, noise_dps=0.05)
    level = [corrector.bias_lsb(axis) / lsb_per_dps for axis in range(3)]
    assert level == pytest.approx([0.3 if known_s else 0.0] * 3, abs=0.03)
    assert "the gyroscope has no noise" in corrector.explain()
    assert corrector.gravity[GRAVITY.OBSERVED] <= 2 * known_s + 1


def test_a_part_too_coarse_to_show_its_noise_is_learned():
    corrector = stopped(0, 1.0, noise_dps=0.0)
    assert corrector.rests and corrector.bias_lsb(0) == pytest.approx(2.0, abs=0.1)
