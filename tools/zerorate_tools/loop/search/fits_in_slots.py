"""Whether the firmware has room for what was found."""

from collections.abc import Sequence
from dataclasses import replace

from ...model.model import MOST_CHANNELS, MOST_PLAYS, MOST_RINGS, MOST_SLOTS, MOST_TABLES
from ...model.term import Term
from ..read.sessions import OWN_SOURCES


def fits_in_slots(terms: Sequence[Term], taken: int = 0) -> bool:
    """For terms, a slot each, beside slots taken by what was found in motion.

    A play operator and its square have a place of their own.
    """
    channels = {n for t in terms for n in (t.source, t.second) if n and n not in OWN_SOURCES}
    delays = sum(t.delay_s > 0 for t in terms)
    plays = {replace(t, power=1) for t in terms if t.memory == "play"}
    slots = sum(t.memory != "play" for t in terms) + taken
    return (
        slots <= MOST_SLOTS
        and len(plays) <= MOST_PLAYS
        and delays <= MOST_RINGS
        and sum(t.table is not None for t in terms) <= MOST_TABLES
        and len(channels) <= MOST_CHANNELS
    )
