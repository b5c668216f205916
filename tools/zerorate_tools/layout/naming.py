"""The name and the unit of every word of an array in memory, in its order."""

from collections.abc import Mapping, Sequence

from .effects import EFFECTS, INPUT, PLAY, RING, SLOT
from .motion import GRAVITY, MOTION, ROW
from .rest import AXIS, ESTIMATOR, SETTINGS, STATE, TURN_ON
from .words import Array

Names = list[tuple[str, str]]
_BLOCKS = {"INPUTS": INPUT, "SLOTS": SLOT, "PLAYS": PLAY, "RINGS": RING, "WINDOW_ROWS": ROW}


def named(array: Array, length: int, blocks: Mapping[str, Array] = _BLOCKS) -> Names:
    """(name, unit) of the first `length` words; a word of a block is NAME[block].WORD."""
    found: Names = []
    for word in (w for w in array.words if not w.while_text):
        count = length - word.index if isinstance(word.count, str) else word.count
        if word.name in blocks:
            block = blocks[word.name]
            inside = named(block, block.size or count, {})
            found += [
                (f"{word.name}[{i}].{name}", unit)
                for i in range(count // len(inside))
                for name, unit in inside
            ]
        else:
            several = [f"{word.name}[{i}]" for i in range(count)]
            found += [(name, word.unit) for name in ([word.name] if count == 1 else several)]
    return found[:length]


def named_state(settings: Sequence[int]) -> Names:
    """(name, unit) of every word of the corrector's state; settings: those of the corrector."""
    found = named(STATE, settings[SETTINGS.AXES])
    found[-3:] = named(TURN_ON, 3)
    size, each = settings[SETTINGS.AXIS_WORDS], settings[SETTINGS.ESTIMATOR_WORDS]
    axis = named(AXIS, AXIS.ESTIMATORS)
    for i in range((size - AXIS.ESTIMATORS) // each):
        axis += [(f"ESTIMATORS[{i}].{name}", unit) for name, unit in named(ESTIMATOR, each)]
    return found + [(f"{letter}.{name}", unit) for letter in "xyz" for name, unit in axis]


def named_source(name: str, length: int) -> Names:
    """(name, unit) of every word of the other arrays: motion, gravity or effects."""
    return named({"motion": MOTION, "gravity": GRAVITY, "effects": EFFECTS}[name], length)
