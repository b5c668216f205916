"""The estimators of one axis against a model cache: what is kept, evicted, promoted, replaced."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from zerorate import Corrector, Sensor
from zerorate.rest import estimators
from zerorate_tools.layout import AXIS, ESTIMATOR, SETTINGS, STATE

FREE = -1048576
STEP = 340
PROMOTE = 50


class Axis:
    """The first axis of a corrector, taught directly."""

    def __init__(self, document=True, **limits):
        limits = {"promote_s": PROMOTE / 100, **({"range_dps": 40.0} if document else {}), **limits}
        corrector = Corrector(Sensor(), document=document, **limits)
        self.s, self.c = corrector.state, corrector.settings
        self.a = self.c[SETTINGS.AXES]

    def learn(self, temp, reading=0, weight=1):
        self.s[self.a + AXIS.WAITING_SUM] = reading * weight
        self.s[self.a + AXIS.WAITING_N] = weight
        self.s[STATE.LEARN_TEMP] = temp
        estimators.learn_anywhere(self.s, self.c, self.a)
        estimators.learn_here(self.s, self.c, self.a)

    def each(self, first, end):
        """[(temperature, readings)] of the estimators between two offsets, FREE ones too."""
        words = range(self.a + first, self.a + end, self.c[SETTINGS.ESTIMATOR_WORDS])
        return [(self.s[e], self.s[e + ESTIMATOR.EST_READINGS]) for e in words]

    @property
    def short(self):
        return self.each(self.c[SETTINGS.FIRST_SHORT], self.c[SETTINGS.FIRST_LONG])

    @property
    def long(self):
        return self.each(self.c[SETTINGS.FIRST_LONG], self.c[SETTINGS.ESTIMATORS_END])

    @property
    def recent_first(self):
        """Temperatures of the short-term estimators, latest used first."""
        first = self.a + AXIS.ORDER
        order = self.s[first : first + self.c[SETTINGS.SHORT]]
        return [self.s[e] for e in order if self.s[e] != FREE]


@pytest.fixture
def axis():
    return Axis()


degrees = st.integers(-20, 60)


@settings(max_examples=60, deadline=None)
@given(visits=st.lists(degrees, min_size=1, max_size=60))
def test_the_short_term_estimators_are_a_least_recently_used_cache(visits):
    axis = Axis(promote_s=1000.0)  # nothing is promoted
    model = []
    for degree in visits:
        axis.learn(degree * STEP)
        if degree * STEP in model:
            model.remove(degree * STEP)
        model = [degree * STEP, *model][:3]
        assert axis.recent_first == model
    assert {temp for temp, _ in axis.long} == {FREE}


@settings(max_examples=60, deadline=None)
@given(visits=st.lists(st.tuples(degrees, st.sampled_from([1, 30, 60, 300])), max_size=60))
def test_long_term_estimators_have_enough_samples_and_are_replaced_by_richer_ones(visits):
    axis = Axis()
    for degree, weight in visits:
        before, evicted = axis.long, dict(axis.short)
        axis.learn(degree * STEP, 0, weight)
        for (was, had), (now, has) in zip(before, axis.long):
            if now == was:
                continue
            assert evicted[now] == has
            assert has >= PROMOTE
            assert was == FREE or has > had


def test_a_short_visit_is_not_promoted(axis):
    axis.learn(0, 0, PROMOTE - 1)
    for degree in (10, 20, 30):
        axis.learn(degree * STEP)
    assert {temp for temp, _ in axis.long} == {FREE}


def test_a_long_visit_is_promoted_when_it_is_evicted(axis):
    axis.learn(0, 5, PROMOTE)
    for degree in (10, 20):
        axis.learn(degree * STEP)
    assert (0, PROMOTE) not in axis.long
    axis.learn(30 * STEP)
    assert (0, PROMOTE) in axis.long


def test_a_promoted_temperature_goes_on_learning_where_it_is(axis):
    axis.learn(0, 5, PROMOTE)
    for degree in (10, 20, 30):
        axis.learn(degree * STEP)
    axis.learn(0, 5, 10)
    assert (0, PROMOTE + 10) in axis.long
    assert 0 not in [temp for temp, _ in axis.short]


def test_long_term_counts_are_halved_periodically():
    axis = Axis(halve_after_s=4.0)
    axis.learn(0, 5, 100)
    for degree in (10, 20, 30):
        axis.learn(degree * STEP, 0, 90)
    assert dict(axis.long)[0] == 100
    axis.learn(30 * STEP, 0, 40)  # 410 readings, the period is 400
    assert dict(axis.long)[0] == 50


@settings(max_examples=40, deadline=None)
@given(noise=st.lists(st.integers(-50, 50), min_size=30, max_size=200))
def test_noise_at_a_boundary_of_two_degrees_does_not_thrash_the_cache(noise):
    axis = Axis(promote_s=1000.0)
    axis.learn(40 * STEP)
    axis.learn(20 * STEP)
    for n in noise:
        axis.learn(STEP // 2 + n)  # on the boundary of degree 0 and degree 1
    assert len(axis.recent_first) == 3
    assert {20 * STEP, 40 * STEP} < set(axis.recent_first)
