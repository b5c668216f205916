"""Which columns of a table an import takes, in which units, decided once before the rows."""

import re
import shlex
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from difflib import SequenceMatcher
from pathlib import Path

import numpy as np

from ...errors import BadRecording
from ...numbers import listed
from ...recordings.recording import ACCEL, ATTITUDE, COLUMNS, GYRO, TEMP, TIME
from ..tables.table import Chunk, Table
from . import guesses
from . import names as usual
from .mapping import Mapped, factor_in, map_words, parsed_mapping
from .units import RAW, TIME_S, factors_of, kind_of, other_unit, unit_in_name, units_of

_LISTED, _TOLD = 24, 8
#: LSB of a unit quaternion's part: finer than what cameras see.
_PART = 1e6
#: Logarithm of the times by which two clocks of a device are apart at most; units are 1000 times.
_ONE_TIME = np.log(2.0)


@dataclass
class Plan:
    """Columns by the names of a recording. raw: kinds (gyro, accel, temp) that are counts.
    by_format: the format itself says what its columns are. typed: kinds whose unit the user named.
    """

    wanted: dict[str, Mapped]
    factors: dict[str, tuple[float, float]]
    raw: frozenset[str] = frozenset()
    notes: list[str] = field(default_factory=list)
    by_format: bool = False
    typed: frozenset[str] = frozenset()

    @property
    def columns(self) -> list[str]:
        """The columns of the table that are needed, each once."""
        return list(dict.fromkeys(c for one in self.wanted.values() for c in one.columns))

    def physical(self, chunk: Chunk) -> dict[str, np.ndarray]:
        """Columns in dps, g, degC, seconds, or raw counts; extra channels by their factor."""
        return {t: m.taken(chunk.columns, *self.factors[t]) for t, m in self.wanted.items()}


def planned(
    table: Table,
    mapping: Sequence[Mapped],
    path: Path,
    *,
    units: Mapping[str, str] | None = None,
    instance: int = 0,
    without_time: bool = False,
) -> Plan:
    """The plan of a table: what is mapped, then what the format says, then what names tell.

    units: by kind (time, gyro, accel, temp), where neither mapping nor name says one. without_time:
    time stamps are not wanted. Raises BadRecording for a column that is not there, or a unit that
    nobody named.
    """
    notes: list[str] = []
    given = {mapped.target: _signed(mapped, table) for mapped in mapping}
    wanted = _found(table, given, instance, path, notes)
    wanted = {t: m for t, m in {**wanted, **given}.items() if not m.is_left_out}
    if without_time and TIME in wanted:
        notes.append(f"time column {wanted.pop(TIME).column!r} left aside, as --hz is given")
    if not all(axis in wanted for axis in ACCEL):
        wanted = {target: mapped for target, mapped in wanted.items() if target not in ACCEL}
    _check_there(table, wanted, units or {}, path)
    plan = Plan(wanted, {}, notes=notes, by_format=bool(table.mapping))
    named = [t for t, mapped in given.items() if mapped.unit and t in COLUMNS]
    plan.typed = frozenset([*(units or {}), *map(kind_of, named)])
    raw, unknown = set(), {}
    asked: dict[str, str] = {}
    first = table.first_rows(plan.columns)
    ask = (plan, table, units or {}, first, path)
    scaled = _of_attitude(wanted, first)
    time_unit: str | None = "us"
    if TIME in given and (size := factor_in(given[TIME].unit or "")):
        scaled[TIME] = size * TIME_S["us"]
    else:
        time_unit = _unit(TIME, *ask, None) if TIME in wanted else None
    if time_unit and "time" not in plan.typed:
        _refuse_other_times(wanted[TIME], time_unit, table, first, path)
    t_s = wanted[TIME].taken(first, scaled.get(TIME, TIME_S[time_unit])) if time_unit else None
    for target, mapped in wanted.items():
        factor = factor_in(mapped.unit) if mapped.unit and target != TIME else scaled.get(target)
        if target not in COLUMNS or factor:
            plan.factors[target] = (factor or 1.0, 0.0)
            continue
        unit = time_unit if target == TIME else _unit(target, *ask, t_s)
        if unit is None and target == TIME and np.isnan(first[mapped.column]).all():
            do = "write seconds, or dates as 2026-05-01T12:00:00.250; or count the rows: --hz N"
            raise BadRecording(path, f"no time can be read from column {mapped.column!r}", do=do)
        if unit is None:
            by_rate = target == TIME and table.said_hz
            words = hz_words(table) if by_rate else guesses.ready_words(target, wanted, first, t_s)
            unknown[mapped.column] = asked.setdefault(kind_of(target), words)
        if unit == RAW:
            raw.add(kind_of(target))
        plan.factors[target] = factors_of(target).get(unit or "", (1.0, 0.0))
    if unknown and TIME not in wanted and not without_time:
        # with its time a turning device tells the units itself
        unknown = {**({} if "ax" in wanted else unknown), "": hz_words(table)}
    if unknown:
        do = "give " + ", ".join(dict.fromkeys(unknown.values()))
        raise BadRecording(path, _of_unknown([*unknown]), do=do)
    plan.raw = frozenset(raw)
    return plan


