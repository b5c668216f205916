"""Units that the readings themselves tell, and the words that name one where they do not."""

import re
from collections.abc import Mapping

import numpy as np

from ...recordings.recording import ACCEL, GYRO, TEMP, TIME
from ...recordings.turning import Size, dps_of_one, turn_too_far
from ..tables.table import Table
from .mapping import Mapped, map_words
from .names import spelled
from .units import ACCEL_G, RATE_DPS, RAW, TIME_S, factors_of, kind_of, unit_by_steps, unit_in_name

GRAVITY = {unit: 1.0 / in_g for unit, in_g in ACCEL_G.items()}
_GRAVITY_WITHIN = 0.15
#: Rows whose mean is a force without what shakes.
_AT_ONCE = 4
#: Seconds since 1970 of the years 2001 and 2100, which a counter since power-on may be, too: by its
#: steps, which are as short as a second or so in a date.
_CALENDAR_S, _STEP_OF_DATE_S = (1e9, 4.1e9), 1.5
DEGC, _KELVIN = (-60.0, 130.0), (230.0, 400.0)
#: A room's 18 degC in degF: so many degC are as rare as a die that is no warmer.
_MAYBE_DEGF = 65.0
#: The widest range of these sensors, and a little.
FASTEST_DPS = 2050.0
#: More is no bias of a sound sensor, and what spreads by so small a share is steady.
BIAS_DPS, STEADY = 25.0, 0.2
#: So near to one is the squared length of a quaternion that was rounded.
_OF_ONE = 3e-4
#: Rates at which anyone records, Hz.
_LIKELY_HZ = (0.02, 40_000.0)
#: Names of times in none of the units that a recording may have.
_LONG_TIME = re.compile("min|hour|hr|day")
_OTHER_TIME = re.compile(f"{_LONG_TIME.pattern}|frame|tick|count")
_TOGETHER = 64
_PER_HOUR = re.compile(r"(?:deg|°)\w*\s*(?:/|per)\s*h")
#: Who writes the symbol of angular velocity means its SI unit.
_OMEGA = re.compile("omega|w[xyz]$")
#: Where no time is known; of 25 Hz or 400 Hz rates in their usual units still have a size.
_ANY_HZ = 20.0
#: Of such sizes in dps are counts of gyroscopes, and means of counts; and so is mrad/s.
_COUNTS_DPS, _AS_COUNTS = (0.002, 0.4), "mrad/s"


def guessed_unit(
    target: str,
    wanted: Mapping[str, Mapped],
    names: list[str],
    first: Mapping[str, np.ndarray],
    t_s: np.ndarray | None = None,
) -> tuple[str | None, str]:
    """(unit, why) of a column whose unit nobody named; (None, "") where nothing tells it.

    first: the first rows of the columns wanted; t_s: their times, where known.
    """
    column = wanted[target].column
    turned = _by_turning(wanted, first, t_s) if target in GYRO and t_s is not None else None
    if turned is not None:
        return turned, "gravity turns with it"
    axes = [wanted[axis].column for axis in GYRO if axis in wanted] if target in GYRO else []
    stepped = {unit for axis in axes if (unit := unit_by_steps(first[axis]))}
    if len(stepped) == 1:
        return stepped.pop(), "its steps are those of a chip"
    habit = by_habit(target, column, names)
    if habit is not None:
        return habit
    values = first[column][np.isfinite(first[column])]
    if not len(values):
        return None, ""
    if target == TIME:
        by_date = _by_calendar(values)
        return by_date if by_date[0] else _by_pace(column, wanted, first)
    if target == TEMP:
        return _by_range(values)
    if target in ACCEL:
        return _by_gravity(wanted, first)
    return None, ""


def _by_turning(
    wanted: Mapping[str, Mapped], first: Mapping[str, np.ndarray], t_s: np.ndarray
) -> str | None:
    """The unit of rates in which they turn gravity as it is seen to turn."""
    size = gravity_turned(wanted, first, t_s)
    if size is None:
        return None
    rates = np.array([first[wanted[axis].column] for axis in GYRO])
    if are_whole(*rates) and _COUNTS_DPS[0] < size.dps < _COUNTS_DPS[1]:
        return None
    unit = rate_unit_of(size)
    return None if unit == _AS_COUNTS else unit


