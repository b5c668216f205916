"""The line's sums when readings that are learned meanwhile move a point, as the document's do."""

import pytest
from zerorate import Corrector, fit

_SUM_TT = 79
_ONE_Q27 = 1 << 27


@pytest.fixture
def corrector():
    """One estimator with 400 samples at 25 degC and a bias of 350 LSB, weighed and centred."""
    made = Corrector(document=True)
    s, c = made.state, made.settings
    first = c[0] + c[14]
    s[first], s[first + 1], s[first + 2], s[first + 3] = -3740, -3740 << 4, 350 << 8, 400
    fit.weigh(s, c, c[0])
    s[first + 1] += 1
    fit.centre(s, c, c[0], 1)
    s[first + 1] += 1
    fit.stretch(s, c, c[0])
    return made


@pytest.mark.parametrize("moved_q4", [-5000, -16, 16, 5000])
def test_a_point_that_moves_after_the_stretch_was_found_stays_within_27_bits(corrector, moved_q4):
    s, c = corrector.state, corrector.settings
    s[c[0] + c[14] + 1] += moved_q4
    fit.lean(s, c, c[0], 1)
    assert 0 < s[_SUM_TT] <= _ONE_Q27