def _refuse_other_times(
    time: Mapped, unit: str, table: Table, first: Mapping[str, np.ndarray], path: Path
) -> None:
    """Raise BadRecording for a time that another one denies, and for the digits of a clock."""
    column = time.column
    meant, other = _as_another_time(column, table) or (unit, "")
    if meant != unit and not time.plus:
        problem = f"column {column!r} in {unit} does not go on as {other!r} does"
        do = f"give {map_words(TIME, column, meant)}, or map {other!r} instead"
        raise BadRecording(path, problem, do=do)
    if unit == "s" and column not in table.calendar and guesses.are_digits_of_clock(first[column]):
        problem = f"column {column!r} goes from 59 to 100: the digits of a clock, as 141759.5"
        raise BadRecording(path, problem, do="write colons between them, as 14:17:59.5")


def _of_unknown(columns: list[str]) -> str:
    """What is wrong with columns whose units nobody named; "" stands for a time that lacks."""
    named = [repr(column) for column in columns if column]
    if not named:
        return "no time stamps"
    what, are = ("unit of column", "is") if len(named) == 1 else ("units of columns", "are")
    problem = f"the {what} {', '.join(named)} {are} not known"
    return problem + (", and there are no time stamps" if "" in columns else "")


def _of_attitude(wanted: Mapping[str, Mapped], first: Mapping[str, np.ndarray]) -> dict[str, float]:
    """Factors that keep the digits of a unit quaternion, whose parts would all be 0 and 1."""
    parts = [wanted[n].column for n in ATTITUDE if n in wanted]
    if len(parts) < len(ATTITUDE) or not guesses.is_unit(np.array([first[c] for c in parts])):
        return {}
    return dict.fromkeys(ATTITUDE, _PART)


def _signed(mapped: Mapped, table: Table) -> Mapped:
    """`-gyro_x` where only `gyro_x` is a column: its readings with the other sign."""
    bare = mapped.column.removeprefix("-")
    if mapped.column in table.names or bare not in table.names:
        return mapped
    return replace(mapped, column=bare, negative=True)


def _found(
    table: Table, given: Mapping[str, Mapped], instance: int, path: Path, notes: list[str]
) -> dict[str, Mapped]:
    """By the format's own mapping, else by usual names; what is given is not looked for."""
    if table.mapping:
        return {mapped.target: mapped for mapped in map(parsed_mapping, table.mapping)}
    names: dict[str, str] = {}
    if not all(axis in given for axis in GYRO):
        groups = _groups_of_rates(table)
        if len(groups) > 1:
            also = ", ".join(group["gx"] for group in groups)
            notes.append(f"of several gyroscopes ({also}) number {instance}: choose by --instance")
        if groups and instance >= len(groups):
            last = len(groups) - 1
            problem = f"there are {last + 1} gyroscopes" if last else "there is one gyroscope"
            do = f"give --instance 0 to {last}" if last else "leave --instance away"
            raise BadRecording(path, problem, do=do)
        names = groups[instance] if groups else {}
        if not groups and re.search("gyro|angular", path.name.lower()):
            names = usual.bare_axes(table.names)  # phones write a file a sensor, with columns x y z
    gyro = {target: mapped.column for target, mapped in given.items()} | names
    names = {**names, **usual.most_alike(_with_gravity(table), gyro, instance)}
    temp = usual.temperature(table.names)
    found = {t: Mapped(t, c) for t, c in {**names, **({TEMP: temp} if temp else {})}.items()}
    if split := _split_time(table):
        found[TIME] = Mapped(TIME, split[0], "s", split[1:])
    elif (time := _time_column(table)) is not None:
        found[TIME] = Mapped(TIME, time)
    return found


