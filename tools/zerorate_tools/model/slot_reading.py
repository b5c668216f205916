"""A slot from the integers of model.bin: the inverse of slot_words, numbers as short as can be."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Any

from zerorate_tools.layout import SLOT

from .model import ONE, CannotDeploy, Slot
from .slot_words import MEMORIES, NONE, Q, UnitOf, lsb_q14_per_coefficient, one_of, words_of
from .term import Term

#: The words of the file: of these the inputs' indices are the file's own.
_INDICES = (SLOT.SLOT_SOURCE, SLOT.SLOT_SECOND)
_COEFFICIENTS = range(SLOT.SLOT_COEFFICIENT_SHIFT, SLOT.SLOT_RING)
_OF_THE_BASIS = [i for i in range(SLOT.SLOT_OWN) if i not in (*_INDICES, *_COEFFICIENTS)]


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
    table_and_ring = words[SLOT.SLOT_TABLE], words[SLOT.SLOT_RING]

    def same(slot: Slot, among: Sequence[int]) -> bool:
        try:
            mine = words_of(slot, unit_of, lambda _: 0, tick_s, *table_and_ring)
        except CannotDeploy:  # of fewer digits it may be too large
            return False
        return all(mine[i] == words[i] for i in among)

    term = replace(_term(words, name_of, unit_of, tick_s), table=tuple(table) if table else None)
    for name in _numbers(term):
        term = with_shortest(term, name, lambda t: same(Slot(t, (0.0, 0.0, 0.0)), _OF_THE_BASIS))
    second_shift = words[SLOT.SLOT_SECOND + SLOT.SLOT_SHIFT]
    factor = lsb_q14_per_coefficient(term, unit_of, words[SLOT.SLOT_SHIFT], second_shift)
    factor *= unit_of("rate_x").q8_per_unit / 256 * 2.0 ** (words[SLOT.SLOT_COEFFICIENT_SHIFT] - Q)
    exact = [w / factor for w in words[SLOT.SLOT_COEFFICIENT : SLOT.SLOT_RING]]
    x, y, z = all_shortest(exact, lambda c: same(Slot(term, (c[0], c[1], c[2])), _COEFFICIENTS))
    slot = Slot(term, (x, y, z))
    if not same(slot, (*_OF_THE_BASIS, *_COEFFICIENTS)):
        raise CannotDeploy("its numbers do not belong together")
    return slot


def _term(
    words: Sequence[int], name_of: Callable[[int], str], unit_of: UnitOf, tick_s: float
) -> Term:
    source, *range_q8 = words[SLOT.SLOT_SOURCE : SLOT.SLOT_SHIFT]
    other, *range_of_other_q8 = words[SLOT.SLOT_SECOND : SLOT.SLOT_SECOND + SLOT.SLOT_SHIFT]
    name, second = name_of(source), name_of(other) if other >= 0 else None
    memory = MEMORIES[words[SLOT.SLOT_MEMORY]]
    fields: dict[str, Any] = {
        "power": words[SLOT.SLOT_POWER],
        "power_first": bool(words[SLOT.SLOT_POWER_FIRST]),
        "delay_s": words[SLOT.SLOT_DELAY] * tick_s,
    }
    if name != ONE:
        low, high, centre = map(unit_of(name).value, range_q8)
        fields.update(lo=low, hi=high, centre=centre)
    if memory in MEMORIES[1:4]:
        fields.update(lag_mode=memory, lag_s=_seconds(words, SLOT.SLOT_LAG, tick_s))
    else:
        fields.update(memory=memory)
    if second and second != ONE:
        low, high, centre = map(unit_of(second).value, range_of_other_q8)
        fields.update(second_lo=low, second_hi=high, second_centre=centre)
    term = Term(name, second=second, decay_s=_seconds(words, SLOT.SLOT_DECAY, tick_s), **fields)
    one = one_of(term, unit_of, words[SLOT.SLOT_SHIFT]) / (1 << Q)
    knot = None if words[SLOT.SLOT_KNOT] == NONE else words[SLOT.SLOT_KNOT] * one
    return replace(term, width=2 * words[SLOT.SLOT_HALF_WIDTH] * one, knot=knot)


def _seconds(words: Sequence[int], at: int, tick_s: float) -> float:
    mantissa, shift = words[at : at + 2]
    if not mantissa:
        return 0.0
    share = math.ldexp(mantissa, -15 - shift)  # a damaged shift makes no integer of its length
    return tick_s * 1e-3 if share >= 1 else -tick_s / math.log1p(-share)


def _numbers(term: Term) -> list[str]:
    names = ["lo", "hi", "centre", "delay_s", "lag_s", "width", "knot", "decay_s"]
    if term.second:
        names += ["second_lo", "second_hi", "second_centre"]
    finite = [n for n in names if getattr(term, n) is not None]
    return [n for n in finite if math.isfinite(getattr(term, n))]


def with_shortest(term: Term, name: str, is_same: Callable[[Term], bool]) -> Term:
    """The term with the number of that name in as few digits as mean the same."""
    fields: Iterator[dict[str, Any]] = ({name: n} for n in _shorter(getattr(term, name)))
    return next(filter(is_same, (replace(term, **field) for field in fields)), term)


def all_shortest(
    values: list[float], is_same: Callable[[Sequence[float]], bool]
) -> Sequence[float]:
    """Numbers, each in as few digits as mean the same beside the others."""
    for i, value in enumerate(values):
        trials = ([*values[:i], n, *values[i + 1 :]] for n in _shorter(value))
        values = next(filter(is_same, trials), values)
    return values


def _shorter(value: float) -> Iterator[float]:
    """The number in ever more digits."""
    yield 0.0
    yield from (float(f"{value:.{digits}g}") for digits in range(1, 18))
