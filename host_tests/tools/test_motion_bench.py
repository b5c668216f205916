"""The measurements of bias without rest: the truth of a trial, and what a source is worth."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from zerorate_bench.peers.sources import Source
from zerorate_tools.demo.broad import Trial, true_bias
from zerorate_tools.peers import given
from zerorate_tools.simulate import simulate

HZ = 100.0
BIAS_DPS = np.array([0.4, -0.3, 0.2])


@pytest.fixture(scope="module")
def trial():
    """Ten seconds of rest, forty of swinging, ten of rest, seen through frames 2 deg apart."""
    t = np.arange(int(60 * HZ)) / HZ
    moving = (t >= 10) & (t < 50)
    cycles = 2 * np.pi * (t - 10)[:, None] * [0.4, 0.55, 0.7]
    swing = np.where(moving[:, None], np.sin(cycles), 0) * [0.3, -0.2, 0.4]
    attitude = Rotation.from_rotvec(swing)
    rate = np.degrees((attitude[:-1].inv() * attitude[1:]).as_rotvec()) * HZ
    apart = Rotation.from_rotvec([0.02, -0.02, 0.03])
    random = np.random.default_rng(1)
    rate = apart.inv().apply(np.vstack([rate, [0, 0, 0]])) + BIAS_DPS
    force = (attitude * apart).inv().apply([0, 0, 1.0]) + random.normal(0, 0.004, (len(t), 3))
    quaternion = attitude.as_quat()[:, [3, 0, 1, 2]]
    quaternion[2000:2100] = np.nan
    return Trial("made", HZ, rate + random.normal(0, 0.05, rate.shape), force, quaternion, moving)


def test_the_true_bias_is_found_through_frames_that_are_not_aligned(trial):
    truth = true_bias(trial)
    assert np.abs(truth.bias_dps - BIAS_DPS).max() < 0.02
    assert np.abs(truth.motion_dps - BIAS_DPS).max() < 0.05
    assert (truth.sigma_dps < 0.01).all()


def test_the_motion_of_a_trial_begins_and_ends_moving(trial):
    part = trial.in_motion()
    assert part.moving[0] and part.moving[-1]
    assert len(part.rate_dps) == len(part.attitude) == 4000


def test_a_source_is_measured_from_nothing_with_its_honesty(trial):
    source = Source("in_motion")
    one = given(trial.in_motion().recording())
    source.truth_dps = [np.tile(BIAS_DPS, (len(one.rate_dps), 1))]
    bias = source([one])[0]
    assert not bias[0].any()
    assert np.abs(bias[-1] - BIAS_DPS).max() < 0.2
    assert source.learned > 0
    assert np.mean(source.within) >= 0.9


def test_strides_that_turn_as_steadily_as_a_bias_leave_tens_of_mdps():
    errors = []
    for seed in (11, 12, 14):
        recording, truth = simulate("never-rests", session=1, seed=seed)
        bias = Source("in_motion")([given(recording)])[0]
        error = bias - truth.bias_lsb / recording.scales.gyro_lsb_per_dps
        errors.append(1000 * np.sqrt(np.mean(error[12000:] ** 2)))
    print("RMS errors after two minutes", np.round(errors, 1), "mdps")
    assert max(errors) < 25


def test_an_accelerometer_that_strides_push_says_how_unsure_it_is():
    recording, truth = simulate("never-rests", session=1, seed=4)
    source = Source("gravity")
    source.truth_dps = [truth.bias_lsb / recording.scales.gyro_lsb_per_dps]
    source([given(recording)])
    assert len(source.within) > 500
    assert np.mean(source.within) >= 0.9
