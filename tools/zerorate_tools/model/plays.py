"""Play operators (Prandtl-Ishlinskii) in model.bin: 13 integers for an operator and its square."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace

from zerorate_tools.layout import PLAY, SLOT

from .model import ONE, CannotDeploy, Slot
from .slot_reading import all_shortest, with_shortest
from .slot_words import Unit, largest_shift, mantissas, most_of, source_words, value_of_one
from .term import Term

Pair = tuple[Slot | None, Slot | None]
"""An operator's slot of what it is, and that of its square."""
_ONE = 1 << 24


def split(slots: Sequence[Slot]) -> tuple[list[Slot], list[Pair]]:
    """The slots that are no play operators, and the operators, in their order.

    Raises CannotDeploy for what a play operator does not do.
    """
    pairs: dict[Term, list[Slot | None]] = {}
    for slot in slots:
        if not slot.is_play:
            continue
        if slot.term.power not in (1, 2) or slot.term.table or not _is_plain(slot.term):
            raise CannotDeploy(
                f"a play operator of {slot.term.source} has itself and its square, nothing else"
            )
        pair = pairs.setdefault(replace(slot.term, power=1), [None, None])
        if pair[slot.term.power - 1]:
            raise CannotDeploy(f"a play operator of {slot.term.source} is there twice")
        pair[slot.term.power - 1] = slot
    return [s for s in slots if not s.is_play], [(p[0], p[1]) for p in pairs.values()]


def _is_plain(term: Term) -> bool:
    return term == Term(
        *(term.source, term.lo, term.hi, term.centre, term.power), memory="play", width=term.width
    )


def label_of(pair: Pair) -> str:
    """What the operator corrects."""
    return next(slot.effect for slot in pair if slot)


def words_of_play(
    pair: Pair, unit_of: Callable[[str], Unit], index_of: Callable[[str], int]
) -> list[int]:
    """The operator's integers. index_of: of its source's input. Raises CannotDeploy."""
    slot = next(s for s in pair if s)
    term = slot.term
    if term.source == ONE:
        raise CannotDeploy("a play operator of a constant does nothing")
    source = source_words(term.source, term.lo, term.hi, term.centre, unit_of, index_of)
    shift = source[SLOT.SLOT_SHIFT] = largest_shift(most_of(source))
    radius = round(term.width / 2 / value_of_one(unit_of(term.source), shift) * _ONE)
    factors = _lsb_q14(term, unit_of, shift)
    rows = [s.coefficient_dps if s else (0.0, 0.0, 0.0) for s in pair]
    q14 = [c * f for row, f in zip(rows, factors) for c in row]
    gyro = unit_of("rate_x").q8_per_unit / 256
    return [*source, min(max(radius, 0), 2 * _ONE), *mantissas(q14, 1, slot, gyro)]


def _lsb_q14(term: Term, unit_of: Callable[[str], Unit], shift: int) -> list[float]:
    """LSB in Q14 at an operator of 1 and at its square, for a coefficient of 1 dps per unit."""
    gyro = unit_of("rate_x").q8_per_unit / 256
    return [value_of_one(unit_of(term.source), shift) ** p * gyro * (1 << 14) for p in (1, 2)]


def slots_of_play(
    words: Sequence[int], name: str, unit_of: Callable[[str], Unit], effect: str
) -> list[Slot]:
    """The inverse of `words_of_play`, numbers as short as they can be: the operator's slot, and
    that of its square where it has one."""
    unit = unit_of(name)
    source, *range_q8, shift = words[PLAY.PLAY_SOURCE : PLAY.PLAY_RADIUS]
    lo, hi, centre = map(unit.value, range_q8)
    width = 2 * words[PLAY.PLAY_RADIUS] / _ONE * value_of_one(unit, shift)
    term = Term(name, lo, hi, centre, memory="play", width=width)
    factors = [f * 2.0 ** (words[PLAY.PLAY_SHIFT] - 24) for f in _lsb_q14(term, unit_of, shift)]
    coefficients = words[PLAY.PLAY_COEFFICIENT : PLAY.PLAY_STARTED]
    exact = [w / f for w, f in zip(coefficients, (factors[0],) * 3 + (factors[1],) * 3)]

    def same(term: Term, six: Sequence[float]) -> bool:
        try:
            mine = words_of_play(_pair(term, six, effect), unit_of, lambda _: source)
        except CannotDeploy:  # of fewer digits it may be too large
            return False
        return mine == list(words)

    for name in ("lo", "hi", "centre", "width"):
        if math.isfinite(getattr(term, name)):
            term = with_shortest(term, name, lambda t: same(t, exact))
    six = all_shortest(exact, lambda values: same(term, values))
    linear, square = _pair(term, six, effect)
    assert linear and square
    return [s for s in (linear, square) if any(s.coefficient_dps)] or [linear]


def _pair(term: Term, six: Sequence[float], effect: str) -> Pair:
    return (
        Slot(term, (six[0], six[1], six[2]), effect),
        Slot(replace(term, power=2), (six[3], six[4], six[5]), effect),
    )