def gravity_turned(
    wanted: Mapping[str, Mapped], first: Mapping[str, np.ndarray], t_s: np.ndarray
) -> Size | None:
    """The size of rates by which they turn gravity, if both are there and it tells."""
    if not all(axis in wanted for axis in (*GYRO, *ACCEL)):
        return None
    rates, force = (np.array([first[wanted[n].column] for n in axes]) for axes in (GYRO, ACCEL))
    return dps_of_one(rates, force, t_s)


def rate_unit_of(size: Size, factor: float = 1.0) -> str | None:
    """The unit of rates that may have that size, times a factor; no two are so near each other."""
    may_be = (u for u, one in RATE_DPS.items() if size.least < one / factor < size.most)
    return next(may_be, None)


def less_than_turns(rates: np.ndarray, force: np.ndarray, t_s: np.ndarray, unit: str) -> str | None:
    """The largest unit up to one in which rates do not turn further than gravity lets them."""
    smaller = (u for u in ("rad/s", "dps", "mrad/s", "mdps") if RATE_DPS[u] <= RATE_DPS[unit])
    return next((u for u in smaller if not turn_too_far(rates * RATE_DPS[u], force, t_s)), None)


def ready_words(
    target: str,
    wanted: Mapping[str, Mapped],
    first: Mapping[str, np.ndarray],
    t_s: np.ndarray | None = None,
) -> str:
    """What to type for a unit that nothing tells."""
    if target == TIME:
        return _time_words(first[wanted[target].column])
    if target in GYRO and _PER_HOUR.search(wanted[target].column.lower()):
        return "deg/s instead: divide them by 3600 and call them dps"
    unit = _likely(target, wanted, first)
    if unit in RATE_DPS and t_s is not None and "ax" in wanted:
        rates, force = (np.array([first[wanted[n].column] for n in axes]) for axes in (GYRO, ACCEL))
        unit = less_than_turns(rates, force, t_s, unit) or unit
    others = ", ".join(u for u in (*factors_of(target), "lsb") if u != unit and u != "c")
    left_out = ", or leave it out: --map temp=none" if target == TEMP else ""
    return f"{unit_words(wanted, target, unit)} (or {others}){left_out}"


def unit_words(wanted: Mapping[str, Mapped], target: str, unit: str) -> str:
    """What to type so that a column and its fellows on other axes are taken in `unit`."""
    axes = next((axes for axes in (GYRO, ACCEL) if target in axes), (target,))
    fellows = [wanted[axis] for axis in axes if axis in wanted]
    if any(one.unit or unit_in_name(one.target, one.column) for one in fellows):
        return " ".join(map_words(one.target, one.column, unit) for one in fellows)
    return f"--{kind_of(target)}-unit {unit}"


def likely_columns(table: Table) -> list[str]:
    """Words as of --map for columns that nothing names: what only grows is time, three whose length
    stays about gravity are acceleration, the next three are rates; [] where there are no three, or
    where without gravity there are more. Words, numbers of a kind and quaternions are neither."""
    first = table.first_rows([name for name in table.names if name not in table.words])
    values = {n: v for n, v in first.items() if 2 * np.isfinite(v).sum() > len(v)}
    whole = np.isfinite(list(values.values())).all(axis=0)
    if not whole.any():
        return []
    values = {name: column[whole] for name, column in values.items()}
    times = [name for name in values if name in table.calendar]
    times += [name for name in values if name not in times and only_grows(values[name])]
    time = next((name for name in times if not counts_rows(values[name])), None)
    out = [] if time is None else [f"t_us={time}:{likely_time(values[time])}"]
    rest = {n: v for n, v in values.items() if n not in times}
    moving = {name: column for name, column in rest.items() if np.ptp(column) > 0}
    if len(moving) >= len(GYRO):
        rest = moving  # what never changes is a covariance or a setting then
    else:  # nor is one whole number throughout a reading: that of a sensor or of a kind of line
        rest = {n: v for n, v in rest.items() if n in moving or len(v) < 2 or v[0] % 1 or not v[0]}
    four = _quaternion(rest)
    rest = {name: column for name, column in rest.items() if name not in four}
    t_s = np.arange(whole.sum()) / _ANY_HZ
    if time is not None:
        t_s = (values[time] - values[time][0]) * TIME_S[likely_time(values[time])]
    accel, unit, gyro = _by_values(rest, table.names, t_s)
    usual = max((abs(float(np.median(values[name]))) for name in gyro), default=0.0)
    if not gyro or unit in RATE_DPS and usual * RATE_DPS[unit] > FASTEST_DPS:
        return []
    behind = f":{unit}" if unit else ""
    return out + accel + [f"{axis}={name}{behind}" for axis, name in zip(GYRO, gyro)]


