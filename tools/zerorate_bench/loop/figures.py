"""The figures that the loop must reach, each with its limit, its interval and whether it does."""

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from itertools import pairwise
from operator import attrgetter
from typing import Any, TypeVar

import numpy as np
from scipy.stats import binomtest

from . import devices as kinds
from .added_effects import CURVE_OF
from .files import ROWS
from .run_trial import Outcome

Looked = TypeVar("Looked")
Rows = dict[str, list[Outcome]]
#: How the names of figures begin that are of all devices together.
_OF_ALL = ("2x, named", "2x-5x all", "groups told", "held-out error")
_NAMED = (*kinds.CATALOGUE, kinds.KINK)
_FOUND, _LISTED, _CONFIRMED = map(attrgetter, ("found", "events", "confirmed"))
#: Ends of the probabilities that are counted together.
_TOLD = (0.05, 0.35, 0.65, 1.0)


@dataclass(frozen=True)
class Figure:
    """One row: what was measured on how many, the limit, the 95 % interval where it is a share.

    value and limit: percent, or the unit that is named; at_most: on which side the limit lies, or
    None where there is none.
    """

    name: str
    value: float
    limit: float | None
    at_most: bool
    devices: int
    low: float | None = None
    high: float | None = None
    unit: str = "%"

    def to_dict(self) -> dict[str, Any]:
        """Plain values, and whether the measured value keeps the limit; None without one."""
        met = None
        if self.limit is not None:
            met = self.value <= self.limit if self.at_most else self.value >= self.limit
        return {**asdict(self), "met": met}


def share(
    name: str,
    group: Iterable[Looked],
    says: Callable[[Looked], bool],
    limit: float | None,
    at_most: bool = False,
) -> Figure:
    """Percent of outcomes of which something holds."""
    hits = [bool(says(o)) for o in group]
    value, sure = 100.0 * sum(hits) / max(len(hits), 1), (0.0, 1.0)
    if hits:
        sure = binomtest(sum(hits), len(hits)).proportion_ci(method="wilson")
    return Figure(name, value, limit, at_most, len(hits), 100 * sure[0], 100 * sure[1])


def figures(outcomes: list[Outcome], whole: bool = True) -> list[Figure]:
    """Every figure that simulated devices and quiet recordings give. whole: whether these are all
    of them, so that what is said of all can be."""
    rows: Rows = defaultdict(list)
    for o in outcomes:
        rows[o.device.row].append(o)
    every = (f for f in _figures(rows) if f.devices)
    return [f for f in every if whole or not f.name.startswith(_OF_ALL)]


def _figures(rows: Rows) -> Iterator[Figure]:
    yield from _where_nothing_is(rows)
    yield from _catalogue(rows)
    for effect, some in _by_effect(rows[kinds.OUT]).items():
        channels = kinds.OUTSIDE[effect]
        name = f"outside, 2x {effect}: tied to {' and '.join(channels)}"
        yield share(name, some, partial(Outcome.tied_to, channels=channels), 90.0)
    yield from _curves(rows[kinds.CURVE])
    yield share(f"step invented at {kinds.CORNERS}", rows[kinds.CORNERS], _LISTED, 1.0, True)
    for n, limit in ((4, 10.0), (7, 2.0)):
        group = rows[row := f"{kinds.HIDDEN}, {n} sessions"]
        yield share(f"{row}: confirmed", group, _CONFIRMED, limit, at_most=True)
        yield share(f"{row}: tentative", group, lambda o: bool(o.found) > o.confirmed, None)
        yield share(f"{row}: said to be left", group, lambda o: o.excess, None)
    yield from _removed(rows)
    yield from _told(rows)
    for effects, some in _by_effect(rows[kinds.TWO]).items():
        yield share(f"2x {effects}: both named", some, _named, 90.0)
    yield from _many_widths(rows)
    yield from _from_files(rows)
    blocks = [
        o for row, of in rows.items() if row not in (*ROWS, kinds.TOLD, kinds.CORNERS) for o in of
    ]
    name = "held-out error made worse by more than 2 %"
    for hidden, which in ((False, name), (True, f"{name}, cause not recorded")):
        some = [o for o in blocks if o.device.row.startswith(kinds.HIDDEN) == hidden]
        yield share(which, some, lambda o: o.worse, 2.0, at_most=True)


def _where_nothing_is(rows: Rows) -> Iterator[Figure]:
    quiet = {row: of for row, of in rows.items() if row.startswith(kinds.NULL) or row == kinds.REAL}
    noise = [o for row, group in quiet.items() if row != kinds.REAL for o in group]
    yield share("found in nothing, all kinds", noise, _FOUND, 0.5, True)
    for row, group in quiet.items():
        yield share(
            f"found in {row}", group, _FOUND, 2.0 if row == kinds.REAL else 0.5, at_most=True
        )
    for row, group in quiet.items():
        yield share(f"step listed in {row}", group, _LISTED, None)
    yield share("found, or found and withdrawn, in nothing", noise, _found_at_first, None)


def _found_at_first(o: Outcome) -> bool:
    return bool(o.found or o.withdrawn)


def _by_effect(group: list[Outcome]) -> Rows:
    out: Rows = defaultdict(list)
    for o in group:
        out[" + ".join(e for e, _ in o.device.effects)].append(o)
    return out