def _groups_of_rates(table: Table) -> list[dict[str, str]]:
    """Columns called as rates; not gx gy gz as long as gravity that turn as a force does, or beside
    others, where nothing else is called as a force: then they are in g."""
    groups = usual.gyro_groups(table.names)
    if len(groups) > 1:  # counts behind what they were made into
        groups.sort(
            key=lambda group: guesses.are_whole(*table.first_rows([*group.values()]).values())
        )
    plain = next((one for one in groups if usual.spelled(one["gx"]) == "gx"), None)
    if plain is None or usual.accel_groups(table.names) or unit_in_name("gx", plain["gx"]):
        return groups
    columns = [*table.first_rows([*plain.values()]).values()]
    is_force = guesses.as_long_as_gravity(columns) and (
        len(groups) > 1 or guesses.turns_as_gravity(columns)
    )
    return [one for one in groups if not (is_force and one is plain)]


def _with_gravity(table: Table) -> list[dict[str, str]]:
    """Of several accelerations those that are as long as gravity: others lack it."""
    groups = usual.accel_groups(table.names)
    if len(groups) < 2:
        return groups
    first = table.first_rows([name for group in groups for name in group.values()])
    having = [one for one in groups if guesses.gravity_unit([first[name] for name in one.values()])]
    return having or groups


def _split_time(table: Table) -> tuple[str, str, str] | None:
    """The columns of seconds and of a part of one, which is never as long as a second."""
    of_minutes = any(re.match("min(?:ute)?s?$", usual.spelled(name)) for name in table.names)
    for second, part, unit in () if of_minutes else usual.split_times(table.names):
        first = table.first_rows([second, part])
        is_part = np.nanmax(first[part], initial=0.0) * TIME_S[unit] < 1.0
        if is_part and guesses.are_whole(first[second]):
            return second, part, unit
    return None


def _time_column(table: Table) -> str | None:
    """Of the columns called as times the first in which one goes on: no day beside a time of it.
    Where that stands still, one that says its unit: no second beside its milliseconds. Where none
    is called so, one of dates, in a unit of time, or called as some clock, that only grows."""
    found = usual.time_columns(table.names)
    if not found:
        other = [*sorted(table.calendar), *usual.in_units_of_time(table.names)]
        other += filter(usual.is_clock, table.names)
        first = table.first_rows(list(dict.fromkeys(other))) if other else {}
        return next((name for name, values in first.items() if guesses.only_grows(values)), None)
    first = table.first_rows(found) if len(found) > 1 else {}
    differ = (n for n, values in first.items() if len(np.unique(values[values > 0])) > 1)
    usual_one = next(differ, found[0])
    if len(found) == 1 or guesses.only_grows(first[usual_one]):
        return usual_one
    finer = (n for n in usual.in_units_of_time(found) if guesses.only_grows(first[n]))
    return next(finer, usual_one)


def _check_there(
    table: Table, wanted: Mapping[str, Mapped], units: Mapping[str, str], path: Path
) -> None:
    for mapped in wanted.values():
        for column in mapped.columns:
            if column not in table.names:
                do = f"choose of {listed(table.names, _LISTED)}"
                raise BadRecording(path, f"there is no column {column!r}", do=do)
    missing = [target for target in GYRO if target not in wanted]
    if missing:
        do = f"map it: --map {missing[0]}=COLUMN:UNIT"
        if other := _of_another_sensor(table, path):
            do = f"these are no rates ({other}){_beside(path)}; else {do}"
        elif words := _offered(table, wanted, missing, "gyro" in units):
            do = f"if these are rates: {words}"
        why = f" ({table.notes[0]})" if usual.unnamed(table.names) and table.notes else ""
        taken = ", ".join(f"{name}={wanted[name].column}" for name in COLUMNS if name in wanted)
        beside = f" beside {taken}" if taken else ""
        problem = f"no column for {', '.join(missing)}{beside}{why}"
        raise BadRecording(path, problem, do=f"{do}, {_of(table)}")


