"""What single steps of an import say of rows drawn by a seed: mostly usual ones, with an oddity now
and then that lies beside a limit."""

from itertools import product
from pathlib import Path
from types import SimpleNamespace

import numpy as np
from zerorate_tools.errors import ZerorateError
from zerorate_tools.importers.columns import guesses
from zerorate_tools.importers.columns.mapping import Mapped
from zerorate_tools.importers.columns.plan import Plan
from zerorate_tools.importers.columns.units import (
    _LSB_PER_DPS,
    ACCEL_G,
    RATE_DPS,
    STANDARD_GRAVITY,
    unit_by_steps,
)
from zerorate_tools.importers.samples import clock, doubts, one_device
from zerorate_tools.importers.tables.table import Chunk, Table
from zerorate_tools.recordings import Scales
from zerorate_tools.recordings.recording import ACCEL, GYRO
from zerorate_tools.recordings.turning import Size

from .import_corpus import told

PATH = Path("log.csv")
#: Of times: a step and a beginning, in any unit; sizes of forces and of rates; of what stays.
_STEPS = (1e-4, 9e-5, 0.01, 0.1, 0.11, 10.0, 1e5, 1e7, 50.0, 0.0)
_BEGINS = (0.0, 0.0, 1e9, 1.7e9, 4.1e9, 1.7e12, 1.7e18)
_FORCES = (1.0, STANDARD_GRAVITY, 1000.0, 0.85, 0.86, 1.149, 1.16, 3.0, 16384.0)
_RATES = (0.01, 0.5, 30.0, 1400.0, 2040.0, 2060.0, 9000.0)
_CONSTANTS = (0.0, 1.0, 0.5, -3.0)


def mostly(luck, usual, *others):
    """The usual value, or now and then one of the others."""
    return usual if luck.random() < 0.8 else others[luck.integers(len(others))]


def attempt(step, *of):
    """What a step says, or why it refuses: figures and what to type."""
    try:
        return " ".join(told(str(step(*of))))
    except (ZerorateError, ValueError) as error:
        return " ".join(["no:", *told(str(error))])


def _three(luck, rows):
    """Three columns of a force or of rates, of one size, whole numbers or not."""
    if luck.random() < 0.5:
        along = luck.normal(0, 1, (3, 1))
        noise = luck.normal(0, 0.003, (3, rows))
        return luck.choice(_FORCES) * (along / np.linalg.norm(along) + noise)
    rates = luck.choice(_RATES) * (1 + luck.choice([0.001, 0.3]) * luck.normal(0, 1, (3, rows)))
    return np.rint(rates) if luck.random() < 0.3 else rates


