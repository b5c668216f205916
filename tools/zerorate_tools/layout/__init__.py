"""Every word of every array of the firmware, and every code: the only place that says where.

A file for each part of the firmware. A word takes the index behind the word before it, so to add or
remove one is to add or remove its line. `make layout` writes the constants that a file uses into
it, where they cost a board nothing, and the tables of docs/layout.md. Host tools and tests read
this folder; a board has no need of it. A name stands for one thing in the whole firmware; in a
firmware file it begins with `_`.

Units: LSB of the sensor unless said; a number behind a name's last `_Q` is its fractional bits.
"""

from collections.abc import Sequence
from types import ModuleType
from typing import TypeVar

from . import codes, effects, motion, rest
from .codes import *  # noqa: F403
from .effects import *  # noqa: F403
from .motion import *  # noqa: F403
from .rest import *  # noqa: F403
from .words import Array as Array
from .words import Codes

_Kind = TypeVar("_Kind")


def _of(kind: type[_Kind], *files: ModuleType) -> tuple[_Kind, ...]:
    """What the files define of a kind, in their order."""
    return tuple(one for file in files for one in vars(file).values() if isinstance(one, kind))


ARRAYS = _of(Array, rest, motion, effects)
CODES = _of(Codes, codes)


def axis_at(settings: Sequence[int], axis: int) -> int:
    """Return the first word of an axis of the corrector's state."""
    return settings[rest.SETTINGS.AXES] + axis * settings[rest.SETTINGS.AXIS_WORDS]


def slot_at(slot: int) -> int:
    """Return the first word of an effect slot."""
    return effects.EFFECTS.SLOTS + slot * effects.SLOT.size
