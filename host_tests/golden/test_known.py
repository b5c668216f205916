"""Whole computations give the figures that were committed."""

import pytest

from .known import KNOWN, committed


@pytest.mark.parametrize("name", KNOWN)
def test_the_figures_are_those_that_were_committed(name):
    found, expected = KNOWN[name](), committed()[name]
    assert found.keys() == expected.keys()
    differ = {key: (found[key], of) for key, of in expected.items() if not _alike(found[key], of)}
    assert differ == {}, "other figures; if that is meant: python -m host_tests.golden"


def _alike(found, expected):
    """Whether texts are the same, and numbers to a ten-thousandth."""
    if any(isinstance(one, str) or one is None for one in expected):
        return found == expected
    return found == pytest.approx(expected, rel=1e-4, abs=1e-7)
