"""A slot as the integers of model.bin: the first thirty words of one on the board (layout.SLOT)."""

import math
from collections.abc import Callable, Sequence

from zerorate_tools.layout import SLOT

from ..recordings import Scales
from .model import FRAME, ONE, TIME, VIBRATION, CannotDeploy, Input, Slot, is_channel, sources_of
from .term import Term

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
        return Input(name, now, _exponent(max(abs(hi), 1.0)))
    if math.isinf(lo) or math.isinf(hi):
        return Input(name, now, _MOST_SHIFT - 1)
    offset = round((lo + hi) / 2)
    return Input(name, now, _exponent(max(hi - offset, offset - lo, 1.0), _LEAST_SHIFT), offset)


def _limits(name: str, slots: Sequence[Slot]) -> list[float]:
    own = [v for s in slots if s.term.source == name for v in (s.term.lo, s.term.hi)]
    return own + [
        v for s in slots if s.term.second == name for v in (s.term.second_lo, s.term.second_hi)
    ]


def _exponent(largest: float, shift: int = 0) -> int:
    while shift < _MOST_SHIFT and largest / 2.0**shift > _LARGEST:
        shift += 1
    return shift


Q = 24
NONE = -0x3FFFFFFF
MEMORIES = ("none", "lag", "difference", "rate", "backlash", "peak")
POWERS = (1, 2, 3)
_MOST_Q14 = 1 << 28
_MANTISSA_BITS = 20
_MOST_LAG_SHIFT = 13
_TABLE_SHIFT = 22
RING = 64
_MOST_STEP = 256

UnitOf = Callable[[str], Unit]
IndexOf = Callable[[str], int]


def words_of(
    slot: Slot, unit_of: UnitOf, index_of: IndexOf, tick_s: float, table: int, ring: int
) -> list[int]:
    """The slot's integers. index_of: of a source's input; table, ring: index of its own or -1.

    Raises CannotDeploy.
    """
    term = slot.term
    if term.power not in POWERS:
        raise CannotDeploy(
            f"an effect of {term.source} has power {term.power:g}; a slot has 1, 2 or 3, and a "
            "table of nine values for any other curve"
        )
    source = source_words(term.source, term.lo, term.hi, term.centre, unit_of, index_of)
    knot_q8 = None if term.knot is None else term.knot * unit_of(term.source).q8_per_unit
    shift = source[SLOT.SLOT_SHIFT] = _shift(term, source, knot_q8)
    per_one = one_of(term, unit_of, shift)
    second = [-1, 0, 0, 0, 0]
    if term.second:
        second = source_words(
            term.second, term.second_lo, term.second_hi, term.second_centre, unit_of, index_of
        )
        second[SLOT.SLOT_SHIFT] = largest_shift(most_of(second))
    return [
        *source,
        term.power,
        int(term.power_first),
        MEMORIES.index(_memory(term)),
        *_lag_words(term.lag_s if term.lag_mode != "none" else 0.0, tick_s, "lag_s"),
        _q24(term.width / 2 / per_one),
        NONE if term.knot is None else _q24(term.knot / per_one),
        *second,
        *_lag_words(term.decay_s, tick_s, "decay_s"),
        *_table_words(table, source),
        *_coefficient_words(slot, unit_of, shift, second[SLOT.SLOT_SHIFT]),
        *_delay_words(term, tick_s, ring),
    ]


def source_words(
    name: str, lo: float, hi: float, centre: float, unit_of: UnitOf, index_of: IndexOf
) -> list[int]:
    """Input, lowest, highest, centre, and room for the shift."""
    if name == ONE:
        return [index_of(name), 0, 256, 0, 0]
    unit = unit_of(name)
    return [index_of(name), unit.q8(lo), unit.q8(hi), unit.q8(centre), 0]


def most_of(words: Sequence[int]) -> int:
    """The farthest that a source goes from its centre, Q8."""
    _, low, high, centre = words[: SLOT.SLOT_SHIFT]
    return max(abs(low - centre), abs(high - centre), 1)


def largest_shift(most: int) -> int:
    """The largest shift that keeps `most` within 2^24."""
    return Q - (most - 1).bit_length()


def _shift(term: Term, source: Sequence[int], knot_q8: float | None) -> int:
    """The shift from Q8 to Q24 with which no stage of the slot leaves +-1."""
    most = most_of(source)
    if not term.power_first:
        _, lowest, highest, centre, _ = source
        low, high = lowest - centre, highest - centre
        if _memory(term) in MEMORIES[2:]:
            low, high = lowest - highest, highest - lowest
        if knot_q8 is not None:
            if abs(knot_q8) > 2 * most:
                raise CannotDeploy(f"the knot of an effect of {term.source} is far off its range")
            low, high = 0, max(1, math.ceil(high - knot_q8))
        most = max(most, abs(low), abs(high))
    return largest_shift(most)


