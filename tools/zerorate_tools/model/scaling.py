"""Between a source's unit and the integers in which the firmware keeps it (Q8)."""

import math
from collections.abc import Sequence

from ..recordings import Scales
from .model import FRAME, ONE, TIME, VIBRATION, CannotDeploy, Input, Slot, is_channel, sources_of

#: A source's integers are of 16 bits, so in Q8 its limits are; without a limit it has these.
LOWEST, HIGHEST = -0x800000, 0x7FFFFF
_LARGEST = (1 << 15) - 1
_LEAST_SHIFT, _MOST_SHIFT = -8, 15


class Unit:
    """How many Q8 integers make a unit of the source, and which reading is integer 0."""

    def __init__(self, source: Input, scales: Scales, tick_s: float) -> None:
        per_unit, zero = _lsb(source.name, scales, tick_s)
        self.q8_per_unit = per_unit * 256 / 2.0**source.shift
        self.zero = zero + source.offset / per_unit

    def q8(self, value: float) -> int:
        """The integer for a value in the source's unit; infinite ones become the limits."""
        if math.isinf(value):
            return LOWEST if value < 0 else HIGHEST
        exact = (value - self.zero) * self.q8_per_unit
        return round(min(max(exact, LOWEST + 1), HIGHEST - 1))

    def value(self, q8: int) -> float:
        """The value that an integer stands for; the inverse of `q8`."""
        if q8 in (LOWEST, HIGHEST):
            return -math.inf if q8 < 0 else math.inf
        return q8 / self.q8_per_unit + self.zero


def _lsb(name: str, scales: Scales, tick_s: float) -> tuple[float, float]:
    """(integers per unit, zero in the unit) of a source before shift and offset."""
    if name == ONE or is_channel(name):
        return 1.0, 0.0
    if name == TIME:
        return 2.0 / tick_s, 0.0
    if name == "temp":
        if not scales.temp_lsb_per_degc:
            raise CannotDeploy("an effect follows the temperature, and the scales have none")
        return scales.temp_lsb_per_degc, scales.temp_offset_degc or 0.0
    if name in FRAME[4:]:
        return scales.gyro_lsb_per_dps, 0.0
    if not scales.accel_lsb_per_g:
        raise CannotDeploy(f"an effect follows {name}, and the scales have no acceleration")
    accel = scales.accel_lsb_per_g
    return (accel**2 if name == VIBRATION else accel), 0.0


def inputs_for(slots: Sequence[Slot], scales: Scales, tick_s: float) -> tuple[Input, ...]:
    """The inputs that the slots need, each with the shift that lets it span their ranges."""
    return tuple(_input(name, now, slots, scales, tick_s) for name, now in sources_of(slots))


def _input(name: str, now: bool, slots: Sequence[Slot], scales: Scales, tick_s: float) -> Input:
    if name in FRAME or name == ONE:
        return Input(name, now)
    limits = _limits(name, slots)
    per_unit, _ = _lsb(name, scales, tick_s)
    lo, hi = (v * per_unit for v in (min(limits), max(limits)))
    if name in (VIBRATION, TIME):
        return Input(name, now, _shift(max(abs(hi), 1.0)))
    if math.isinf(lo) or math.isinf(hi):
        return Input(name, now, _MOST_SHIFT - 1)
    offset = round((lo + hi) / 2)
    return Input(name, now, _shift(max(hi - offset, offset - lo, 1.0), _LEAST_SHIFT), offset)


def _limits(name: str, slots: Sequence[Slot]) -> list[float]:
    own = [v for s in slots if s.term.source == name for v in (s.term.lo, s.term.hi)]
    return own + [
        v for s in slots if s.term.second == name for v in (s.term.second_lo, s.term.second_hi)
    ]


def _shift(largest: float, shift: int = 0) -> int:
    while shift < _MOST_SHIFT and largest / 2.0**shift > _LARGEST:
        shift += 1
    return shift
