"""Whether what a file holds can be a state: the kernels go where some of its words say, unasked."""

from collections.abc import Sequence

from zerorate import Corrector

from zerorate_tools import layout
from zerorate_tools.layout import AXIS, GRAVITY, MOTION, SETTINGS, STATE, Array, axis_at

_END = 2**30
_LAST_PIECE = 12  # of the work that a window leaves: four an axis


def can_be_a_state(corrector: Corrector) -> bool:
    """Whether each word fits 31 bits, and those that say which or where say one that there is."""
    state, settings = corrector.state, corrector.settings
    parts = [(state, STATE), (corrector.motion, MOTION), (corrector.gravity, GRAVITY)]
    axes = [axis_at(settings, axis) for axis in range(3)]
    there = [(words, array) for words, array in parts if words is not None]
    return (
        all(-_END <= word < _END for words, _ in there for word in words)
        and 0 <= state[STATE.WORK] <= _LAST_PIECE
        and all(_codes_hold(words, array, 0) for words, array in there)
        and all(_codes_hold(state, AXIS, at) for at in axes)
        and all(_estimators_hold(state, settings, at) for at in axes)
    )


def _codes_hold(words: Sequence[int], array: Array, at: int) -> bool:
    """Whether each code and each shift of an array, or of a block of it at `at`, is one."""
    for word in array.words:
        kind, _, name = word.unit.partition(" ")
        known = range(31) if kind == "bits" else None
        known = getattr(layout, name).numbers.values() if kind == "code" else known
        if known is not None and not word.while_text:
            first = at + word.index
            if any(code not in known for code in words[first : first + word.count]):
                return False
    return True


def _estimators_hold(state: Sequence[int], settings: Sequence[int], at: int) -> bool:
    """Whether the estimator in use and the order of the short-term ones are of this axis."""
    size = settings[SETTINGS.ESTIMATOR_WORDS]
    short = range(at + settings[SETTINGS.FIRST_SHORT], at + settings[SETTINGS.FIRST_LONG], size)
    order = at + AXIS.ORDER
    in_use = range(short.start, at + settings[SETTINGS.ESTIMATORS_END], size)
    return sorted(state[order : order + len(short)]) == list(short) and state[
        at + AXIS.CURRENT
    ] in (0, *in_use)
