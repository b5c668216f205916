"""Every word of every array, and every code kept in one: the only place that says where they are.

A file for each part of the firmware. A word takes the index behind the word before it, so to add or
remove one is to add or remove its line. `make layout` writes the constants that a file uses into
it, where they cost a board nothing, and the tables of docs/layout.md. Host tools and tests read
this folder; a board has no need of it. A name stands for one thing in the whole firmware; in a
firmware file it begins with `_`.

Units: LSB of the sensor unless said; a number behind a name's last `_Q` is its fractional bits.
"""

from .codes import (
    GRAVITY_REASON,
    GUARD,
    INPUT_KIND,
    INSTANT,
    JOB,
    LIMITS,
    MARKS,
    MEMORY,
    MOTION_REASON,
    SOURCE,
    STILLNESS,
)
from .effects import EFFECTS, INPUT, PLAY, RING, SLOT
from .motion import COMPONENT, GRAVITY, GRAVITY_SETTINGS, MOTION, MOTION_SETTINGS
from .rest import AXIS, ESTIMATOR, SETTINGS, STATE, TURN_ON

ARRAYS = (
    STATE,
    TURN_ON,
    AXIS,
    ESTIMATOR,
    SETTINGS,
    MOTION,
    COMPONENT,
    MOTION_SETTINGS,
    GRAVITY,
    GRAVITY_SETTINGS,
    EFFECTS,
    INPUT,
    SLOT,
    PLAY,
    RING,
)
CODES = (
    GUARD,
    STILLNESS,
    SOURCE,
    JOB,
    MOTION_REASON,
    GRAVITY_REASON,
    INPUT_KIND,
    MEMORY,
    INSTANT,
    MARKS,
    LIMITS,
)


def axis_at(settings, axis):
    """Return the first word of an axis of the corrector's state."""
    return settings[SETTINGS.AXES] + axis * settings[SETTINGS.AXIS_WORDS]


def slot_at(slot):
    """Return the first word of an effect slot."""
    return EFFECTS.SLOTS + slot * SLOT.size


def names():
    """Return all names as a dict: name -> (number, title of what it belongs to)."""
    found = {}
    for array in ARRAYS:
        for word in array.words:
            found[word.name] = (word.index, array.title)
        if array.size_name:
            found[array.size_name] = (array.size, array.title)
    for codes in CODES:
        for name in codes.numbers:
            found[name] = (codes.numbers[name], codes.title)
    return found