def _by_values(
    values: Mapping[str, np.ndarray], order: list[str], t_s: np.ndarray
) -> tuple[list[str], str, list[str]]:
    """Words for three columns as long as gravity, the unit of the rates, and which may be rates:
    those that explain best how gravity turns, else the first behind.

    order: of all columns; three go together only where they are beside each other.
    """
    names = list(values)
    threes = [names[at : at + 3] for at in range(len(names) - 2)]
    coarse = [n for n in names if are_whole(values[n])]
    fine = [_beside(t, order) and not {*t} <= {*coarse} for t in threes]
    units = [gravity_unit([values[n] for n in t]) if ok else None for t, ok in zip(threes, fine)]
    # 9.8 is met by chance more rarely than 1
    unit = next((unit for unit in ("m/s2", "g") if unit in units), None)
    if unit is None:
        every = np.array(list(values.values()))
        counted = are_whole(*every) or np.abs(np.median(every, axis=1)).max() > FASTEST_DPS
        three = len(names) == len(GYRO) and not as_long_as_gravity([*every])
        return [], RAW if counted else "", names if three else []
    lengths = [np.linalg.norm([values[name] for name in three], axis=0) for three in threes]
    found = [number for number, of in enumerate(units) if of == unit]
    room = ((n, (*range(n - 2), *range(n + 3, len(threes)))) for n in found)
    # three that leave three others: one axis with gravity is as long with any two
    at = next((n for n, rest in room if any(_beside(threes[m], order) for m in rest)), found[0])
    for number in found:  # a bias may be as long by chance, and is not as steady
        steadier = 2 * spread(lengths[number]) < spread(lengths[at])
        at = number if steadier and number >= at + len(GYRO) else at
    accel = [f"{axis}={name}:{unit}" for axis, name in zip(ACCEL, names[at : at + 3])]
    rate_unit = "rad/s" if unit == "m/s2" else "dps"
    others = [n for n in (*range(at + 3, len(threes)), *range(at - 2)) if _beside(threes[n], order)]
    others = [n for n in others if not _is_field(lengths[n], RATE_DPS[rate_unit])]
    force = np.array([values[name] for name in names[at : at + 3]])
    told = {n: dps_of_one(np.array([values[m] for m in threes[n]]), force, t_s) for n in others}
    rates = min(others, key=lambda n: size.left if (size := told[n]) else 1.0, default=None)
    return accel, rate_unit, [] if rates is None else threes[rates]


def spread(lengths: np.ndarray) -> float:
    """How wide the middle half of lengths is, as a share of the usual one."""
    low, usual, high = np.quantile(lengths, [0.25, 0.5, 0.75])
    return float((high - low) / usual) if usual else np.inf


def _is_field(lengths: np.ndarray, dps: float) -> bool:
    """Whether columns are always as long, and longer than a bias: as the earth's field is."""
    return spread(lengths) < STEADY and float(np.median(lengths)) * dps > BIAS_DPS


def _beside(names: list[str], order: list[str]) -> bool:
    return order.index(names[-1]) - order.index(names[0]) == len(names) - 1


def _quaternion(values: Mapping[str, np.ndarray]) -> list[str]:
    """Four columns beside each other whose length is always one, where it is known; or none."""
    names = list(values)
    for at in range(len(names) - 3):
        four = np.array([values[name] for name in names[at : at + 4]])
        if is_unit(four):
            return names[at : at + 4]
    return []


def is_unit(four: np.ndarray) -> bool:
    """Whether the parts (4, n) are of unit quaternions; all 0, or without a value, is not seen."""
    squares = (four**2).sum(axis=0)
    squares = squares[np.isfinite(squares) & (squares > 0)]
    # between two frames a straight line is shorter, the more so the faster the turn
    return len(squares) > 1 and bool(np.quantile(np.abs(squares - 1.0), 0.9) < _OF_ONE)


def are_whole(*columns: np.ndarray) -> bool:
    """Whether all readings are whole numbers, as counts are."""
    return all((values[np.isfinite(values)] % 1 == 0).all() for values in columns)


def only_grows(values: np.ndarray) -> bool:
    """Whether a column goes on from row to row, as times do."""
    steps = np.diff(values)
    forward, back = np.sum(steps > 0), np.sum(~(steps >= 0))
    return bool(1000 * back < len(steps) < 2 * forward)


