"""A slot as the 30 integers of model.bin, and back (firmware/zerorate/layout names the words)."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Any

from .model import ONE, CannotDeploy, Slot
from .scaling import Unit
from .term import Term

_Q = 24
NONE = -0x3FFFFFFF
MEMORIES = ("none", "lag", "difference", "rate", "backlash", "peak")
POWERS = (1, 2, 3)
_MOST_Q14 = 1 << 28
_MANTISSA_BITS = 20
_MOST_LAG_SHIFT = 13
_TABLE_SHIFT = 22
RING = 64
_MOST_STEP = 256
_INDICES = (0, 12)
_COEFFICIENTS = range(23, 27)
_OF_THE_BASIS = [i for i in range(30) if i not in (*_INDICES, *_COEFFICIENTS)]

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
    shift = source[4] = _shift(term, source, knot_q8)
    per_one = _one(term, unit_of, shift)
    second = [-1, 0, 0, 0, 0]
    if term.second:
        second = source_words(
            term.second, term.second_lo, term.second_hi, term.second_centre, unit_of, index_of
        )
        second[4] = largest_shift(most_of(second))
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
        *_coefficient_words(slot, unit_of, shift, second[4]),
        *_delay_words(term, tick_s, ring),
    ]


def source_words(name, lo, hi, centre, unit_of, index_of) -> list[int]:
    """Input, lowest, highest, centre, and room for the shift."""
    if name == ONE:
        return [index_of(name), 0, 256, 0, 0]
    unit = unit_of(name)
    return [index_of(name), unit.q8(lo), unit.q8(hi), unit.q8(centre), 0]


def most_of(words: Sequence[int]) -> int:
    """The farthest that a source goes from its centre, Q8."""
    return max(abs(words[1] - words[3]), abs(words[2] - words[3]), 1)


def largest_shift(most: int) -> int:
    """The largest shift that keeps `most` within 2^24."""
    return _Q - (most - 1).bit_length()


def _shift(term: Term, source: Sequence[int], knot_q8: float | None) -> int:
    """The shift from Q8 to Q24 with which no stage of the slot leaves +-1."""
    most = most_of(source)
    if not term.power_first:
        low, high = source[1] - source[3], source[2] - source[3]
        if _memory(term) in MEMORIES[2:]:
            low, high = -(source[2] - source[1]), source[2] - source[1]
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
    return round(min(max(value, -2.0), 2.0) * (1 << _Q))


def _one(term: Term, unit_of: UnitOf, shift: int) -> float:
    """What 1 is behind the memory: units of the source, to its power where that is first."""
    one = 1.0 if term.source == ONE else value_of_one(unit_of(term.source), shift)
    return one**term.power if term.power_first else one


def value_of_one(unit: Unit, shift: int) -> float:
    """What 1 is in the source's unit."""
    return 2.0 ** (_Q - shift) / unit.q8_per_unit


def _table_words(table: int, source: Sequence[int]) -> tuple[int, ...]:
    if table < 0:
        return -1, 0, 0, 0
    low, span = (v << source[4] if source[4] >= 0 else v >> -source[4] for v in (
        source[1] - source[3], source[2] - source[1]))  # fmt: skip
    if span < 1 << 20:
        raise CannotDeploy("a table over a range of nearly nothing")
    return table, low, round(8 * (1 << _Q) * (1 << _TABLE_SHIFT) / span), _TABLE_SHIFT


def lsb_q14_per_coefficient(slot: Slot, unit_of: UnitOf, shift: int, second_shift: int) -> float:
    """LSB in Q14 at a basis of 1, for a coefficient of 1 in units of dps (times LSB per dps)."""
    term = slot.term
    one = _one(term, unit_of, shift)
    if not term.power_first:
        one **= term.power
    if term.table:
        one = 1.0
    if term.lag_mode == "rate":
        one /= term.lag_s
    if term.second and term.second != ONE:
        one *= value_of_one(unit_of(term.second), second_shift)
    return one * (1 << 14)


def _coefficient_words(slot, unit_of, shift, second_shift):
    factor = lsb_q14_per_coefficient(slot, unit_of, shift, second_shift)
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
    while at > 15 and round(most * 2.0 ** (at - _Q)) >= 1 << _MANTISSA_BITS:
        at -= 1
    return (at, *(round(c * 2.0 ** (at - _Q)) for c in q14))


def _reach(term: Term) -> int:
    """How far beyond 1 the value may go: a difference of powers, by 1."""
    return 2 if term.power_first and _memory(term) in MEMORIES[2:] else 1


