"""What the documents say, read again in float64, beside what the firmware does by their letter."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from zerorate import Corrector, Sensor
from zerorate.gravity import gravity
from zerorate.rest import bias, fit
from zerorate.settings import DEFAULTS, LEAST, settings
from zerorate_tools.layout import (
    AXIS,
    ESTIMATOR,
    GRAVITY,
    GRAVITY_SETTINGS,
    SETTINGS,
    STATE,
    axis_at,
)

from . import motions
from .played import play, rest

HZ, LSB = 100, 131.0
QUICK = {"promote_s": 0.5, "fit_s": 0.3, "stable_s": 0.5}


def fed(corrector, bias_dps, temp_lsb):
    """The corrector behind a device at rest, lying flat: a temperature and (3,) bias a sample."""
    frames = rest(len(temp_lsb) / HZ)
    frames[:, 3] += temp_lsb
    frames[:, 4:] += np.asarray(bias_dps) * LSB
    return play(frames, corrector)[0]


def warmed(**options):
    """The corrector behind a warm-up of ten degrees, its bias on a parabola."""
    degrees = np.linspace(0, 10, 9000)
    slope, bend = np.array([0.05, -0.03, 0.0]), np.array([0.004, 0.0, -0.006])
    truth = [0.2, -0.1, 0.7] + np.outer(degrees, slope) + np.outer(degrees**2, bend)
    return fed(Corrector(**options), truth, -3000 + 340 * degrees)


def words_of(state, e, *names):
    return [state[e + getattr(ESTIMATOR, name)] for name in names]


def estimators(corrector, axis):
    """(temperature, bias, readings) of an axis' estimators that have readings, LSB."""
    c, s = corrector.settings, corrector.state
    a = axis_at(c, axis)
    found = []
    for e in range(
        a + c[SETTINGS.FIRST_SHORT], a + c[SETTINGS.ESTIMATORS_END], c[SETTINGS.ESTIMATOR_WORDS]
    ):
        temp_q4, bias_q8, n = words_of(s, e, "EST_MEAN_TEMP_Q4", "EST_BIAS_Q8", "EST_READINGS")
        if n >= c[SETTINGS.ENOUGH_TO_FIT]:
            found.append((temp_q4 / 16, bias_q8 / 256, n))
    return np.array(found)


@pytest.mark.parametrize("every", [True, False])
def test_a_least_squares_fit_models_the_relationship_of_bias_and_temperature(every):
    """US 9,354,080: "a least squares fit may be performed ... to model the relationship"."""
    corrector = warmed(document=True, every=every, **QUICK)
    s, c = corrector.state, corrector.settings
    for axis in range(3):
        temp, level, readings = estimators(corrector, axis).T
        assert len(temp) >= 5
        middle = temp.mean()
        plain = np.polyfit(temp - middle, level, 2, w=np.sqrt(readings))
        a = axis_at(c, axis)
        fit.draw_line(s, c, a)
        fit.bend(s, c, a)
        for at in np.linspace(temp.min(), temp.max(), 9):
            found = (fit.line_q8(s, a, round(at * 16)) + fit.bent_q8(s, a, round(at * 16))) / 256
            assert found == pytest.approx(np.polyval(plain, at - middle), abs=0.5)


@pytest.mark.parametrize("every", [True, False])
@pytest.mark.parametrize("gravity", [False, True])
def test_a_stable_estimator_of_this_temperature_speaks_alone(every, gravity):
    """No offset of this project's own is added to it, whoever else has found a bias."""
    corrector = warmed(document=True, every=every, gravity=gravity, **QUICK)
    corrector = fed(corrector, [[0.9, -0.1, 0.3]] * 1500, [400] * 1500)
    s, c = corrector.state, corrector.settings
    for axis in range(3):
        a = axis_at(c, axis)
        assert s[a + AXIS.OFFSET_Q8] == 0
        assert s[STATE.SOURCE + axis] == bias.HERE
        spoken = bias.curve_q8(s, c, a, s[STATE.TEMP])
        assert abs(s[STATE.TARGET_Q8 + axis] - spoken) < 26, "less than a reading since"


