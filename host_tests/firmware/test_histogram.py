"""The adaptive histogram keeps its promises whatever is added to it."""

from array import array

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from zerorate import Corrector
from zerorate.rest import histogram
from zerorate_tools.layout import SETTINGS, STATE

MODES = {
    "default": {},
    "every": {"every": True},
    "document": {"document": True, "ignore_outside": False, "split_s": 0.01},
    "ignoring": {"document": True, "ignore_outside": True, "range_dps": 10.0},
    "19 bins": {"every": True, "bins": 19},
    "4 bins": {"document": True, "bins": 4},
}
modes = pytest.mark.parametrize("mode", sorted(MODES))

near = st.integers(-60, 60)
far = st.integers(-32768, 32767)
chunks = st.lists(st.tuples(st.one_of(near, far), st.sampled_from([1, 2, 64, 256, 1024])))


class Histogram:
    """One histogram behind the shared words that the kernels use."""

    def __init__(self, mode):
        self.c = Corrector(**MODES[mode]).settings
        self.bins = self.c[SETTINGS.BINS]
        self.sum = STATE.FIT_WEIGHTS  # behind what kernels keep for themselves
        self.h = self.sum + 2
        self.s = array("i", [0] * (self.h + 2 * self.bins + 1))
        histogram.clear(self.s, self.c, self.h, 0)

    def add(self, reading, weight=1):
        """Add `weight` readings at once; 1, or 0 if they were ignored."""
        self.s[self.sum], self.s[self.sum + 1] = reading * weight, weight
        return histogram.add(self.s, self.c, self.h, self.sum)

    @property
    def edges(self):
        return [self.s[self.h + i] >> 14 for i in range(self.bins + 1)]

    @property
    def counts(self):
        return [self.s[self.h + i] & 0x3FFF for i in range(self.bins)]

    @property
    def sums(self):
        return list(self.s[self.h + self.bins + 1 :])

    @property
    def widths(self):
        return [b - a for a, b in zip(self.edges, self.edges[1:])]


def sound(made):
    """Assert what always holds."""
    assert all(width > 0 for width in made.widths)
    assert all(count >= 0 for count in made.counts)
    assert all(total == 0 for total, count in zip(made.sums, made.counts) if count == 0)


@modes
@settings(max_examples=40, deadline=None)
@given(readings=chunks)
def test_edges_increase_strictly_always(mode, readings):
    made = Histogram(mode)
    for reading, weight in readings:
        made.add(reading, weight)
        sound(made)


@pytest.mark.parametrize("reading", [-32768, -20000, 20000, 32767])
def test_a_reading_outside_is_ignored_by_option(reading):
    made = Histogram("ignoring")
    before = bytes(made.s)
    assert made.add(reading) == 0
    made.s[made.sum], made.s[made.sum + 1] = 0, 0
    assert bytes(made.s) == before