def slot_of(
    words: Sequence[int],
    name_of: Callable[[int], str],
    unit_of: UnitOf,
    tick_s: float,
    table: Sequence[float] | None,
) -> Slot:
    """The slot whose integers these are, its numbers as short as they can be.

    name_of: an input's name; the inverse of words_of. Raises CannotDeploy where no slot is.
    """

    def encoded(slot: Slot) -> list[int]:
        return words_of(slot, unit_of, lambda _: 0, tick_s, words[19], words[27])

    def same(slot: Slot, among: Sequence[int]) -> bool:
        try:
            mine = encoded(slot)
        except CannotDeploy:  # of fewer digits it may be too large
            return False
        return all(mine[i] == words[i] for i in among)

    term = _term(words, name_of, unit_of, tick_s)
    term = replace(term, table=tuple(table) if table else None)
    slot = Slot(term, (0.0, 0.0, 0.0))
    for name in _numbers(term):
        slot = _shortest(slot, name, lambda s: same(s, _OF_THE_BASIS))
    factor = lsb_q14_per_coefficient(slot, unit_of, words[4], words[16])
    factor *= unit_of("rate_x").q8_per_unit / 256 * 2.0 ** (words[23] - _Q)
    for axis in range(3):
        exact = [w / factor for w in words[24:27]]
        exact[:axis] = slot.coefficient_dps[:axis]
        slot = _shortest_of(exact, axis, slot, lambda s: same(s, _COEFFICIENTS))
    if not same(slot, (*_OF_THE_BASIS, *_COEFFICIENTS)):
        raise CannotDeploy("its numbers do not belong together")
    return slot


def _term(words, name_of, unit_of, tick_s) -> Term:
    name, second = name_of(words[0]), name_of(words[12]) if words[12] >= 0 else None
    memory = MEMORIES[words[7]]
    fields: dict[str, Any] = {
        "power": words[5],
        "power_first": bool(words[6]),
        "delay_s": words[28] * tick_s,
    }
    if name != ONE:
        unit = unit_of(name)
        fields.update(lo=unit.value(words[1]), hi=unit.value(words[2]), centre=unit.value(words[3]))
    if memory in MEMORIES[1:4]:
        fields.update(lag_mode=memory, lag_s=_seconds(words[8], words[9], tick_s))
    else:
        fields.update(memory=memory)
    if second and second != ONE:
        unit = unit_of(second)
        low, high, centre = (unit.value(w) for w in words[13:16])
        fields.update(second_lo=low, second_hi=high, second_centre=centre)
    term = Term(name, second=second, decay_s=_seconds(words[17], words[18], tick_s), **fields)
    one = _one(term, unit_of, words[4]) / (1 << _Q)
    knot = None if words[11] == NONE else words[11] * one
    return replace(term, width=2 * words[10] * one, knot=knot)


def _seconds(mantissa: int, shift: int, tick_s: float) -> float:
    if not mantissa:
        return 0.0
    share = mantissa / 2 ** (15 + shift)
    return tick_s * 1e-3 if share >= 1 else -tick_s / math.log1p(-share)


def _numbers(term: Term) -> list[str]:
    names = ["lo", "hi", "centre", "delay_s", "lag_s", "width", "knot", "decay_s"]
    if term.second:
        names += ["second_lo", "second_hi", "second_centre"]
    finite = [n for n in names if getattr(term, n) is not None]
    return [n for n in finite if math.isfinite(getattr(term, n))]


def _shortest(slot: Slot, name: str, is_same: Callable[[Slot], bool]) -> Slot:
    """The slot with the number of that name in as few digits as mean the same."""
    value = getattr(slot.term, name)
    for number in shorter(value):
        field: dict[str, Any] = {name: number}
        trial = replace(slot, term=replace(slot.term, **field))
        if is_same(trial):
            return trial
    return slot


def shorter(value: float) -> Iterator[float]:
    """The number in ever more digits."""
    yield 0.0
    yield from (float(f"{value:.{digits}g}") for digits in range(1, 18))


def _shortest_of(exact, axis: int, slot: Slot, is_same: Callable[[Slot], bool]) -> Slot:
    for number in shorter(exact[axis]):
        values = list(exact)
        values[axis] = number
        trial = replace(slot, coefficient_dps=tuple(values))
        if is_same(trial):
            return trial
    return replace(slot, coefficient_dps=tuple(exact))
