"""The line over temperature in integers against the same line in exact fractions."""

from fractions import Fraction

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from zerorate import Corrector, Sensor
from zerorate.rest import bias, fit
from zerorate_tools.layout import AXIS, ESTIMATOR, MARKS, SETTINGS, STATE, axis_at
from zerorate_tools.model import Slot
from zerorate_tools.model.term import Term

from .played import LINE_LSB
from .simulated_sources import SCALES, SENSOR, loaded

_FREE = -1048576
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


def test_a_few_samples_of_a_slow_rate_still_tell_near_from_far():
    slow, fast = (Corrector(Sensor(hz)) for hz in (1 / 15, 100.0))
    for corrector, readings in ((slow, 4), (fast, 2000)):
        s, c = corrector.state, corrector.settings
        a = c[SETTINGS.AXES]
        for k, (degree, bias_lsb) in enumerate([(0, 0), (2, 20), (40, 0), (60, 0)]):
            e = a + c[SETTINGS.FIRST_SHORT] + k * c[SETTINGS.ESTIMATOR_WORDS]
            held = (degree * 340, degree * 340 << 4, bias_lsb << 8, readings)
            s[e : e + 4] = type(s)("i", held)
        s[STATE.TEMP] = 2 * 340
        fit.draw_line(s, c, a)
        fit.bend(s, c, a)
    lines = [fit.line_q8(x.state, axis_at(x.settings, 0), 2 * 340 << 4) / 256 for x in (slow, fast)]
    assert lines[0] == pytest.approx(lines[1], rel=0.05)


SLOPE, BEND = Term("temp", 0.0, 80.0, 40.0), Term("temp", 0.0, 80.0, 40.0, power=2)
OTHERS = [
    Term("temp", 0.0, 80.0, 40.0, knot=5.0),
    Term("temp", 0.0, 80.0, 40.0, lag_s=100.0, lag_mode="difference"),
    Term("temp", 0.0, 80.0, 40.0, second="acc_x", second_lo=-1.0, second_hi=1.0),
    *(Term("temp", 0.0, 80.0, 40.0, **one) for one in (
        {"memory": "peak"}, {"decay_s": 90.0}, {"delay_s": 1.0}, {"table": (0.0,) * 8 + (1.0,)}
    )),
    Term("acc_x", -1.0, 1.0),
]  # fmt: skip


def step_degc(corrector):
    return corrector.settings[SETTINGS.STEP_LSB] / SCALES.temp_lsb_per_degc


def model_of(*terms):
    return loaded([Slot(t, (0.001, 0.001, 0.001)) for t in terms])


def test_estimators_share_the_range_of_a_curve_that_the_model_holds_whole():
    corrector = Corrector(SENSOR)
    own = step_degc(corrector)
    corrector.use_model(model_of(BEND, SLOPE))
    assert step_degc(corrector) == pytest.approx(80.0 / 16, abs=0.01)
    corrector.use_model(model_of(BEND))
    assert step_degc(corrector) == own


def test_they_are_never_finer_than_without_a_model():
    corrector = Corrector(SENSOR)
    own = step_degc(corrector)
    corrector.use_model(model_of(Term("temp", 39.5, 40.5, 40.0)))
    assert step_degc(corrector) == own


@pytest.mark.parametrize("term", OTHERS)
def test_a_model_without_the_slope_leaves_them_as_they_are(term):
    corrector = Corrector(SENSOR)
    own = step_degc(corrector)
    corrector.use_model(model_of(term))
    assert step_degc(corrector) == own


def test_an_axis_that_the_model_leaves_alone_learns_as_without_a_model():
    corrector = Corrector(SENSOR)
    own = step_degc(corrector)
    corrector.use_model(loaded([Slot(SLOPE, (0.001, 0.0, 0.001)), Slot(BEND, (0.001, 0.0, 0.001))]))
    assert step_degc(corrector) == own


@pytest.fixture
def near():
    """The same by default: points near the temperature at hand count most."""
    axis = Axis.__new__(Axis)
    corrector = Corrector(motion=False, gravity=False)
    axis.s, axis.c = corrector.state, corrector.settings
    axis.a = axis.c[SETTINGS.AXES]
    return axis


