"""The line over temperature in integers against the same line in exact fractions."""

from fractions import Fraction
from functools import partial

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from zerorate import Corrector
from zerorate.rest import bias, fit
from zerorate_tools.layout import AXIS, MARKS, SETTINGS
from zerorate_tools.model import Slot
from zerorate_tools.model.term import Term

from .played import LINE_LSB
from .simulated_sources import SCALES, SENSOR, loaded

_RAIL_Q8 = 32767 * 256

points = st.lists(
    st.tuples(
        st.integers(-32768 * 16, 32767 * 16),  # temperature, raw LSB Q4
        st.integers(-5240 * 256, 5240 * 256),  # bias: +-40 dps at 131 LSB/dps, Q8
        st.integers(2, 131000),  # readings
    ),
    min_size=1,
    max_size=8,
)


class Axis:
    """The first axis of a corrector by the document, whose estimators the test fills."""

    def __init__(self):
        corrector = Corrector(document=True, fit_s=0.02)
        self.s, self.c = corrector.state, corrector.settings
        self.a = self.c[SETTINGS.AXES]

    def fit(self, points):
        """Fit the line through (temperature Q4, bias Q8, readings) in the pieces of an update."""
        s, c = self.s, self.c
        for k in range(c[SETTINGS.ESTIMATOR_COUNT] - 1):
            e = self.a + c[SETTINGS.FIRST_SHORT] + k * c[SETTINGS.ESTIMATOR_WORDS]
            s[e : e + 4] = type(s)("i", [MARKS.FREE, 0, 0, 0])
            if k < len(points):
                s[e : e + 4] = type(s)("i", [points[k][0] >> 4, *points[k]])
        fit.draw_line(s, c, self.a)
        fit.bend(s, c, self.a)
        return self

    def line_lsb(self, temp_q4):
        return fit.line_q8(self.s, self.a, temp_q4) / 256

    def choose(self, temp):
        """(source, whether beyond the fitted range) at a raw temperature."""
        return bias.choose(self.s, self.c, self.a, temp), self.s[self.a + AXIS.BEYOND]


@pytest.fixture(scope="module")
def axis():
    return Axis()


def exact_line(points):
    """The weighted least-squares line of the points: temperature Q4 -> bias Q8, a Fraction."""
    weight = sum(w for _, _, w in points)
    t0 = Fraction(sum(t * w for t, _, w in points), weight)
    b0 = Fraction(sum(b * w for _, b, w in points), weight)
    variance = sum(w * (t - t0) ** 2 for t, _, w in points)
    covariance = sum(w * (t - t0) * (b - b0) for t, b, w in points)
    slope = covariance / variance if variance else Fraction(0)
    return lambda t: b0 + slope * (t - t0)


@settings(max_examples=400, deadline=None)
@given(points=points, between=st.floats(0, 1))
def test_the_line_is_the_exact_one_everywhere_in_the_fitted_range(axis, points, between):
    exact = exact_line(points)
    low, high = min(points)[0], max(points)[0]
    # a steep line through a light point may leave what a reading can be: it is held there
    assume(max(abs(exact(low)), abs(exact(high))) <= _RAIL_Q8)
    axis.fit(points)
    for temp_q4 in (low, high, low + int((high - low) * between), *(t for t, _, _ in points)):
        assert abs(axis.line_lsb(temp_q4) - exact(temp_q4) / 256) <= LINE_LSB


def test_no_points_leave_no_line(axis):
    axis.fit([])
    assert axis.choose(1000) == (bias.NONE, 0)


SLOPE, BEND = Term("temp", 0.0, 80.0, 40.0), Term("temp", 0.0, 80.0, 40.0, power=2)
ALL, WITHOUT_Y = (0.001,) * 3, (0.001, 0.0, 0.001)
TEMP = partial(Term, "temp", 0.0, 80.0, 40.0)
OTHERS = [
    BEND,
    Term("temp", 39.5, 40.5, 40.0),  # never finer than without a model
    Term("acc_x", -1.0, 1.0),
    TEMP(knot=5.0),
    TEMP(lag_s=100.0, lag_mode="difference"),
    TEMP(second="acc_x", second_lo=-1.0, second_hi=1.0),
    TEMP(memory="peak"),
    TEMP(decay_s=90.0),
    TEMP(delay_s=1.0),
    TEMP(table=(0.0,) * 8 + (1.0,)),
]


def step_degc(corrector):
    return corrector.settings[SETTINGS.STEP_LSB] / SCALES.temp_lsb_per_degc


@pytest.mark.parametrize(
    ("slots", "degc"),
    [
        ([Slot(BEND, ALL), Slot(SLOPE, ALL)], 80.0 / 16),
        ([Slot(BEND, WITHOUT_Y), Slot(SLOPE, WITHOUT_Y)], None),
        *(([Slot(term, ALL)], None) for term in OTHERS),
    ],
)
def test_estimators_share_the_range_of_a_curve_that_the_model_holds_whole(slots, degc):
    corrector = Corrector(SENSOR)
    own = step_degc(corrector)
    corrector.use_model(loaded(slots))
    assert step_degc(corrector) == pytest.approx(degc or own, abs=0.01)