def _of_another_sensor(table: Table, path: Path) -> str:
    """What tells that the columns of three axes are another sensor's; empty where nothing does."""
    if usual.of_other_sensor(path.stem):
        return f"the file is called {path.name}"
    three = list(usual.bare_axes(table.names).values())
    if any(map(usual.of_other_unit, three)):
        return f"the unit of {three[0]!r}"
    times = {*usual.in_units_of_time(table.names)}
    others = [name for name in table.names if name not in times]
    if others and all(map(usual.of_other_unit, others)):
        return "the units of all columns"
    named_xyz = [name for name in three if name.lower() not in usual.BODY_RATES.values()]
    alone = named_xyz and not _with_gravity(table)
    if alone and guesses.as_long_as_gravity(list(table.first_rows(three).values())):
        return "they are as long as gravity"
    return ""


def _beside(path: Path) -> str:
    """Where the rates are likely to be."""
    gyro = named_alike(path, (f for f in path.parent.glob("*.csv") if "gyro" in f.stem.lower()))
    if gyro is None:
        return ""
    return f", which are likely in {gyro.name}: {take_both(gyro, path)}"


def named_alike(path: Path, files: Iterable[Path]) -> Path | None:
    """Of other files, maybe of several recordings, that whose name is most like the path's."""
    return max(
        sorted(files), key=lambda f: SequenceMatcher(None, f.stem, path.stem).ratio(), default=None
    )


def take_both(gyro: Path, other: Path) -> str:
    """The command that takes the files of two sensors as one recording."""
    return f"zerorate import {shlex.quote(str(gyro))} {shlex.quote(str(other))} --out FILE.parquet"


def _offered(table: Table, wanted: Mapping[str, Mapped], missing: list[str], known: bool) -> str:
    """A ready mapping of what may be rates, by names or, where nothing names columns, by values."""
    if usual.unnamed(table.names):
        likely = guesses.likely_columns(table) if not set(wanted) - {TIME} else []
        return " ".join(f"--map {shlex.quote(words)}" for words in likely)
    bare = usual.bare_axes(table.names) or _most_like_rates(table, wanted)
    habit = guesses.by_habit("gx", bare["gx"], table.names) if bare and not known else None
    unit = habit[0] if habit else None
    mapped = {t: (c, unit if t in missing else None) for t, c in bare.items() if t not in wanted}
    return " ".join(map_words(t, *of) for t, of in mapped.items())


def _most_like_rates(table: Table, wanted: Mapping[str, Mapped]) -> dict[str, str]:
    """Of columns that only their axes name those by which gravity turns, else the first; where no
    acceleration is known, it is those as long as gravity, if any."""
    taken = {column for mapped in wanted.values() for column in mapped.columns}
    first = table.first_rows(table.names)
    threes = usual.axes_apart([name for name in table.names if name not in taken])
    threes = [t for t in threes if all(len(np.unique(first[name])) > 1 for name in t.values())]
    force = {} if "ax" in wanted else _steadiest_force(threes, first)
    out = {ax: force[gx] for ax, gx in zip(ACCEL, GYRO) if force}
    wanted = {**wanted, **{axis: Mapped(axis, column) for axis, column in out.items()}}
    time = wanted.get(TIME)
    t_s = time.taken(first, TIME_S[guesses.likely_time(first[time.column])]) if time else None

    def left(three: dict[str, str]) -> float:
        rates = {axis: Mapped(axis, column) for axis, column in three.items()}
        size = t_s is not None and guesses.gravity_turned({**wanted, **rates}, first, t_s)
        return size.left if size else 1.0

    rates = min((three for three in threes if three is not force), key=left, default={})
    return {**rates, **out} if rates else {}


def _steadiest_force(
    threes: list[dict[str, str]], first: Mapping[str, np.ndarray]
) -> dict[str, str]:
    """Of columns that are as long as gravity those whose length changes least; empty for none."""
    read = [(three, [first[name] for name in three.values()]) for three in threes]
    forces = [(three, of) for three, of in read if guesses.as_long_as_gravity(of)]
    steadiest = min(
        forces, key=lambda one: guesses.spread(np.linalg.norm(one[1], axis=0)), default=({}, [])
    )
    return steadiest[0]


def divided_by(plan: Plan, kind: str, lsb: float) -> None:
    """Take counts that are wider than 16 bits as readings: the counts over their scale."""
    plan.raw -= {kind}
    for target in plan.wanted:
        if target in COLUMNS and kind_of(target) == kind:
            plan.factors[target] = (1.0 / lsb, 0.0)
    plan.notes.append(f"{kind}: counts of {lsb:g} are wider than 16 bits, and stored coarser")


