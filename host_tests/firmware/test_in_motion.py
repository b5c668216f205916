"""The source in motion: what it learns, what it refuses, and its integers."""

from array import array
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from zerorate.gravity.gravity_settings import gravity_settings, gravity_state
from zerorate.motion import attitude, in_motion
from zerorate.motion.motion_settings import motion_settings, motion_state
from zerorate_tools.layout import MOTION, MOTION_REASON
from zerorate_tools.simulate import simulate

from . import motions

BIAS, SIGMA = MOTION.MOTION_BIAS_Q8, MOTION.MOTION_QUALITY_Q8
REASON, REFUSED = MOTION.MOTION_REASON, MOTION.REFUSED
HALF, Q = MOTION.HALF, MOTION.Q


class Learner(motions.Fed):
    """The source fed with recordings; learned: of each window."""

    def __init__(self, hz=50.0, **options):
        settings = motion_settings(odr_hz=hz, **options)
        super().__init__(in_motion.update, settings, motion_state(settings), BIAS, SIGMA)
        self.reasons = set()

    def after_each(self):
        self.reasons.add(self.state[REASON])


def test_a_device_that_never_rests_is_known_to_40_mdps_and_within_two_sigma():
    """Two minutes after it began; nine times of ten at least, from the first window."""
    inside = []
    for seed in range(5):
        motion = motions.swinging(seed, 150)
        learner = Learner().feed(motion)
        errors = learner.errors_mdps(motion.bias_dps, after_s=120)
        assert len(errors) >= 3 and np.sqrt((errors**2).mean()) < 40
        inside += [np.abs(b - motion.bias_dps) < 2 * s for _, b, s in learner.learned]
    assert len(inside) > 50
    assert np.mean(inside) >= 0.9


def warming(seed, seconds, degc, dps_per_degc):
    """A swing while the thermometer climbs by degc and the bias with it."""
    motion = motions.swinging(seed, seconds, bias_dps=[0.0, 0.0, 0.0])
    climb = np.linspace(0, degc, len(motion.samples))
    motion.bias_dps = climb[:, None] * np.asarray(dps_per_degc)
    motion.samples[:, 3] = np.round(climb * 340)
    motion.samples[:, 4:] += np.round(motion.bias_dps * motions.GYRO_LSB_PER_DPS).astype(int)
    return motion


def test_a_bias_that_follows_the_temperature_is_followed_without_a_lag():
    motion = warming(2, 300, degc=20.0, dps_per_degc=[0.03, -0.05, 0.04])

    def error_mdps(**options):
        learner = Learner(**options).feed(motion)
        late = [(t, b) for t, b, _ in learner.learned if t > 150]
        truth = [motion.bias_dps[round(t * motion.hz) - 1] for t, _ in late]
        return 1000 * np.abs(np.mean([b for _, b in late] - np.array(truth), axis=0))

    with_slope, without = error_mdps(), error_mdps(slope_dps_per_degc=1e-6)
    print("mean error with a slope", with_slope, "without", without, "mdps")
    assert with_slope.max() < 40 < without.max()


@pytest.mark.parametrize("seed", [0, 1])
def test_an_accelerometer_off_by_20_mg_hardly_passes_for_a_turning_part(seed):
    motion = motions.wandering(seed, 180)
    motion.samples[:, :3] += np.array([328, -328, 328])
    errors = Learner().feed(motion).errors_mdps(motion.bias_dps, after_s=150)
    print("rms error of each axis", np.sqrt(np.mean(errors**2, axis=0)), "mdps")
    assert np.sqrt(np.mean(errors**2)) < 60


def test_a_bias_of_eighteen_dps_is_learned():
    motion = motions.swinging(5, 150, bias_dps=[18.0, -15.0, 17.0])
    errors = Learner().feed(motion).errors_mdps(motion.bias_dps, after_s=120)
    assert len(errors) and np.abs(errors).max() < 100


@pytest.mark.parametrize(
    "motion",
    [
        motions.turning(60, 0.5, [0.0, 0.0, 1.0]),
        motions.turning(60, 0.0, [1.0, 0.0, 0.0]),
        motions.turning(60, 2.0, [0.0, 0.0, 1.0]),
        motions.turning(60, 2.0, [0.3, 0.0, 1.0]),
    ],
    ids=["a turntable", "a rest", "a slow turn of a car", "a steady turn about a leaning axis"],
)
def test_what_does_not_move_to_and_fro_teaches_nothing(motion):
    learner = Learner().feed(motion)
    assert learner.learned == []
    assert MOTION_REASON.HARDLY_MOVES in learner.reasons


