"""Which states can be, at both sides of every edge, and what one turned word does to a device."""

from array import array

import pytest
from zerorate import Corrector
from zerorate.storage.soundness import is_sound
from zerorate_tools.layout import AXIS, ESTIMATOR, SETTINGS, axis_at

from .. import turned_words
from . import trace
from .trace_on_host import corrector_for

MOST_READINGS = 0x3FFF
FREE = -0x100000


class Estimator:
    """The words of one estimator by name, its histogram apart."""

    def __init__(self, s, c, at):
        self.temp = s[at + ESTIMATOR.EST_TEMP]
        self.mean_temp = s[at + ESTIMATOR.EST_MEAN_TEMP_Q4] // 16
        self.bias_q8 = s[at + ESTIMATOR.EST_BIAS_Q8]
        self.readings = s[at + ESTIMATOR.EST_READINGS]
        h, bins = at + ESTIMATOR.EST_HISTOGRAM, c[SETTINGS.BINS]
        self.edges = [word >> 14 for word in s[h : h + bins + 1]]
        *self.counts, self.over = [word & MOST_READINGS for word in s[h : h + bins + 1]]
        self.totals = s[h + bins + 1 : h + 2 * bins + 1]


def fits(words, s, at):
    """Whether each word lies in the bits that its limits need."""
    n = at
    for word in (word for word in words if not word.while_text):
        for _ in range(word.count if isinstance(word.count, int) else 0):
            span = 1 << max(word.most, ~word.least).bit_length()
            if not (-span if word.least < 0 else 0) <= s[n] < span:
                return False
            n += 1
    return True


def can_be(s, c):
    return all(axis_can_be(s, c, axis_at(c, axis)) for axis in range(3))


def axis_can_be(s, c, a):
    step = c[SETTINGS.ESTIMATOR_WORDS]
    places = range(a + AXIS.ESTIMATORS, a + c[SETTINGS.ESTIMATORS_END], step)
    short = [p for p in places if a + c[SETTINGS.FIRST_SHORT] <= p < a + c[SETTINGS.FIRST_LONG]]
    coldest, hottest = s[a + AXIS.COLDEST], s[a + AXIS.HOTTEST]
    return (
        fits(AXIS.words, s, a)
        and sorted(s[a + AXIS.ORDER : a + AXIS.ORDER + len(short)]) == short
        and s[a + AXIS.CURRENT] in (0, *places[places.index(short[0]) :])
        and not (s[a + AXIS.OFFSET_Q8] and (c[SETTINGS.EVERY] or c[SETTINGS.LITERAL]))
        and (coldest <= hottest or (coldest, hottest) == (32767, -32768))
        and all(
            fits(ESTIMATOR.words, s, p)
            and estimator_can_be(Estimator(s, c, p), c, coldest, hottest, p == places[0])
            for p in places
        )
    )


