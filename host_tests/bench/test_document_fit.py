"""The line's sums when readings that are learned meanwhile move a point, as the document's do."""

import pytest
from zerorate import Corrector
from zerorate.rest import fit
from zerorate_tools.layout import ESTIMATOR, SETTINGS


@pytest.fixture
def corrector():
    """One estimator with 2000 samples at 25 degC and a bias of 350 LSB, weighed for the line."""
    made = Corrector(document=True)
    s, c = made.state, made.settings
    first = c[SETTINGS.AXES] + c[SETTINGS.FIRST_SHORT]
    s[first : first + 4] = type(s)("i", [-3740, -3740 << 4, 350 << 8, 2000])
    fit.weigh(s, c, c[SETTINGS.AXES])
    return made


@pytest.mark.parametrize("before", [0, 1, -40])
@pytest.mark.parametrize("after", [-5000, -16, 16, 5000])
def test_a_line_through_a_point_that_moves_meanwhile_stays_at_its_bias(corrector, before, after):
    s, c = corrector.state, corrector.settings
    a = c[SETTINGS.AXES]
    mean_temp_q4 = a + c[SETTINGS.FIRST_SHORT] + ESTIMATOR.EST_MEAN_TEMP_Q4
    s[mean_temp_q4] += before
    fit.centre(s, c, a, 1)
    s[mean_temp_q4] += after
    fit.add_covariance(s, c, a, 1)
    fit.settle(s, c, a)
    for temp_q4 in (-3740 << 4, -3700 << 4):
        assert fit.line_q8(s, a, temp_q4) == 350 << 8