@settings(
    max_examples=100, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(points=points, at=st.integers(-32768, 32767))
def test_by_default_a_point_counts_by_its_readings_and_its_distance(near, points, at):
    s, c = near.s, near.c
    s[STATE.TEMP] = at
    near.fit(points)
    weights = []
    for temp_q4, _, readings in points:
        d = (temp_q4 - 16 * at) >> c[SETTINGS.LOCAL_SHIFT]
        d = d if abs(d) <= 0x3FFF else 0x3FFF
        w = (
            min(readings, c[SETTINGS.MOST_COUNTED])
            * c[SETTINGS.NEAR]
            // (c[SETTINGS.LOCAL] + d * d)
        )
        weights.append(w + 1 if readings >= c[SETTINGS.ENOUGH_TO_FIT] else 0)
    at = STATE.FIT_WEIGHTS + 1
    assert list(s[at : at + len(points)]) == weights and s[STATE.FIT_SUM_W] == sum(weights)
    there = [p for p, w in zip(points, weights) if w]
    assert near.s[near.a + AXIS.LINE_POINTS] == len(there)
    assert near.s[near.a + AXIS.LINE_SAMPLES] == sum(n for _, _, n in there)
    if there:
        exact = exact_line([(t, b, w) for (t, b, _), w in zip(points, weights) if w])
        low, high = min(there)[0], max(there)[0]
        assume(max(abs(exact(low)), abs(exact(high))) <= _RAIL_Q8)
        for temp_q4 in (low, high):
            assert abs(near.line_lsb(temp_q4) - exact(temp_q4) / 256) <= LINE_LSB


def test_a_bend_of_five_points_is_the_parabola_through_them_held_a_quarter_beyond(near):
    s, a = near.s, near.a
    bent = [(16 * 340 * k, 256 * (50 + 20 * k + 3 * k * k), 1000) for k in (0, 2, 3, 5, 8)]
    s[STATE.TEMP] = 4 * 340
    for count in (4, 5):
        near.fit(bent[:count])
        assert bool(s[a + AXIS.PARABOLA_Q6]) is (count == 5)
    for k in (0.0, 1.0, 4.5, 8.0, 10.0, -2.0):
        t = round(16 * 340 * k)
        found = (fit.line_q8(s, a, t) + fit.bent_q8(s, a, t)) / 256
        assert found == pytest.approx(50 + 20 * k + 3 * k * k, abs=1.8), k
    for end, way in ((8, 1), (0, -1)):
        held = fit.bent_q8(s, a, 16 * 340 * (end + 2 * way))
        assert fit.bent_q8(s, a, 16 * 340 * (end + 3 * way)) == held
        assert fit.bent_q8(s, a, 16 * 340 * (end + 2 * way) - 80 * way) != held


@pytest.mark.parametrize(
    ("left", "share"), [(0, 1.0), (40, 1.0), (60, 0.5), (79, 0.025), (80, 0.0)]
)
def test_a_bow_is_less_where_it_leaves_as_much_as_it_explains(axis, left, share):
    parabola, axis.s[STATE.BEND_DOT_Q12] = 1000, 4 * 41
    explained = 1000 * 41 // 1024
    assert explained == 40
    axis.s[STATE.BEND_LEFT_Q6] = left
    assert fit.significant(axis.s, parabola) == pytest.approx(1000 * share, abs=2)


@pytest.mark.parametrize("way", [1, -1])
def test_a_temperature_is_beyond_the_range_by_more_than_the_margin(axis, way):
    margin = axis.c[SETTINGS.BEYOND_Q4]
    axis.fit([(0, 0, 3), (way * 5440 * 16, 256, 3)])
    for off, beyond in ((0, 0), (1, 1)):
        for end, out in ((0, -way), (way * 5440, way)):
            assert axis.choose(end + out * (margin // 16 + off)) == (bias.FIT, beyond)


@pytest.mark.parametrize(
    ("here", "samples", "any_one", "points", "source"),
    [
        *((0, 0, 0, 0, bias.NONE), (0, 0, 1, 0, bias.NONE), (0, 512, 9, 1, bias.FIT)),
        *((-1, 0, 9, 1, bias.FIT), (0, 0, 9, 1, bias.FIT), (1, 0, 9, 1, bias.HERE)),
        *((2, 256, 0, 0, bias.HERE), (1, 1 << 20, 9, 1, bias.FIT)),
    ],
)
def test_an_estimator_speaks_where_it_is_stable_beside_the_line(
    axis, here, samples, any_one, points, source
):
    s, c, a = axis.fit([]).s, axis.c, axis.a
    stable, enough = c[SETTINGS.STABLE], c[SETTINGS.ENOUGH_TO_FIT]
    s[a + AXIS.CURRENT], s[3] = 0, 32767  # what no estimator is read from
    if here:
        e = a + c[SETTINGS.FIRST_SHORT]
        s[e], s[e + ESTIMATOR.EST_READINGS] = 1000, stable - 1 + max(0, here)
    s[a + AXIS.LINE_SAMPLES], s[a + AXIS.LINE_POINTS] = samples, points
    s[a + AXIS.ESTIMATORS + ESTIMATOR.EST_READINGS] = enough - 1 if any_one else 0
    assert axis.choose(1000)[0] == source