def estimator_can_be(e, c, coldest, hottest, is_first):
    if e.readings and not coldest <= e.mean_temp <= hottest:
        return False
    most = 32 * c[SETTINGS.STEP_LSB] + c[SETTINGS.MARGIN_LSB]
    if e.temp == FREE:
        near = is_first or not e.readings
    else:
        near = not is_first and abs(e.mean_temp - e.temp) <= most
    low, high = e.edges[0], e.edges[-1]
    biases = [t * 256 // n for n, t in zip(e.counts, e.totals) if n]
    means_bias = any(abs(b - e.bias_q8) < 513 for b in biases)
    halved_away = len(e.counts) > 1 and 0 in e.counts
    return (
        near
        and not e.over
        and e.edges == sorted(set(e.edges))
        and all(low * n <= t <= high * n for n, t in zip(e.counts, e.totals))
        and (not e.readings or low * 256 <= e.bias_q8 <= high * 256)
        and sum(e.counts) <= e.readings
        and (means_bias or halved_away or not biases)
    )


def edges(s, c, a, p):
    """Yield (word, value): each word of an axis and of its estimator at p beside what may be."""
    for words, at in ((AXIS.words, a), (ESTIMATOR.words, p)):
        for word in words:
            if isinstance(word.count, int) and not word.while_text:
                span = 1 << max(word.most, ~word.least).bit_length()
                for value in {-span - 1, -span, -1, 0, 1, span - 1, span}:
                    yield at + word.index, value
    e, h, bins = Estimator(s, c, p), p + ESTIMATOR.EST_HISTOGRAM, c[SETTINGS.BINS]
    coldest, hottest = s[a + AXIS.COLDEST], s[a + AXIS.HOTTEST]
    most = 32 * c[SETTINGS.STEP_LSB] + c[SETTINGS.MARGIN_LSB]
    low, high = e.edges[0], e.edges[-1]
    known = sum(e.counts)
    centres = {
        a + AXIS.COLDEST: (e.mean_temp, hottest, 32767),
        a + AXIS.HOTTEST: (e.mean_temp, coldest, -32768),
        a + AXIS.CURRENT: (p, a + AXIS.ESTIMATORS, a + c[SETTINGS.ESTIMATORS_END]),
        a + AXIS.ORDER: (p, p + c[SETTINGS.ESTIMATOR_WORDS]),
        p + ESTIMATOR.EST_TEMP: (FREE, e.mean_temp + most, e.mean_temp - most),
        p + ESTIMATOR.EST_MEAN_TEMP_Q4: (16 * coldest, 16 * hottest + 16),
        p + ESTIMATOR.EST_READINGS: (known,),
        p + ESTIMATOR.EST_BIAS_Q8: (low << 8, high << 8),
    }
    for n, t in zip(e.counts, e.totals):
        if n:
            centres[p + ESTIMATOR.EST_BIAS_Q8] += (256 * t // n - 513, 256 * t // n + 513)
    for k in range(bins):
        n = e.counts[k]
        centres[h + k] = (s[h + k], s[h + k] - n, (e.edges[k + 1] << 14) + n)
        centres[h + bins + 1 + k] = (low * n, high * n)
    centres[h + bins] = (s[h + bins],)
    for at, values in centres.items():
        for value in values:
            yield from ((at, value + by) for by in (-1, 0, 1))


@pytest.mark.parametrize("mode", sorted(trace.MODES))
def test_a_word_at_any_edge_is_judged_as_by_a_second_reading(mode):
    corrector, frame, generator = corrector_for(mode), array("i", [0] * 7), trace.GENERATOR
    generator = array("i", generator)
    for n in range(min(trace.UPDATES[mode], 1500)):
        corrector.update(frame, trace.fill(frame, n, generator))
    s, c, judged = corrector.state, corrector.settings, {True: 0, False: 0}
    assert can_be(s, c) and is_sound(s, c)
    a = axis_at(c, 1)
    current = s[a + AXIS.CURRENT] or a + AXIS.ESTIMATORS
    for p in {a + AXIS.ESTIMATORS, current, a + c[SETTINGS.FIRST_LONG]}:
        for at, value in edges(s, c, a, p):
            kept, s[at] = s[at], max(-(1 << 31), min(value, (1 << 31) - 1))
            expected = can_be(s, c)
            assert is_sound(s, c) == expected, (at - a, at - p, value, kept)
            judged[expected] += 1
            s[at] = kept
    assert min(judged.values()) > 100


BINS = {"bins": 8}


def test_a_turned_word_ends_on_micropython_as_on_cpython_to_the_last_bit(micropython):
    first = axis_at(Corrector(**BINS).settings, 0)
    tried, differences = turned_words.differences(micropython, BINS, 1, 1, range(first, first + 60))
    assert tried > 50 and not differences


def test_a_turned_word_does_no_harm_for_good():
    first = axis_at(Corrector(**BINS).settings, 2)
    words = [first + at for at in (AXIS.CURRENT, AXIS.LINE_SHIFT, AXIS.OFFSET_Q8, AXIS.ESTIMATORS)]
    told, fallen = turned_words.attack(BINS, 2, 1, [*words, *range(first + 60, first + 66)])
    assert told["loaded"] and told["afresh"] and not fallen
