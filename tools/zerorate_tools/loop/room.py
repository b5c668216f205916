"""Whether the firmware has room for what was found."""

from __future__ import annotations

from collections.abc import Sequence

from ..model.model import MOST_CHANNELS, MOST_RINGS, MOST_SLOTS
from .basis import Term

#: Sources that every recording's own columns give.
_OWN = ("one", "time", "temp", "vib", "acc_x", "acc_y", "acc_z", "rate_x", "rate_y", "rate_z")


def is_room(terms: Sequence[Term], taken: int = 0) -> bool:
    """For terms, a slot each, beside slots taken by what was found in motion."""
    channels = {n for t in terms for n in (t.source, t.second) if n and n not in _OWN}
    delays = sum(t.delay_s > 0 for t in terms)
    slots = len(terms) + taken
    return slots <= MOST_SLOTS and delays <= MOST_RINGS and len(channels) <= MOST_CHANNELS
