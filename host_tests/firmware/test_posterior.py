"""What the source in motion publishes where windows tell little: the posterior mean."""

from array import array

import numpy as np
import pytest
from zerorate import Corrector, Sensor
from zerorate.arithmetic import real
from zerorate.motion import least_squares, posterior
from zerorate.motion.motion_settings import motion_settings, motion_state
from zerorate.rest import step
from zerorate_tools.layout import MOTION, SOURCE, STATE

UNIT = 0.125 * (1 << 24) * np.pi / 180  # of a dps
LSB_Q8 = 131 * 256


def put(state, word, value):
    real.put(state, word, round(value * 1024), -10)


def published(bias_dps, sigma_dps, **options):
    """What is published of biases that windows alone leave with those sigmas, dps."""
    c = motion_settings(**options)
    s = array("i", motion_state(c))
    s[MOTION.MISFIT_Q16] = 0x4000
    for axis, word in enumerate((0, 6, 10)):
        put(s, MOTION.BIAS + 2 * axis, bias_dps[axis] * UNIT)
        put(s, MOTION.KNOWN_P + word, (sigma_dps[axis] * UNIT) ** 2)
    posterior.know_prior(s)
    for _ in range(6):
        posterior.weigh_prior(s, c)
        for pivot in range(3):
            least_squares.sweep(s, pivot)
        posterior.shrink(s, c)
    posterior.publish(s, c)
    words = np.array(s[MOTION.MOTION_BIAS_Q8 : MOTION.MOTION_QUALITY_Q8 + 3]) / LSB_Q8
    return words[:3], words[3:]


def test_a_bias_that_windows_hardly_tell_is_published_near_none():
    bias, sigma = published([0.8, 0.8, -0.8], [1.0, 0.02, 1.0])
    assert np.all(np.abs(bias[[0, 2]]) < 0.15)
    assert bias[1] == pytest.approx(0.8, abs=0.002)
    assert np.all(sigma < [0.6, 0.021, 0.6])


def test_a_part_at_20_dps_is_found_all_the_same():
    bias, sigma = published([20.0, -20.0, 5.0], [1.0, 0.1, 1.0])
    assert bias == pytest.approx([20.0, -20.0, 5.0], rel=0.1)
    assert sigma == pytest.approx([1.0, 0.1, 1.0], rel=0.05)


def test_a_steady_turn_leaves_a_hundredth_of_itself_in_one_sigma_however_many_windows_there_are():
    c = motion_settings()
    s = array("i", motion_state(c))
    put(s, MOTION.KNOWN_P, 1.0)
    s[MOTION.MISFIT_Q16] = 0x4000
    s[MOTION.TURN_MEAN] = round(30 * UNIT / 2048)  # 30 dps
    posterior.filter_variance(s, c, 0)
    real.root_of(s, MOTION.T1, MOTION.T1)
    assert real.whole(s, MOTION.T1, 0) / UNIT == pytest.approx(0.3, rel=0.02)


def test_a_source_that_knows_less_does_not_replace_the_bias_of_one_that_knows_more():
    corrector = Corrector(Sensor())
    s, c = corrector.state, corrector.settings
    for source, bias, sigma in ((SOURCE.IN_MOTION, 100, 3000), (SOURCE.GRAVITY, 900, 9000)):
        step.consider(s, c, array("i", [bias] * 3 + [sigma * 8] * 3), 0, source)
    assert list(s[STATE.TARGET_Q8 : STATE.TARGET_Q8 + 3]) == [100] * 3
    assert s[STATE.SOURCE] == SOURCE.IN_MOTION
