"""The adaptive histogram keeps its promises whatever is added to it."""

import random
from array import array

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from zerorate import Corrector, Sensor
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

    def __init__(self, mode, sensor=None, **more):
        self.c = Corrector(sensor, **{**MODES[mode], **more}).settings
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

    @property
    def read_out(self):
        return histogram.read_out_q8(self.s, self.h, self.bins) / 256


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


def test_the_bias_is_the_mean_of_the_bin_with_most_readings_for_its_width():
    made = Histogram("document")
    for k, (edge, count, total) in enumerate(
        [(-800, 90, -40000), (-100, 40, -2000), (0, 30, 475), (20, 99, 9900), (800, 0, 0)]
    ):
        made.s[made.h + k] = edge << 14 | count
        made.s[made.h + made.bins + 1 + k] = total
    for k in range(5, made.bins + 1):
        made.s[made.h + k] = (1000 + k) << 14
    assert made.read_out == pytest.approx(475 / 30, abs=1 / 256)  # 30 / 20 LSB is most


@pytest.mark.parametrize("lsb_per_dps", [131.0, 65.5, 32.8, 16.4])
@pytest.mark.parametrize("mean_lsb", [0.0, 0.3, 0.5, -3.02])
def test_what_was_learned_is_kept_in_every_range(lsb_per_dps, mean_lsb):
    sensor = Sensor(gyro_lsb_per_dps=lsb_per_dps)
    made, rng = Histogram("default", sensor), random.Random(1)
    for _ in range(3000):
        made.add(round(rng.gauss(mean_lsb, 0.06 * lsb_per_dps)))
    assert sum(made.counts) > 1500
    assert made.read_out == pytest.approx(mean_lsb, abs=0.3)
