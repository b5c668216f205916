"""States with one word turned and a checksum that is right: a sample of what the command tries."""

from zerorate import Corrector
from zerorate_tools.layout import AXIS, axis_at

from .. import turned_words

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