@pytest.mark.parametrize(("scenario", "most_mdps"), [("slow-tilt", 40), ("trembling", 200)])
def test_slow_motion_that_tilts_teaches_all_three_axes(scenario, most_mdps):
    recording, truth = simulate(scenario, session=1, seed=4)
    n = round(100 * recording.scales.odr_hz)
    columns = [recording.columns[name][:n] for name in ("ax", "ay", "az", "temp", "gx", "gy", "gz")]
    bias_dps = truth.bias_lsb[n - 1] / recording.scales.gyro_lsb_per_dps
    learner = Learner(hz=recording.scales.odr_hz)
    learner.feed(SimpleNamespace(samples=np.stack(columns, axis=1), hz=recording.scales.odr_hz))
    assert np.abs(learner.errors_mdps(bias_dps)[-1]).max() < most_mdps


@pytest.mark.parametrize(("dps", "seconds"), [(3.0, 25), (12.0, 60)])
def test_less_than_a_twentieth_of_a_turn_that_stays_turned_is_learned(dps, seconds):
    turn = np.zeros((140 + seconds) * 50 + 1)
    turn[140 * 50 :] = dps
    motion = motions.swinging(1, 140 + seconds, turn_dps=turn)
    errors = Learner().feed(motion).errors_mdps(motion.bias_dps, after_s=140)
    assert len(errors) >= 3
    assert np.abs(errors).max() < 1000 * dps / 20


def test_a_bias_that_contradicts_what_is_known_is_refused_and_believed_when_it_lasts():
    before = motions.swinging(1, 140, bias_dps=[1.0, 2.0, 3.0])
    after = motions.swinging(1, 160, bias_dps=[5.0, -2.0, 3.0])
    learner = Learner().feed(before)
    assert np.abs(learner.errors_mdps(before.bias_dps)[-1]).max() < 60
    learner.feed(after)
    assert MOTION_REASON.TURNED in learner.reasons
    assert learner.state[REFUSED] > 0
    assert np.abs(learner.errors_mdps(after.bias_dps)[-1]).max() < 300


def test_a_turn_beyond_what_a_node_holds_is_refused():
    learner = Learner(gyro_lsb_per_dps=16.4).feed(motions.turning(40, 200.0, [1.0, 0.0, 0.0]))
    assert learner.learned == []
    assert MOTION_REASON.TOO_FAST in learner.reasons


@pytest.mark.parametrize("hz", [25.0, 50.0])
def test_a_window_in_three_passes_is_read_before_it_is_overwritten(hz):
    motion = motions.swinging(0, 90, hz=hz)
    learner = Learner(hz=hz, settled_dps=0.0).feed(motion)
    assert len(learner.learned) >= 8
    assert MOTION_REASON.LOST not in learner.reasons


def test_the_documents_own_form_finds_the_bias_of_a_swing_about_one_axis():
    t = np.arange(30 * 50 + 1) / 50
    swing = Rotation.from_rotvec(0.35 * np.sin(2 * np.pi * t)[:, None] * [1, 0, 0])
    motion = motions.Motion(swing, [2.0, 0.3, -0.3], 50.0, 0)
    learner = Learner(document=True).feed(motion)
    assert np.abs(learner.errors_mdps(motion.bias_dps)).max() < 250


def test_both_sources_take_less_than_four_kilobytes():
    k, c = motion_settings(), gravity_settings()
    words = len(k) + len(motion_state(k)) + len(c) + len(gravity_state(c))
    print("both sources:", 4 * words, "bytes")
    assert 4 * words <= 3820


@pytest.mark.parametrize("options", [{"longest_stage": 3}, {"passes": 0}, {"passes": 4}])
def test_settings_that_cannot_work_are_refused(options):
    with pytest.raises(ValueError, match="window"):
        motion_settings(**options)


def integrated_error_deg(steps):
    """Degrees between the kernel's quaternion and float64's after steps of half angles, Q14."""
    state = array("i", [0] * 60)
    state[Q] = 1 << 28
    truth = Rotation.identity()
    for half in steps:
        state[HALF : HALF + 3] = array("i", [int(h) for h in half])
        attitude.sines(state)
        attitude.turn(state)
        attitude.normalise(state)
        truth = truth * Rotation.from_rotvec(2 * np.asarray(half) / (1 << 14))
    w, x, y, z = state[Q : Q + 4]
    return np.degrees((truth.inv() * Rotation.from_quat([x, y, z, w])).magnitude())


@pytest.mark.parametrize(("most_rad", "limit_deg"), [(0.05, 0.01), (0.2, 0.04), (0.5, 0.15)])
def test_a_window_integrates_like_a_float64_quaternion(most_rad, limit_deg):
    errors = []
    for seed in range(20):
        random = np.random.default_rng(seed)
        steps = np.round(random.uniform(-most_rad, most_rad, (128, 3)) * (1 << 13))
        errors.append(integrated_error_deg(steps))
    print(f"128 increments within {most_rad} rad: worst {max(errors):.4f} deg")
    assert 0 < max(errors) < limit_deg