def are_digits_of_clock(values: np.ndarray) -> bool:
    """Whether numbers are a clock's hours, minutes and seconds, as 141759.5: where a minute ends,
    they go on by 40 too many."""
    values = values[np.isfinite(values)]
    steps = np.diff(values)
    too_many = steps[1:] - np.median(steps) if len(steps) else steps
    at_end = np.abs(too_many % 4000 - 40.0) < 1.0
    return bool((values % 100 < 60).all() and at_end.any() and (at_end | (steps[1:] < 30)).all())


def counts_rows(values: np.ndarray) -> bool:
    """Whether each is one more than the one before."""
    return len(values) > 1 and bool((np.diff(values) == 1).all())


def likely_time(values: np.ndarray) -> str:
    step = float(np.median(np.diff(values))) if len(values) > 1 else 0.0
    by_date = _by_calendar(values)[0]
    return by_date or next((u for u, s in TIME_S.items() if 1e-4 <= step * s <= 0.1), "s")


def by_habit(target: str, column: str, names: list[str]) -> tuple[str, str] | None:
    """Units that go with names: those of ROS, ArduPilot, PX4, Android, CoreMotion, SparkFun."""
    text, kind = spelled(column), kind_of(target)
    habit = {"gyro": "rad/s", "accel": "m/s2", "time": "ns"}.get(kind)
    if habit is None:
        return None
    if kind != "time" and any(w in text for w in ("angularvelocity", "linearacceleration")):
        return habit, "as in ROS"
    if "seconds_elapsed" in names:
        return habit, "as Sensor Logger writes"
    if kind == "gyro" and text.endswith("beta"):
        return "dps", "as browsers write"
    if kind == "gyro" and any("useracceleration" in spelled(name) for name in names):
        return habit, "as CoreMotion writes"
    if "rtcTime" in names and kind != "time":
        return ("dps" if kind == "gyro" else "mg"), "as OpenLog Artemis writes"
    if "timestamp_sample" in names or {"device_id", "error_count"} <= set(names):
        return ("us" if kind == "time" else habit), "as PX4 writes"
    if "TimeUS" in names and kind != "time":
        return habit, "as in ArduPilot"
    return None


def _by_calendar(values: np.ndarray) -> tuple[str | None, str]:
    middle, step = float(np.median(values)), _usual_step(values)
    for unit, seconds in TIME_S.items():
        is_date = _CALENDAR_S[0] < middle * seconds < _CALENDAR_S[1]
        if is_date and step * seconds <= _STEP_OF_DATE_S:
            year = np.datetime64(int(middle * seconds), "s").astype("datetime64[Y]")
            return unit, f"since 1970 that is the year {year}"
    return None, ""


def _by_range(values: np.ndarray) -> tuple[str | None, str]:
    least, usual, most = np.quantile(values, [0.02, 0.5, 0.98])
    is_degc = DEGC[0] <= least and most <= DEGC[1] and usual < _MAYBE_DEGF
    if is_degc or _KELVIN[0] <= least and most <= _KELVIN[1] and not are_whole(values):
        return "degc" if is_degc else "k", f"it is around {usual:.4g}"
    return None, ""


def _by_gravity(
    wanted: Mapping[str, Mapped], first: Mapping[str, np.ndarray]
) -> tuple[str | None, str]:
    columns = [first[wanted[axis].column] for axis in ACCEL]
    unit = gravity_unit(columns)
    return unit, f"its usual length is {_usual_length(columns):.4g}" if unit else ""


def as_long_as_gravity(columns: list[np.ndarray]) -> bool:
    """Whether that is so in a unit, or in counts of +-2, 4 or 8 g, which no bias is as large as."""
    counted = _usual_length(columns) / np.array([16384.0, 8192.0, 4096.0])
    near = bool((np.abs(counted - 1.0) < _GRAVITY_WITHIN).any())
    return near or gravity_unit(columns) is not None


def turns_as_gravity(columns: list[np.ndarray]) -> bool:
    """Whether three columns keep their length while their direction changes widely."""
    known = np.array(columns)[:, np.isfinite(columns).all(axis=0)]
    lengths = np.linalg.norm(known, axis=0)
    if not len(lengths):
        return False
    low, high = np.quantile([lengths, *known], [0.05, 0.95], axis=1)
    widths = (high - low) / np.median(lengths)
    return bool(widths[0] < STEADY and widths[1:].max() > 0.5)


