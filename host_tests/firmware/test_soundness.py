"""Which states can be, at both sides of every edge, and what one turned word does to a device."""

from array import array
from binascii import crc32

import pytest
from zerorate import Corrector
from zerorate.storage.soundness import is_sound
from zerorate_tools.layout import AXIS, ESTIMATOR, SETTINGS, axis_at

from .. import turned_words
from . import trace
from .trace_on_host import corrector_for

MOST_READINGS = 0x3FFF
FREE = -0x100000


def edges(s, c, a, p):
    """Yield (word, value): each word of an axis and of its estimator at p beside what may be."""
    for words, at in ((AXIS.words, a), (ESTIMATOR.words, p)):
        for word in words:
            if isinstance(word.count, int) and not word.while_text:
                span = 1 << max(word.most, ~word.least).bit_length()
                for value in (-span - 1, -span, -1, 0, 1, span - 1, span):
                    yield at + word.index, value
    h, bins = p + ESTIMATOR.EST_HISTOGRAM, c[SETTINGS.BINS]
    lines = [word >> 14 for word in s[h : h + bins + 1]]
    counts = [word & MOST_READINGS for word in s[h : h + bins]]
    totals = s[h + bins + 1 : h + 2 * bins + 1]
    mean_temp = s[p + ESTIMATOR.EST_MEAN_TEMP_Q4] // 16
    coldest, hottest = s[a + AXIS.COLDEST], s[a + AXIS.HOTTEST]
    most = 32 * c[SETTINGS.STEP_LSB] + c[SETTINGS.MARGIN_LSB]
    low, high = lines[0], lines[-1]
    known = sum(counts)
    centres = {
        a + AXIS.COLDEST: (mean_temp, hottest, 32767),
        a + AXIS.HOTTEST: (mean_temp, coldest, -32768),
        a + AXIS.CURRENT: (p, a + AXIS.ESTIMATORS, a + c[SETTINGS.ESTIMATORS_END]),
        a + AXIS.ORDER: (p, p + c[SETTINGS.ESTIMATOR_WORDS]),
        p + ESTIMATOR.EST_TEMP: (FREE, mean_temp + most, mean_temp - most),
        p + ESTIMATOR.EST_MEAN_TEMP_Q4: (16 * coldest, 16 * hottest + 16),
        p + ESTIMATOR.EST_READINGS: (known,),
        p + ESTIMATOR.EST_BIAS_Q8: (low << 8, high << 8),
    }
    for n, t in zip(counts, totals):
        if n:
            centres[p + ESTIMATOR.EST_BIAS_Q8] += (256 * t // n - 513, 256 * t // n + 513)
    for k in range(bins):
        n = counts[k]
        centres[h + k] = (s[h + k], s[h + k] - n, (lines[k + 1] << 14) + n)
        centres[h + bins + 1 + k] = (low * n, high * n)
    centres[h + bins] = (s[h + bins],)
    for at, values in centres.items():
        for value in values:
            yield from ((at, value + by) for by in (-1, 0, 1))


# how many can be, how many cannot, and which: CRC-32 of the verdicts
JUDGED = {
    "default": (479, 598, 1921370556),
    "document": (648, 876, 455201282),
    "every": (640, 776, 1406334677),
    "ignoring": (632, 784, 4068568626),
}


@pytest.mark.parametrize("mode", sorted(trace.MODES))
def test_words_at_their_edges_are_judged_as_was_committed(mode):
    """Whether each of some thousand changed states can be: by numbers, which of them can."""
    corrector, frame, generator = corrector_for(mode), array("i", [0] * 7), trace.GENERATOR
    generator = array("i", generator)
    for n in range(min(trace.UPDATES[mode], 1500)):
        corrector.update(frame, trace.fill(frame, n, generator))
    s, c, judged = corrector.state, corrector.settings, []
    assert is_sound(s, c)
    a = axis_at(c, 1)
    current = s[a + AXIS.CURRENT] or a + AXIS.ESTIMATORS
    for p in sorted({a + AXIS.ESTIMATORS, current, a + c[SETTINGS.FIRST_LONG]}):
        for at, value in edges(s, c, a, p):
            kept, s[at] = s[at], max(-(1 << 31), min(value, (1 << 31) - 1))
            judged.append(is_sound(s, c))
            s[at] = kept
    assert (judged.count(True), judged.count(False)) == JUDGED[mode][:2]
    assert crc32(bytes(judged)) == JUDGED[mode][2]


BINS = {"bins": 8}


# `make attacks` turns more of them, on armhf too.
def test_a_turned_word_ends_on_micropython_as_on_cpython_to_the_last_bit(find_runtime):
    first = axis_at(Corrector(**BINS).settings, 0)
    some = range(first, first + 60)
    tried, differences = turned_words.differences(find_runtime("x86"), BINS, 1, 1, some)
    assert tried > 50 and not differences


def test_a_turned_word_does_no_harm_for_good():
    first = axis_at(Corrector(**BINS).settings, 2)
    words = [first + at for at in (AXIS.CURRENT, AXIS.LINE_SHIFT, AXIS.OFFSET_Q8, AXIS.ESTIMATORS)]
    told, fallen = turned_words.attack(BINS, 2, 1, [*words, *range(first + 60, first + 66)])
    assert told["loaded"] and told["afresh"] and not fallen
