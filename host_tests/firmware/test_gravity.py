"""The source against gravity: what it finds, what it cannot see, and its integers."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from zerorate.gravity import gravity
from zerorate.gravity.gravity_settings import gravity_settings, gravity_state
from zerorate_tools.layout import GRAVITY, GRAVITY_REASON, GRAVITY_SETTINGS

from . import motions

OFFSET, SIGMA = GRAVITY.GRAVITY_BIAS_Q8, GRAVITY.GRAVITY_QUALITY_Q8
STEP, OBSERVED, SKIPPED = GRAVITY.STEP_Q8, GRAVITY.OBSERVED, GRAVITY.SKIPPED
REASON = GRAVITY.GRAVITY_REASON
LEANING = Rotation.from_rotvec([0.5, -0.6, 0.2])


class Counter(motions.Fed):
    """The source fed with recordings; learned: at the end of each interval."""

    def __init__(self, hz=50.0, **options):
        settings = gravity_settings(odr_hz=hz, **options)
        super().__init__(gravity.update, settings, gravity_state(settings), OFFSET, SIGMA)


def test_a_leaning_device_at_rest_is_known_to_50_mdps():
    motion = motions.turning(400, 0.0, [1, 0, 0], start=LEANING)
    counter = Counter().feed(motion)
    errors = counter.errors_mdps(motion.bias_dps, after_s=200)[:, :2]
    assert len(errors) > 20
    assert counter.state[OBSERVED + 2] == 0, "gravity is within 45 deg of z"
    assert np.sqrt((errors**2).mean()) < 50


def test_a_turntable_about_a_level_axis_is_not_taken_for_bias():
    motion = motions.turning(600, 0.5, [1, 0, 0], bias_dps=(0.0, 0.0, 0.0))
    counter = Counter().feed(motion)
    x = counter.errors_mdps(motion.bias_dps, after_s=100)[:, 0]
    assert counter.state[OBSERVED] > 1000
    assert np.abs(x).max() < 150, "the turn is 500"


def test_an_axis_along_gravity_is_not_observed_and_its_offset_stays():
    motion = motions.turning(60, 0.0, [1, 0, 0])
    counter = Counter().feed(motion)
    observed = counter.state[OBSERVED : OBSERVED + 3]
    assert observed[0] > 100 and observed[1] > 100
    assert observed[2] == 0
    assert counter.state[OFFSET + 2] == 0


def test_sub_units_without_one_g_are_not_counted():
    motion = motions.turning(20, 0.0, [1, 0, 0])
    motion.samples[:, :3] = motion.samples[:, :3] * 13 // 10
    counter = Counter().feed(motion)
    assert counter.state[SKIPPED] >= 39
    assert list(counter.state[OBSERVED : OBSERVED + 3]) == [0, 0, 0]
    assert counter.state[REASON] == GRAVITY_REASON.NOT_ONE_G


def test_the_documents_own_form_moves_by_one_step_an_interval():
    motion = motions.turning(60, 0.0, [1, 0, 0], start=LEANING)
    counter = Counter(document=True, coarse_dps=0.05, threshold=0).feed(motion)
    offsets = np.array([offset for _, offset, _ in counter.learned])
    steps = np.abs(np.diff(offsets, axis=0))
    assert len(offsets) == 30, "of eight quarters of a second each"
    assert set(np.round(steps.ravel() * 131 * 256)) <= {0, int(0.05 * 131 * 256)}


def test_steps_grow_while_all_signs_agree_and_shrink_when_they_turn():
    motion = motions.turning(400, 0.0, [1, 0, 0], start=LEANING, bias_dps=(8.0, 0.0, 0.0))
    counter = Counter()
    steps = []
    for part in np.array_split(motion.samples, 100):
        motion.samples = part
        steps.append(counter.feed(motion).state[STEP])
    assert max(steps) == 8 * counter.settings[GRAVITY_SETTINGS.COARSE_Q8]
    assert steps[-1] < counter.settings[GRAVITY_SETTINGS.COARSE_Q8]


def test_the_truth_lies_within_two_sigma_at_least_ninety_times_of_a_hundred():
    inside = []
    for seed in range(6):
        motion = motions.turning(200, 0.0, [1, 0, 0], start=motions.pose(seed), seed=seed)
        counter = Counter().feed(motion)
        for _, offset, sigma in counter.learned:
            known = sigma < 1000
            inside += list((np.abs(offset - motion.bias_dps) < 2 * sigma)[known])
    assert len(inside) > 100
    assert np.mean(inside) >= 0.9


@pytest.mark.parametrize("options", [{}, {"document": True}])
def test_a_sub_unit_has_two_samples_at_least(options):
    assert gravity_settings(odr_hz=4.0, **options)
    with pytest.raises(ValueError, match="4 Hz or more, not 3.9"):
        gravity_settings(odr_hz=3.9, **options)


@pytest.mark.parametrize("dt_us", [0, -1, 10_000_000])
def test_a_gap_begins_the_sub_unit_anew_and_ends_no_interval(dt_us):
    settings = gravity_settings()
    state = gravity_state(settings)
    frame = [0, 0, 16384, 0, 9, 9, 9]
    assert gravity.update(state, settings, frame, 10_000) == 0 < state[GRAVITY.UNIT_N]
    assert gravity.update(state, settings, frame, dt_us) == 0
    assert state[GRAVITY.UNIT_N] == state[GRAVITY.UNIT_ELAPSED_US] == 0
    assert state[REASON] == GRAVITY_REASON.GRAVITY_GAP


def test_a_threshold_that_no_interval_can_pass_is_refused():
    with pytest.raises(ValueError, match="threshold must be below the sub-units"):
        gravity_settings(threshold=8)


def test_a_coarse_gyroscope_at_a_low_rate_is_refused():
    with pytest.raises(ValueError, match="needs 12.1"):
        gravity_settings(odr_hz=4.0, gyro_lsb_per_dps=1.0)  # 2^30.2 in a sample at the rail