def _columns(luck):
    """Columns in any order, as logs have them that name none."""
    rows = int(luck.choice([2, 3, 5, 40, 60]))
    time = luck.choice(_BEGINS) + luck.choice(_STEPS) * (np.arange(rows) // luck.choice([1, 1, 2]))
    turn = np.linspace(0, 1, rows)
    four = np.array([np.sin(turn), np.cos(turn), 0 * turn, 0 * turn])
    kinds = [[time], _three(luck, rows), _three(luck, rows)]
    kinds += [four * luck.choice([1.0, 1.0001, 1.0002]), [luck.normal(20, 9, rows)]]
    kinds += [[np.full(rows, luck.choice(_CONSTANTS))]]
    chosen = luck.permutation(mostly(luck, 3, 6))[: luck.integers(2, 7)]
    values = [column.copy() for kind in chosen for column in kinds[kind]]
    if luck.random() < 0.3:
        values[0][luck.random(rows) < luck.choice([0.1, 0.5, 0.6])] = np.nan
    return {chr(97 + at): column for at, column in enumerate(values)}


def columns():
    """Which columns are what where nothing names them."""
    luck, said = np.random.default_rng(1), []
    for _ in range(500):
        first = _columns(luck)
        calendar = frozenset(n for n in first if luck.random() < 0.05)
        said.append(_likely(first, calendar))
    for _ in range(20):
        first = _turning(luck)
        first |= dict(zip("abc", luck.normal(0, 0.5, (3, 1500))))
        order = mostly(luck, "abc", (), ACCEL), GYRO, ACCEL, mostly(luck, ("t_us",), ()), "abc"
        names = dict.fromkeys(n for group in order for n in group if n in first)
        said.append(_likely({n: first[n] for n in names}))
    return {"columns": [one for one in said if one], "none": [said.count("")]}


def _likely(first, calendar=frozenset()):
    chunks = [Chunk(np.arange(len(next(iter(first.values())))), first)]
    return " ".join(guesses.likely_columns(Table([*first], lambda _: chunks, calendar=calendar)))


def _turning(luck, rows=1500):
    """Columns of a device that may turn, in any units, by the names of a recording."""
    turn = luck.choice([0.0, 1.0, 0.2]) * np.sin(np.arange(rows) * 0.04 + luck.random())
    force, lsb = luck.choice(_FORCES), RATE_DPS[luck.choice([*RATE_DPS])]
    first = dict.fromkeys(("ax", "gy", "gz"), 0.001 * luck.normal(0, 1, rows))
    first["gx"] = np.degrees(np.gradient(turn, 0.02)) / lsb
    if luck.random() < 0.3:
        first |= {n: np.rint(first[n] * luck.choice([1, 4, 131])) for n in GYRO}
    first |= {"ay": force * np.sin(turn), "az": force * np.cos(turn)}
    first["t_us"] = luck.choice(_BEGINS) + luck.choice(_STEPS) * np.arange(rows)
    first["temp"] = luck.choice([20, 135, 225, 300, -65]) + luck.normal(0, 4, rows).round(1)
    for name in first:
        lacks = luck.random(rows) < luck.choice([0, 0, 0.003])
        first[name] = np.where(lacks, np.nan, first[name])
    return {n: v for n, v in first.items() if n[0] != "a" or force != 3.0}


def units():
    """In which unit columns are, and what is offered to type."""
    luck, guessed, offered = np.random.default_rng(9), [], []
    for _ in range(120):
        first = _turning(luck)
        names = {n: mostly(luck, n, n, f"{n} min") for n in first}
        units_of = {n: luck.choice(["lsb", "m/s2", "g"]) if n in ACCEL else None for n in first}
        wanted = {n: Mapped(n, names[n], mostly(luck, None, units_of[n])) for n in first}
        first = {names[n]: values for n, values in first.items()}
        t_s = np.arange(1500) * 0.02 if luck.random() < 0.7 else None
        for target in luck.permutation([*wanted])[:3]:
            unit, why = guesses.guessed_unit(target, wanted, [*first], first, t_s)
            guessed.append(" ".join([str(unit), *told(why)]))
            offered.append(" ".join(told(guesses.ready_words(target, wanted, first))))
    counts = luck.integers(-99, 99, 400)
    lsb = [*_LSB_PER_DPS.ravel() ** -1.0, 0.15, 0.25, *np.geomspace(1e-6, 10, 30)]
    scaled = [(unit, one / of * off) for one in lsb for unit, of in RATE_DPS.items()
              for off in (1.0, 1.002, 0.996)]  # fmt: skip
    steps = [f"{unit} {unit_by_steps(counts * step)}" for unit, step in scaled]
    for off, number in product((0.0, 0.04, 0.06), (9, 16, 17, 18, 60)):
        rates = (
            1 / 131 * (np.arange(number) * luck.choice([1, 7, 9]) + off * np.sin(np.arange(number)))
        )
        steps.append(str(unit_by_steps(np.append(rates, luck.choice([np.nan, 1e3])))))
    sizes = product(np.geomspace(3e-4, 300, 25), (1.4, 4.1), (1.0, 57.3))
    rated = [guesses.rate_unit_of(Size(one, one / 1.4, one * most), by) for one, most, by in sizes]
    steps += [str(unit) for unit in rated]
    return {"guessed": guessed, "offered": offered, "steps": [" ".join(steps)]}


def _stamps(luck):
    """Microseconds of a clock that may run over, some of which are torn; and the usual step."""
    rows = luck.choice([1, 2, 3, 40, 1000, 1100, 2100])
    every = luck.choice([1e4, 1e6, 1e6 / 3, 4e5])
    t_us = every * np.cumsum(luck.choice([0, 1, 1, 1, 2, 4], rows))
    holds = luck.choice([2.0**30, 2.0**31, 2.0**32, 86_400e6, 3e9, 2.0**30 * 1e3])
    return (t_us + holds - luck.random() * t_us[-1]) % holds, every


def _clock(luck):
    """(numbers, what is said) of the stamps of a clock."""
    t_us, every = _stamps(luck)
    place, torn = 7 + np.arange(len(t_us)), t_us.copy()
    some = luck.integers(0, len(t_us), luck.choice([0, 1, 1, 2, 12]))
    torn[some] += luck.choice([1, -1]) * luck.choice([9e6, 1e7, 1.1e7, 1e9])
    unwrapped = clock.Unwrapped(luck.choice([0.0, 1.0, 1e3]))
    pace, gaps = clock.Pace(), clock.Gaps(every)
    parts = np.split(np.arange(len(t_us)), [max(1, luck.integers(len(t_us)))])
    out = [unwrapped(t_us[at], place[at]) for at in parts if len(at)]
    for part in out:
        pace.add(part)
        gaps.add(part)
    ticks, out = clock.Ticks(np.sort(t_us)), np.concatenate(out)
    numbers = [(~clock.whole_stamps(torn) * place).sum(), out.mean(), pace.mean_us, len(pace.first)]
    numbers += [gaps.longest_us, gaps.count, ticks.coarse, ticks.tick_us, ticks.sample_us]
    said = [
        attempt(pace.interval_us, PATH),
        " ".join(told(" ".join([*unwrapped.notes, *gaps.note()]))),
    ]
    return numbers, [*said, attempt(clock.refuse_impossible, out * 2.0**30, place, PATH)]


def stamps():
    """What is made of time stamps."""
    luck = np.random.default_rng(2)
    every = [_clock(luck) for _ in range(100)]
    numbers = [float(n) for of, _ in every for n in of]
    return {"stamps": numbers, "said of stamps": [" ".join(said) for _, said in every]}


def _in_turn(luck):
    """How many devices wrote rows that are one after the other's, by their times and levels."""
    of = int(luck.integers(1, 11))
    row = np.arange(mostly(luck, 500, 59, 60, 119, 240) + of)
    behind = mostly(luck, 3e6, 0.0, 5e3, 1e4, 1.1e4) * luck.permutation(of)[row % of]
    t_us = row // of * 1e4 + behind + mostly(luck, 0.0, 3e3, 3e4) * luck.random(len(row))
    levels = mostly(luck, 5.0, 0.0, 0.7, 1.5) * luck.permutation(of)[row % of]
    rates = levels[:, None] + luck.normal(0, mostly(luck, 0.5, 0.0), (len(row), 3)) + 1
    rates[:, 0] += mostly(luck, 0.0, 0.1, 10.0) * row
    rates = mostly(luck, rates, 1e6 + 0.01 * np.rint(levels[:, None]) + np.zeros((len(row), 3)))
    rates[luck.integers(len(row))] *= mostly(luck, 1.0, np.nan)
    pieces = np.split(rates, [luck.integers(0, len(row))])
    return one_device.clocks_in_turn(t_us), one_device.levels_in_turn(pieces)


def _changed(luck, rows=700):
    """Readings that change at some row, by a unit or nearly so."""
    at = mostly(luck, 300, 99, 100, 101, 599, 600, 601)
    sizes, axes = ((RATE_DPS, slice(3)), (ACCEL_G, slice(3, 6)))[luck.integers(2)]
    sizes = [*sizes.values()]
    by = mostly(luck, sizes[0], sizes[1]) / luck.choice(sizes[1:]) * mostly(luck, 1, 1.2, 1.45)
    quiet = np.repeat([[0.01], [0.001]], 3, axis=0) * mostly(luck, 1, 0, 5)
    noise = np.tile(luck.normal(0, quiet, (6, 100)), 7)
    values = np.array([[0.5], [0.4], [0.6], [0.1], [-0.2], [0.97]]) + noise
    louder = mostly(luck, 1, 1 / 1.38, 1 / 1.42, 1.38, 1.42)
    values[axes, at:] += mostly(luck, 0, 0.003, 0.006, 0.4) + noise[axes, at:] * (louder - 1)
    values[5, at:] += mostly(luck, 0, 0.018, 0.022)
    by **= luck.choice([1, -1])
    values[axes] *= mostly(
        luck, np.where(np.arange(rows) < at, 1, by), by ** np.linspace(0, 1, rows)
    )
    values[:, 350] *= mostly(luck, 1.0, 0.0, np.nan)
    return dict(zip((*GYRO, *ACCEL), values[: mostly(luck, 6, 5)]))


def _change(luck):
    """What is said of a change of unit, and how often the table counts what it leaves out."""
    columns, cut = _changed(luck), mostly(luck, 0, 0, 150, 450)

    def chunks(wanted):
        for part in (slice(cut), slice(cut, None)):
            table.dropped["read"] += 1
            yield Chunk(5 + np.arange(700)[part], {n: v[part] for n, v in columns.items()})

    table = Table(list(columns), chunks)
    plan = Plan({n: Mapped(n, n) for n in columns}, dict.fromkeys(columns, (1.0, 0.0)))
    said = attempt(one_device.refuse_change_of_unit, [columns], plan, table, PATH)
    return f"{said} {len(table.dropped)}"


def devices():
    """How many devices take turns, and whether a unit changes."""
    luck = np.random.default_rng(3)
    found = [float(number) for _ in range(150) for number in _in_turn(luck)]
    found += [factor for sizes in (RATE_DPS, ACCEL_G) for factor in one_device._factors(sizes)]
    return {"in turn": found, "changes": [_change(luck) for _ in range(250)]}


def _seen(luck):
    """What an import saw of a rest, or of a device that turns, and how many a second."""
    hz, turns = mostly(luck, 100.0, 1.0, 4.9, 5.1, 500.0, 39e3, 41e3), luck.random() < 0.06
    rows = 1800 if turns else mostly(luck, 400, 150, 199, 200, 1200)
    along = np.linspace(-1, 1, rows)
    noise = luck.choice([0.05, 0.05, 0.0, 1e-3, 1.6e-3, 0.64, 0.8, 0.8, 4.0])
    turn = 0.6 * turns * np.sin(np.arange(rows) * 0.04)
    rates = luck.normal(0, noise, (3, rows)) + [[mostly(luck, 0.5, 24.0, 26.0, -40.0)], [0], [0]]
    rates[0] += np.degrees(np.gradient(turn)) * hz * mostly(luck, 1.0, 0.5, 0.7, 57.3, 1 / 57.3)
    rates = rates[luck.permutation(3) if luck.random() < 0.1 else slice(None)]
    rates[1] += mostly(luck, 0.0, 2.6, 4.0) * along
    length = mostly(luck, 1.0, 0.79, 0.81, 1.24, 1.26, 2.0, 7.8, 8.0, 9.8, 11.7, 12.1, 1e-3, 1e3)
    force = length * np.array([0 * turn, np.sin(turn), np.cos(turn)])
    force *= 1 + mostly(luck, 0.0, 0.09, 0.11, 0.4) * along
    force += luck.normal(0, mostly(luck, 0.004, 0.019, 0.023), (3, rows)) / 0.954
    seen = dict(zip((*GYRO, *ACCEL), [*rates, *force]), t_us=np.arange(rows) * 1e6 / hz)
    seen["temp"] = mostly(luck, 25.0, 0.0, -61.0, -59.0, 129.0, 131.0) + np.zeros(rows)
    seen["level"] = np.arange(rows) * mostly(luck, 7.0, 0.07, 0.007, 0.0)
    without = mostly(luck, (), ACCEL, ("temp",))
    return {n: v for n, v in seen.items() if n not in without}, hz


def _doubted(luck):
    """What is doubted or refused of what an import saw."""
    seen, hz = _seen(luck)
    wanted = {n: Mapped(n, f"c_{n}", "x1" if n == "level" and luck.random() < 0.2 else None)
              for n in seen}  # fmt: skip
    factors = dict.fromkeys(seen, (luck.choice([1.0, 57.3, 0.001], p=[0.45, 0.45, 0.1]), 0.0))
    factors["t_us"] = (mostly(luck, 1.0, 1e-3), 0.0)
    plan = Plan(wanted, factors, by_format=luck.random() < 0.05)
    plan.raw = frozenset(kind for kind in ("gyro", "accel", "temp") if luck.random() < 0.05)
    plan.typed = frozenset({"gyro"} if luck.random() < 0.2 else ())
    rows = len(seen["t_us"])
    found = SimpleNamespace(looked_at=seen, interval_us=1e6 / hz, samples=rows, rows=rows)
    found.dropped = {"why": int(rows * mostly(luck, 0.0, 0.049, 0.051))}
    found.counted = luck.random() < 0.2
    scales = Scales("X", hz, mostly(luck, 1.0, 131.0), mostly(luck, 1.0, 8192.0), 340.0, 0.0)
    return attempt(doubts.doubts, found, plan, scales, PATH)


def doubted():
    """What is doubted or refused of samples, and of how they warm."""
    luck = np.random.default_rng(5)
    said = [_doubted(luck) for _ in range(700)]
    warmed = []
    for changed, rows, span_us in product((3.3, 2.9), (7, 8, 100), (1e6, 3.1e6, 3.2e6)):
        temp = np.linspace(20, 20 + changed, rows)
        warmed += [attempt(doubts.of_time, temp, span_us, counted) for counted in (0, 1)]
    return {"doubts": [one for one in said if one], "none": [said.count("")], "warmed": warmed}


STEPS = {f"imported {of.__name__}": of for of in (columns, units, stamps, devices, doubted)}
