"""The turns of a recording, beside the best reference that it has."""

from dataclasses import dataclass

from . import beside_gravity, beside_reference
from .reference import Run
from .still import still_ticks

GIVEN, GRAVITY = "the reference given", "the direction of gravity before and after each turn"
_UNIT = {GIVEN: "dps", GRAVITY: "rad"}


@dataclass(frozen=True)
class Turns:
    """Runs in time order, what they are measured beside, and the unit of their error."""

    runs: list[Run]
    beside: str

    @property
    def unit(self) -> str:
        """Of an error of a run."""
        return _UNIT[self.beside]


def turns_of(ticks) -> Turns:
    """Beside the reference given, if there is one, else beside gravity; perhaps none at all."""
    if ticks.turning is not None:
        return Turns(beside_reference.runs_of(ticks.turning, ticks.tick_s), GIVEN)
    if ticks.path is None:
        return Turns([], GRAVITY)
    turns = beside_gravity.turns_between_rests(ticks, still_ticks(ticks))
    return Turns(beside_gravity.runs_of(ticks.path, ticks, turns), GRAVITY)
