"""The line's sums when readings that are learned meanwhile move a point, as the document's do."""

import pytest
from zerorate import Corrector, fit


@pytest.fixture
def corrector():
    """One estimator with 400 samples at 25 degC and a bias of 350 LSB, weighed for the line."""
    made = Corrector(document=True)
    s, c = made.state, made.settings
    first = c[0] + c[14]
    s[first], s[first + 1], s[first + 2], s[first + 3] = -3740, -3740 << 4, 350 << 8, 400
    fit.weigh(s, c, c[0])
    return made


@pytest.mark.parametrize("before", [0, 1, -40])
@pytest.mark.parametrize("after", [-5000, -16, 16, 5000])
def test_a_line_through_a_point_that_moves_meanwhile_stays_at_its_bias(corrector, before, after):
    s, c, a = corrector.state, corrector.settings, corrector.settings[0]
    s[a + c[14] + 1] += before
    fit.centre(s, c, a, 1)
    s[a + c[14] + 1] += after
    fit.lean(s, c, a, 1)
    fit.settle(s, c, a)
    for temp_q4 in (-3740 << 4, -3700 << 4):
        assert fit.line_q8(s, a, temp_q4) == 350 << 8
