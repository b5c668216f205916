"""Every word of every array of the firmware, and every code: the only place that says where.

The words are the lines of words.csv (`words.py` says how it is read): to add or remove one is to
add or remove its line. `make layout` writes the constants that a file uses into
it, where they cost a board nothing, and the tables of docs/layout.md. Host tools and tests read
this folder; a board has no need of it. A name stands for one thing in the whole firmware; in a
firmware file it begins with `_`.

Units: LSB of the sensor unless said; a number behind a name's last `_Q` is its fractional bits.
"""

from collections.abc import Mapping, Sequence

from . import codes
from .codes import *  # noqa: F403
from .words import Array as Array
from .words import Codes

STATE = Array("STATE", "The corrector's state", "s", "`Corrector.state`")
TURN_ON = Array(
    "TURN_ON", "The last words before the axes", "c[_AXES]", "the first axis block", first=-3
)
AXIS = Array("AXIS", "An axis", "a", "`c[_AXES] + axis * c[_AXIS_WORDS]`")
ESTIMATOR = Array("ESTIMATOR", "An estimator", "e", "`a + _ESTIMATORS + i * c[_ESTIMATOR_WORDS]`")
SETTINGS = Array(
    *("SETTINGS", "The corrector's settings", "c", "`Corrector.settings`", "SETTINGS_WORDS")
)
MOTION = Array("MOTION", "The state of the source in motion", "s", "`Corrector.motion`")
ROW = Array(
    *("ROW", "A row of a window in motion", "a", "`_WINDOW_ROWS + r * _ROW_WORDS`", "ROW_WORDS")
)
MOTION_SETTINGS = Array(
    *("MOTION_SETTINGS", "The settings of the source in motion", "c"),
    *("`Corrector.motion_settings`", "MOTION_SETTINGS_WORDS"),
)
GRAVITY = Array(
    *("GRAVITY", "The state of the source against gravity", "s"),
    *("`Corrector.gravity`", "GRAVITY_WORDS"),
)
GRAVITY_SETTINGS = Array(
    *("GRAVITY_SETTINGS", "The settings of the source against gravity", "c"),
    *("`Corrector.gravity_settings`", "GRAVITY_SETTINGS_WORDS"),
)
EFFECTS = Array(
    *("EFFECTS", "The effect model and its running state", "e"),
    *("`EffectModel.e`", "EFFECTS_WORDS"),
)
INPUT = Array(
    *("INPUT", "An input of the effect model", "a", "`_INPUTS + i * _INPUT_WORDS`", "INPUT_WORDS")
)
SLOT = Array("SLOT", "An effect slot", "a", "`_SLOTS + i * _SLOT_WORDS`", "SLOT_WORDS")
PLAY = Array("PLAY", "A play operator", "a", "`_PLAYS + i * _PLAY_WORDS`", "PLAY_WORDS")
RING = Array("RING", "A delay's ring", "ring", "`_RINGS + i * _RING_WORDS`", "RING_WORDS")

ARRAYS = tuple(one for one in vars().copy().values() if isinstance(one, Array))
CODES = tuple(one for one in vars(codes).values() if isinstance(one, Codes))


def axis_at(settings: Sequence[int], axis: int) -> int:
    """Return the first word of an axis of the corrector's state."""
    return settings[SETTINGS.AXES] + axis * settings[SETTINGS.AXIS_WORDS]


def slot_at(slot: int) -> int:
    """Return the first word of an effect slot."""
    return EFFECTS.SLOTS + slot * SLOT.size


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
