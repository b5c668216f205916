"""Whether recordings are of one device: their statements of its matrix differ by chance or not."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce

import numpy as np
from scipy.stats import f as fisher

from ..read.gate import CannotClose
from .columns import MATRIX
from .device import SIZES, Shown

#: Of a test that tells something from chance.
LEVEL = 1e-6
#: Odds below which it is not said with whom a recording is: one in a thousand of ten is wrong.
_SURE_NATS = np.log(1e4)


class DifferentDevices(CannotClose):
    """Recordings whose matrices differ by more than their scatter; groups: names of each; unsure:
    names of those that could also be with the others."""

    def __init__(self, groups: Sequence[Sequence[str]], unsure: Sequence[str]) -> None:
        names = " and ".join(f"({', '.join(sorted(g))})" for g in groups)
        either = f"; {', '.join(sorted(unsure))} could also be with the others" if unsure else ""
        super().__init__(
            f"these recordings do not have the same axes: {names} differ by more than recordings "
            f"of one device do{either}; close each group by itself"
        )
        self.groups = groups
        self.unsure = unsure


@dataclass(frozen=True)
class _Together:
    names: tuple[str, ...]
    shown: Shown
    apart: float


def distance(one: Shown, other: Shown) -> float:
    """Chi-squared of two statements being of one matrix; a size that no part exceeds bounds what
    either leaves open."""
    bound = np.eye(MATRIX) * SIZES[-1] ** -2
    inverses = [np.linalg.inv(s.normal + bound) for s in (one, other)]
    apart = inverses[0] @ one.right - inverses[1] @ other.right
    return float(apart @ np.linalg.solve(sum(inverses), apart))


def check_one_device(statements: Sequence[tuple[str, Shown]]) -> None:
    """Raises DifferentDevices where two groups of recordings, (name, statement) each, lie farther
    apart than each scatters: an F-test over recordings, for the best of all splits."""
    every = [_Together((name,), shown, 0.0) for name, shown in statements]
    number = len(every)
    if number < 3:
        return
    whole = reduce(_joined, every).apart
    sides = min(_splits(every), key=_parts)
    scatter = max(_parts(sides) / (MATRIX * (number - 2)), 1.0)
    ratio = (whole - _parts(sides)) / MATRIX / scatter
    if fisher.sf(ratio, MATRIX, MATRIX * (number - 2)) * 2.0 ** (number - 1) < LEVEL:
        raise DifferentDevices([s.names for s in sides], _unsure(every, sides, scatter))


def _parts(sides) -> float:
    return sides[0].apart + sides[1].apart


def _splits(every):
    """All ways to part up to ten recordings in two; of more, each against the others."""
    number = len(every)
    masks = range(1, 2 ** (number - 1)) if number <= 10 else [1 << k for k in range(number)]
    for mask in masks:
        yield _parted(every, [bool(mask >> k & 1) for k in range(number)])


def _parted(every, first):
    sides = [[s for s, is_first in zip(every, first) if is_first == side] for side in (True, False)]
    return [reduce(_joined, side) for side in sides]


def _unsure(every, sides, scatter) -> list[str]:
    """Names of those that on the other side would hardly be worse."""
    first = [s.names[0] in sides[0].names for s in every]
    names = []
    for k, s in enumerate(every):
        other = [side != (j == k) for j, side in enumerate(first)]
        alone = all(other) or not any(other)
        if not alone and _parts(_parted(every, other)) - _parts(sides) < 2 * scatter * _SURE_NATS:
            names.append(s.names[0])
    return names


def _joined(one: _Together, other: _Together) -> _Together:
    apart = one.apart + other.apart + distance(one.shown, other.shown)
    return _Together((*one.names, *other.names), one.shown + other.shown, apart)