def _catalogue(rows: Rows) -> Iterator[Figure]:
    twice, found = _by_effect(rows["2x"]), []
    for effect in _NAMED:
        limit = 80.0 if effect == kinds.KINK else 98.0
        yield share(f"2x {effect}: found", twice[effect], _FOUND, limit)
        found += [o for o in twice[effect] if o.found]
    yield share("2x, named rightly of those found", found, _named, 95.0)
    yield share("2x step: listed", twice[kinds.STEP], _LISTED, None)
    yield share("2x step: corrected", twice[kinds.STEP], _FOUND, 0.5, at_most=True)


def _named(o: Outcome) -> bool:
    return all(o.named(e) for e, _ in o.device.effects)


def _told(rows: Rows) -> Iterator[Figure]:
    """Groups by the chance that they were told with: how many are right, and how far that is from
    what was told."""
    some = [o for row in (*(f"{size:g}x" for size in kinds.SIZES), kinds.TWO) for o in rows[row]]
    each = [
        (p, any(effect in group.split("+") for effect, _ in o.device.effects))
        for o in some
        if {effect for effect, _ in o.device.effects} <= {*_NAMED}
        for groups in o.told
        for group, p in groups.items()
    ]
    for low, high in pairwise(_TOLD):
        own = [pair for pair in each if low < pair[0] <= high]
        if own:
            name = f"groups told with a probability of {low:g} to {high:g}"
            right = share(f"{name}: right", own, lambda pair: pair[1], None)
            off = abs(right.value - 100 * float(np.mean([p for p, _ in own])))
            yield right
            yield Figure(f"{name}: off", off, 10.0, True, len(own), unit="points")


def _curves(group: list[Outcome]) -> Iterator[Figure]:
    tied = partial(Outcome.tied_to, channels=(CURVE_OF,))
    yield share(f"{kinds.CURVE}: tied to it", group, tied, 95.0)
    for effect, some in _by_effect(group).items():
        name = f"{kinds.CURVE}, {effect}"
        yield share(f"{name}: tied to it", some, tied, None)
        if after := [o.after for o in some if o.within]:
            yield _times(f"{name}: error after, mean", float(np.mean(after)), 1.2, len(after))


def _from_files(rows: Rows) -> Iterator[Figure]:
    for row, of in ROWS.items():
        group, effect = rows[row], of.named
        if effect:
            yield share(f"{row}: named", group, partial(Outcome.named, effect=effect), 98.0)
            moved = [o.in_motion_mdps for o in group if o.in_motion_mdps is not None]
            if moved:
                value = float(np.sqrt(np.mean(np.square(moved))))
                yield Figure(f"{row}: error in motion", value, 10.0, True, len(moved), unit="mdps")
        else:
            yield share(f"{row}: found", group, _FOUND, None)
            yield share(f"{row}: confirmed", group, _CONFIRMED, 0.5, at_most=True)


def _removed(rows: Rows) -> Iterator[Figure]:
    """Mean of the error after over that of the noise alone, by effect and in all: every size counts
    alike, however many devices have it."""
    for effect in _NAMED:
        sizes = _after(rows, (effect,))
        if sizes:
            limit, number = 1.3 if effect == kinds.KINK else 1.1, sum(map(len, sizes))
            mean, square = (np.mean([np.mean(s**power) for s in sizes]) for power in (1, 2))
            yield _times(f"2x-5x {effect}: error after, mean", mean, limit, number)
            yield _times(f"2x-5x {effect}: error after, rms", np.sqrt(square), None, number)
    sizes = _after(rows, kinds.CATALOGUE)
    if sizes:
        mean, number = np.mean([s.mean() for s in sizes]), sum(map(len, sizes))
        yield _times("2x-5x all fourteen: error after, mean", mean, 1.1, number)


def _after(rows: Rows, effects: Sequence[str]) -> list[np.ndarray]:
    """The errors after of devices with one of the effects, of each size that there is."""
    groups = [rows[f"{size:g}x"] for size in kinds.SIZES]
    each = [[o.after for o in group if o.device.effects[0][0] in effects] for group in groups]
    return [np.array(after) for after in each if after]


def _times(name: str, value: float, limit: float | None, devices: int) -> Figure:
    return Figure(name, float(value), limit, True, devices, unit="x noise")


def _many_widths(rows: Rows) -> Iterator[Figure]:
    """Hysteresis of Prandtl-Ishlinskii form: of all numbers of power-ons, and of each."""
    each = {row: group for row, group in rows.items() if row.startswith(kinds.MANY_WIDTHS)}
    every = [o for group in each.values() for o in group]
    yield from _of_many_widths("", every, 95.0, 1.2)
    yield from _of_many_widths(", told but for its start", rows[kinds.TOLD])
    yield from _of_many_widths(", kept where it starts", rows[kinds.START_KNOWN], 95.0, 1.2)
    for row, group in each.items():
        yield from _of_many_widths(f", {row.split()[-1]} power-ons", group)


def _of_many_widths(
    which: str, group: list[Outcome], found: float | None = None, after: float | None = None
) -> Iterator[Figure]:
    name = f"2x hysteresis of many widths{which}"
    if group:
        named = partial(Outcome.named, effect="thermal-hysteresis")
        yield share(f"{name}: found", group, named, found)
        yield share(f"{name}: found, or found and withdrawn", group, _found_at_first, None)
        errors = np.mean([(o.after, o.unpruned) for o in group], axis=0)
        yield _times(f"{name}: error after, mean", errors[0], after, len(group))
        yield _times(f"{name}: were nothing withdrawn", errors[1], None, len(group))