def gravity_unit(columns: list[np.ndarray]) -> str | None:
    """The unit in which three columns are as long as gravity, or their means over some rows: what
    shakes a drone makes the force longer, and averages out."""
    whole = len(columns[0]) // _AT_ONCE * _AT_ONCE
    means = np.array(columns)[:, :whole].reshape(len(columns), -1, _AT_ONCE).mean(axis=2)
    lengths = (_usual_length(columns), _usual_length([*means]))
    near = (u for n in lengths for u, g in GRAVITY.items() if abs(n / g - 1.0) < _GRAVITY_WITHIN)
    return next(near, None)


def _usual_length(columns: list[np.ndarray]) -> float:
    force = np.linalg.norm(columns, axis=0)
    force = force[np.isfinite(force)]
    return float(np.median(force)) if len(force) else 0.0


def _likely(target: str, wanted: Mapping[str, Mapped], first: Mapping[str, np.ndarray]) -> str:
    values = first[wanted[target].column]
    values = values[np.isfinite(values)]
    counted = bool(len(values)) and are_whole(values)
    if target == TEMP:
        return "lsb" if counted else "degc"
    omega = target in GYRO and not counted and _OMEGA.match(spelled(wanted[target].column))
    if not all(axis in wanted for axis in ACCEL):
        return "rad/s" if omega else "dps" if target in GYRO else "m/s2"
    unit = wanted["ax"].unit or unit_in_name("ax", wanted["ax"].column)
    unit = unit or _by_gravity(wanted, first)[0]
    if target in ACCEL:
        usual = max(_usual_length([first[wanted[axis].column] for axis in ACCEL]), 1e-12)
        near = min(GRAVITY, key=lambda u: abs(np.log(usual / GRAVITY[u])))
        return unit or ("lsb" if counted else near)
    # those who keep to one system of units keep to it for both
    likely = {"m/s2": "rad/s", None: "lsb" if counted else "dps", "lsb": "lsb"}.get(unit, "dps")
    likely = "rad/s" if omega else likely
    if unit == "mg" and spelled(wanted[target].column).endswith("gyro"):
        return "mrad/s"  # MAVLink's xacc and xgyro
    # one unit for the three, by the fastest
    every = np.abs([first[wanted[axis].column] for axis in GYRO if axis in wanted])
    fast = np.nanmax(every, initial=0.0) > FASTEST_DPS / RATE_DPS["rad/s"]
    return "dps" if fast and likely == "rad/s" else likely


def likely_units_of_time(step: float) -> dict[str, float]:
    """Unit -> samples a second, of those in which anyone would have recorded so fast."""
    hz = {unit: 1.0 / (step * seconds) for unit, seconds in TIME_S.items()} if step else {}
    return {unit: f for unit, f in hz.items() if _LIKELY_HZ[0] <= f <= _LIKELY_HZ[1]}


def _by_pace(
    column: str, wanted: Mapping[str, Mapped], first: Mapping[str, np.ndarray]
) -> tuple[str | None, str]:
    """The only unit in which anyone would have recorded so fast, where the name is of no other;
    of several that in which rates turn gravity."""
    likely = likely_units_of_time(_usual_step(first[column]))
    if _OTHER_TIME.search(column.lower()):
        return None, ""
    turned = ""
    if len(likely) > 1:
        at = first[column] - first[column][0]
        sizes = {u: gravity_turned(wanted, first, at * TIME_S[u]) for u in likely}
        likely = {u: likely[u] for u, size in sizes.items() if size and rate_unit_of(size)}
        turned = ", and gravity turns with the rates"
    if len(likely) != 1:
        return None, ""
    unit, hz = next(iter(likely.items()))
    return unit, f"that is {hz:.4g} Hz{turned}"


def of_long_time(column: str) -> bool:
    """Whether a name says a unit of time that a recording cannot have: time_min."""
    return bool(_LONG_TIME.search(column.lower()))


def _usual_step(values: np.ndarray) -> float:
    steps = np.diff(values[np.isfinite(values)])
    steps = np.abs(steps[steps != 0])  # two sensors at one time
    size = min(_TOGETHER, len(steps) // 4) or 1  # that come in bursts
    means = steps[: len(steps) // size * size].reshape(-1, size).mean(axis=1)
    return float(np.median(means)) if len(means) else 0.0


def _time_words(values: np.ndarray) -> str:
    likely = likely_units_of_time(_usual_step(values))
    would = " or ".join(f"{unit} ({hz:.4g} Hz)" for unit, hz in likely.items())
    ticks = ", or --map t_us=COLUMN:xSIZE, ticks of SIZE us, if it is no time in these"
    rows = ", if it counts them" if counts_rows(values) else ticks
    return f"{f'--time-unit {would}; or ' if would else ''}--hz, rows a second{rows}"
