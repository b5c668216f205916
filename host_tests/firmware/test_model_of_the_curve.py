"""What the corrector learns beside a model that holds the whole curve over temperature."""

import pytest
from zerorate import Corrector
from zerorate_tools.layout import SETTINGS
from zerorate_tools.model import Slot
from zerorate_tools.model.term import Term

from .simulated_sources import SCALES, SENSOR, loaded

SLOPE, BEND = Term("temp", 0.0, 80.0, 40.0), Term("temp", 0.0, 80.0, 40.0, power=2)
OTHERS = [
    Term("temp", 0.0, 80.0, 40.0, knot=5.0),
    Term("temp", 0.0, 80.0, 40.0, lag_s=100.0, lag_mode="difference"),
    Term("temp", 0.0, 80.0, 40.0, second="acc_x", second_lo=-1.0, second_hi=1.0),
    Term("acc_x", -1.0, 1.0),
]


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
