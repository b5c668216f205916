"""Numbers for people: zero has no sign."""

import pytest
from zerorate_tools.numbers import fixed


@pytest.mark.parametrize(
    ("value", "sign", "shown"),
    [(-0.0004, "+", "+0.000"), (-0.0, "", "0.000"), (-0.0006, "+", "-0.001"), (1.5, "", "1.500")],
)
def test_what_rounds_to_zero_has_no_minus(value, sign, shown):
    assert fixed(value, 3, sign) == shown