def hz_words(table: Table) -> str:
    """What to type where nothing is called a time: a column that goes on as one does, or a rate."""
    if table.said_hz:
        return f"--hz {table.said_hz:g} (as the file says)"
    others = [name for name in table.names if name != usual.temperature(table.names)]
    first = {} if usual.unnamed(others) else table.first_rows(others)
    maybe = []
    for name, values in first.items():
        if usual.is_step(name) and np.isfinite(values).any() and np.nanmedian(values) > 0:
            step = float(np.nanmedian(values))
            unit = unit_in_name(TIME, name) or guesses.likely_time(np.array([0.0, step]))
            return f"--hz {1 / (step * TIME_S[unit]):.4g} (as column {name!r} says in {unit})"
        steps = np.diff(values)
        if (
            guesses.only_grows(values)
            and steps.min() > 0
            and guesses.likely_units_of_time(float(np.median(steps)))
        ):
            if not guesses.counts_rows(values) and not guesses.of_long_time(name):
                maybe.append(map_words(TIME, name, guesses.likely_time(values)))
    return " or ".join([*maybe, "--hz, samples a second"])


def left_aside(plan: Plan, table: Table) -> list[str]:
    """Which columns a recording goes without, any of which may hold a cause."""
    aside = [n for n in table.names if n and n not in plan.columns]
    aside = [n for n in aside if n not in usual.time_columns(table.names)]
    if not aside:
        return []
    for parts in usual.attitudes(aside):
        first = table.first_rows(list(parts.values()))
        if guesses.is_unit(np.array([first[parts[name]] for name in ATTITUDE])):
            words = " ".join(map_words(n, parts[n]) for n in ATTITUDE)
            return [f"an attitude left aside; if it turns the body's axes into z up: {words}"]
    return [f"left aside: {listed(aside, _TOLD)}; take one along as --map NAME=COLUMN"]


def _of(table: Table) -> str:
    first = table.first_rows(table.names)
    readable = [name for name in table.names if np.isfinite(first[name]).any()]
    other = [name for name in table.names if name and name not in readable]
    words = f"COLUMN one of {listed(readable or table.names, _LISTED)}"
    return words + (f"; {listed(other, _TOLD)}: no number alone in a cell" if other else "")


def _as_another_time(column: str, table: Table) -> tuple[str, str] | None:
    """(unit, that other one) of a time beside which another goes on, whose name says its unit."""
    for other in usual.in_units_of_time(table.names):
        first = table.first_rows([column, other]) if other != column else {}
        both = np.isfinite(list(first.values())).all(axis=0)
        spans = [
            np.ptp(values[both]) for values in first.values() if guesses.only_grows(values[both])
        ]
        if len(spans) == 2 and all(spans):
            theirs = TIME_S[unit_in_name(TIME, other) or "s"]
            off = {u: abs(np.log(spans[0] * s / (spans[1] * theirs))) for u, s in TIME_S.items()}
            unit = min(off, key=off.__getitem__)
            if off[unit] < _ONE_TIME:
                return unit, other
    return None


def _unit(
    target: str,
    plan: Plan,
    table: Table,
    units: Mapping[str, str],
    first: dict[str, np.ndarray],
    path: Path,
    t_s: np.ndarray | None,
) -> str | None:
    """t_s: times of the first rows, where they are known. Raises BadRecording."""
    mapped = plan.wanted[target]
    if mapped.column in table.calendar:
        return "s"
    kind = kind_of(target)
    unit = mapped.unit or unit_in_name(target, mapped.column) or units.get(kind)
    other = other_unit(mapped.column) if unit is None and target in (*GYRO, *ACCEL) else None
    if other is not None:
        base = "dps" if target in GYRO else "g"
        do = f"give each axis by --map {target}=COLUMN:xSIZE; SIZE is how many {base} one is"
        problem = f"the unit {other!r} of column {mapped.column!r} is not known"
        raise BadRecording(path, problem, do=do)
    if unit is None:
        another = _as_another_time(mapped.column, table) if target == TIME else None
        unit, why = another or guesses.guessed_unit(target, plan.wanted, table.names, first, t_s)
        why = f"it goes on as {why!r}" if another else why
        note = f"{kind} taken in {unit}: {why}"
        if unit is not None and note not in plan.notes:
            plan.notes.append(note)
    elif unit not in units_of(target):
        problem = f"the unit of column {mapped.column!r} cannot be {unit!r}"
        raise BadRecording(path, problem, do=f"name one of {', '.join(units_of(target))}")
    return unit