def _memory(term: Term) -> str:
    if term.lag_mode != "none" and term.memory != "none":
        raise CannotDeploy(f"an effect of {term.source} has both a lag and a memory; use two")
    if term.lag_mode != "none" and not term.lag_s > 0:
        raise CannotDeploy(f"an effect of {term.source} has a lag of {term.lag_s:g} s")
    return term.lag_mode if term.lag_mode != "none" else term.memory


def _lag_words(seconds: float, tick_s: float, what: str) -> tuple[int, int]:
    """(mantissa, shift) of the share of its way that a lag goes in a tick."""
    if not seconds:
        return 0, 0
    share = -math.expm1(-tick_s / seconds)
    shift = 0
    while shift < _MOST_LAG_SHIFT and round(share * 2 ** (15 + shift + 1)) <= 1 << 15:
        shift += 1
    mantissa = round(share * 2 ** (15 + shift))
    if mantissa < 512:
        raise CannotDeploy(f"{what} of {seconds:g} s is too long for ticks of {tick_s:g} s")
    return mantissa, shift


def _delay_words(term: Term, tick_s: float, ring: int) -> tuple[int, int, int]:
    """(ring, ticks of delay, ticks between two kept)."""
    ticks = round(term.delay_s / tick_s)
    if ring < 0:
        return -1, 0, 1
    step = -(-ticks // (RING - 1))
    if step > _MOST_STEP:
        raise CannotDeploy(f"delay_s of {term.delay_s:g} s is too long for ticks of {tick_s:g} s")
    return ring, ticks, max(1, step)


def _q24(value: float) -> int:
    return round(min(max(value, -2.0), 2.0) * (1 << Q))


def one_of(term: Term, unit_of: UnitOf, shift: int) -> float:
    """What 1 is behind the memory: units of the source, to its power where that is first."""
    one = 1.0 if term.source == ONE else value_of_one(unit_of(term.source), shift)
    return one**term.power if term.power_first else one


def value_of_one(unit: Unit, shift: int) -> float:
    """What 1 is in the source's unit."""
    return 2.0 ** (Q - shift) / unit.q8_per_unit


def _table_words(table: int, source: Sequence[int]) -> tuple[int, ...]:
    if table < 0:
        return -1, 0, 0, 0
    _, lowest, highest, centre, shift = source
    low, span = (
        v << shift if shift >= 0 else v >> -shift for v in (lowest - centre, highest - lowest)
    )
    if span < 1 << 20:
        raise CannotDeploy("a table over a range of nearly nothing")
    return table, low, round(8 * (1 << Q) * (1 << _TABLE_SHIFT) / span), _TABLE_SHIFT


def lsb_q14_per_coefficient(term: Term, unit_of: UnitOf, shift: int, second_shift: int) -> float:
    """LSB in Q14 at a basis of 1, for a coefficient of 1 in units of dps (times LSB per dps)."""
    one = one_of(term, unit_of, shift)
    if not term.power_first:
        one **= term.power
    if term.table:
        one = 1.0
    if term.lag_mode == "rate":
        one /= term.lag_s
    if term.second and term.second != ONE:
        one *= value_of_one(unit_of(term.second), second_shift)
    return one * (1 << 14)


def _coefficient_words(
    slot: Slot, unit_of: UnitOf, shift: int, second_shift: int
) -> tuple[int, ...]:
    factor = lsb_q14_per_coefficient(slot.term, unit_of, shift, second_shift)
    gyro = unit_of("rate_x").q8_per_unit / 256
    q14 = [c * gyro * factor for c in slot.coefficient_dps]
    return mantissas(q14, _reach(slot.term), slot, gyro)


def mantissas(q14: Sequence[float], reach: int, slot: Slot, lsb_per_dps: float) -> tuple[int, ...]:
    """(shift, mantissas) of LSB in Q14 at a basis of 1, which may become `reach`."""
    most = max(map(abs, q14))
    if not math.isfinite(most) or most * reach >= _MOST_Q14:
        where = slot.effect or f"an effect of {slot.term.source}"
        raise CannotDeploy(f"{where} could move the rate by {most / 2**14 / lsb_per_dps:.0f} dps")
    at = 30
    while at > 15 and round(most * 2.0 ** (at - Q)) >= 1 << _MANTISSA_BITS:
        at -= 1
    return (at, *(round(c * 2.0 ** (at - Q)) for c in q14))


def _reach(term: Term) -> int:
    """How far beyond 1 the value may go: a difference of powers, by 1."""
    return 2 if term.power_first and _memory(term) in MEMORIES[2:] else 1