def test_what_gravity_cannot_see_costs_the_document_no_bias_that_it_has():
    corrector = fed(
        Corrector(document=True, gravity=True), [[0.1, -0.2, 0.7]] * 9000, [-3000] * 9000
    )
    assert [corrector.bias_lsb(axis) / LSB for axis in range(3)] == pytest.approx(
        [0.1, -0.2, 0.7], abs=0.05
    )
    assert corrector.quality_lsb(2) / LSB < 0.05
    assert "gz not at all" in corrector.explain()


def by_the_text(motion, sub_unit_s, units, step_dps):
    """US 2015/0033821 in float64: (intervals, 3) offsets, dps, at the end of each."""
    n = round(sub_unit_s * motion.hz)
    parts = motion.samples[: len(motion.samples) // n * n].reshape(-1, n, motion.samples.shape[1])
    force, rate_dps = parts[:, :, :3].mean(1), parts[:, :, 4:].mean(1) / LSB
    offsets, offset, counter = [], np.zeros(3), np.zeros(3)
    angle = np.arctan2(force[:, [1, 2, 0]], force[:, [2, 0, 1]])  # of each axis' pair
    for k in range(1, len(parts)):
        equivalent_dps = np.degrees(angle[k] - angle[k - 1]) / sub_unit_s
        gyroscope_dps = (rate_dps[k] + rate_dps[k - 1]) / 2 - offset  # from middle to middle
        counter += np.sign(gyroscope_dps - equivalent_dps)
        if (k + 1) % units == 0:
            offset = offset + step_dps * np.sign(counter)
            offsets.append(offset)
            counter = np.zeros(3)
    return np.array(offsets)


def test_an_offset_goes_by_a_first_value_as_the_counter_says():
    alike = Rotation.align_vectors([[0, 0, 1]], [[1, 1, 1]])[0]  # every pair sees gravity
    motion = motions.turning(120, 0.0, [1, 0, 0], hz=100.0, start=alike)
    corrector = Corrector(Sensor(odr_hz=motion.hz), document=True, gravity=True)
    c, step_dps = corrector.gravity_settings, 0.1
    plain = by_the_text(
        motion, c[GRAVITY_SETTINGS.SUB_UNIT_US] / 1e6, c[GRAVITY_SETTINGS.UNITS], step_dps
    )
    source = motions.Fed(
        gravity.update, c, corrector.gravity, GRAVITY.GRAVITY_BIAS_Q8, GRAVITY.GRAVITY_QUALITY_Q8
    ).feed(motion)
    offsets = np.array([offset for _, offset, _ in source.learned])
    assert len(offsets) == len(plain) >= 55
    assert np.abs(offsets[:9] - plain[:9]).max() < 0.01 * step_dps
    assert np.abs(offsets - plain).max() < 3.5 * step_dps, "noise decides near the truth"
    assert np.abs(plain[-5:] - motion.bias_dps).max() < 3 * step_dps


MODES = [{}, {"document": True}, {"every": True}, {"document": True, "every": False}]


@pytest.mark.parametrize("mode", MODES, ids=str)
@pytest.mark.parametrize("name", sorted(DEFAULTS))
def test_a_setting_counts_or_is_refused(mode, name):
    """None is taken in silence for nothing."""

    def made(value):
        options = {"bins": None, "short": 3, "long": 5, "document": False, "ignore_outside": None}
        options |= {"every": mode.get("every", mode.get("document", False)), **mode}
        return settings(Sensor(), given={name: value}, **options)

    seen = set()
    for share in (0.3, 0.5, 0.8, 1.2, 2.0, 4.0):
        try:
            words, walk_q16, chosen = made(max(LEAST.get(name, 0), DEFAULTS[name] * share))
        except ValueError as error:
            assert "leave it out" in str(error), error
            return
        seen.add((*words, walk_q16, chosen["motion_start_dps"]))
    assert len(seen) > 1


def test_a_bias_beyond_the_documents_range_is_told_as_that():
    corrector = fed(Corrector(document=True), [[25.0, -0.2, 0.7]] * 3000, [-3000] * 3000)
    lines = corrector.explain().splitlines()
    assert "The device rests." in lines
    assert "gx: no bias yet, few readings lie in its range." in lines
