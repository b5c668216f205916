"""Units that readings or names tell, and what is offered to type where nothing tells them."""

from pathlib import Path

import numpy as np
import pytest
from zerorate_tools.importers.columns.guesses import (
    by_habit,
    gravity_unit,
    guessed_unit,
    likely_columns,
    likely_units_of_time,
    only_grows,
    ready_words,
    unit_words,
)
from zerorate_tools.importers.columns.mapping import Mapped
from zerorate_tools.importers.columns.plan import Plan
from zerorate_tools.importers.samples.one_device import refuse_change_of_unit
from zerorate_tools.importers.tables.table import Chunk, Table

COLUMNS = {"t_us": "t", "gx": "p", "gy": "q", "gz": "r", "ax": "u", "ay": "v", "az": "w"}
COLUMNS |= {"temp": "d"}
UNITS_S = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}


def wanted(targets, **units):
    return {target: Mapped(target, COLUMNS[target], units.get(target)) for target in targets}


@pytest.mark.parametrize("exponent", range(-6, 12))
@pytest.mark.parametrize("digits", [1.0, 2.4, 2.5, 2.6, 4.9, 5.0, 5.1])
def test_units_of_time_are_those_in_which_somebody_would_record_so_fast(digits, exponent):
    step = digits * 10.0**exponent
    hz = {unit: 1 / (step * seconds) for unit, seconds in UNITS_S.items()}
    likely = [unit for unit, one in hz.items() if 0.02 * (1 - 1e-9) < one < 40_000 * (1 + 1e-9)]
    found = likely_units_of_time(step)
    assert [*found] == likely
    assert found == pytest.approx({unit: hz[unit] for unit in likely})


FROM_ONE_CLOCK = [0, 0, 10, 10, 20, 20, np.nan, 30]


@pytest.mark.parametrize(
    ("target", "columns", "units", "offered"),
    [
        ("t_us", {"t": FROM_ONE_CLOCK}, {}, "--time-unit s (0.1 Hz) or ms (100 Hz)"),
        ("t_us", {"t": [30, 20, 10]}, {}, "--time-unit s (0.1 Hz) or ms (100 Hz)"),
        ("t_us", {"t": [7, 7]}, {}, "--time-unit with one of s, ms, us, ns"),
        ("t_us", {"t": [0, 1e15]}, {}, "--time-unit with one of s, ms, us, ns"),
        ("temp", {"d": [1, np.nan]}, {}, "--temp-unit lsb (or degc, k, degf)"),
        ("temp", {"d": [1, 1.5]}, {}, "--temp-unit degc (or k, degf, lsb)"),
        ("temp", {"d": [np.nan]}, {}, "--temp-unit degc (or k, degf, lsb)"),
        ("gx", {}, {}, "--gyro-unit dps (or deg/s, mdps, rad/s, mrad/s, lsb)"),
        ("ax", {"u": [9.8] * 2, "v": [0] * 2, "w": [0] * 2}, {}, "--accel-unit m/s2 (or g, mg"),
        ("ax", {"u": [3.5] * 2, "v": [0] * 2, "w": [0] * 2}, {}, "--accel-unit g (or mg, m/s2"),
        ("ax", {"u": [3] * 2, "v": [0] * 2, "w": [0] * 2}, {}, "--accel-unit lsb (or g, mg, m/s2)"),
        ("gx", {"p": [0.5], "u": [9.8], "v": [0], "w": [0]}, {}, "--gyro-unit rad/s (or dps"),
        ("gx", {"p": [-35.7], "u": [9.8], "v": [0], "w": [0]}, {}, "--gyro-unit rad/s (or dps"),
        ("gx", {"q": [-35.9], "u": [9.8], "v": [0], "w": [0]}, {}, "--gyro-unit dps (or deg/s"),
        ("gx", {"p": [0.5], "u": [1.0], "v": [0], "w": [0]}, {}, "--gyro-unit dps (or deg/s"),
        ("gx", {"p": [0.5], "u": [3], "v": [0], "w": [0]}, {}, "--gyro-unit dps (or deg/s"),
        ("gx", {"p": [5], "u": [3], "v": [0], "w": [0]}, {}, "--gyro-unit lsb (or dps"),
        ("gx", {"p": [0.5], "u": [3]}, {"ax": "m/s2"}, "--gyro-unit rad/s (or dps"),
        ("gx", {"p": [5], "u": [3]}, {"ax": "lsb"}, "--gyro-unit lsb (or dps"),
        ("gx", {"p": [5], "u": [3]}, {"ax": "g"}, "--gyro-unit dps (or deg/s"),
        ("gx", {"p": [5]}, {"gy": "dps"}, "--map gx=p:dps --map gy=q:dps --map gz=r:dps (or"),
    ],
)
def test_a_unit_is_offered_ready_to_type_the_likeliest_first(target, columns, units, offered):
    targets = [t for t in COLUMNS if t != "temp" or t == target]
    if not {"u", "d", "t"} & set(columns):  # no accelerometer
        targets = [t for t in targets if t[0] != "a"]
    first = {name: np.array(values, float) for name, values in columns.items()}
    first = {name: np.full(1, 0.5) for name in COLUMNS.values()} | first
    said = ready_words(target, wanted(targets, **units), first)
    assert said.startswith(offered)
    assert said.endswith(", or leave it out: --map temp=none") is (target == "temp")


def test_where_a_name_tells_the_unit_of_one_axis_each_is_mapped_for_itself():
    named = wanted(["gx", "gy"]) | {"gz": Mapped("gz", "yaw_dps")}
    assert unit_words(named, "gx", "rad/s").split(" --") == [
        "--map gx=p:rad/s", "map gy=q:rad/s", "map gz=yaw_dps:rad/s",
    ]  # fmt: skip
    assert unit_words(wanted(["gx", "gy", "gz"]), "gx", "rad/s") == "--gyro-unit rad/s"


@pytest.mark.parametrize(
    ("target", "column", "beside", "told"),
    [
        ("gx", "angular_velocity.x", [], "rad/s as in ROS"),
        ("ax", "linear_acceleration.x", [], "m/s2 as in ROS"),
        ("gx", "x", ["seconds_elapsed"], "rad/s as Sensor Logger writes"),
        ("ax", "x", ["seconds_elapsed"], "m/s2 as Sensor Logger writes"),
        ("t_us", "time", ["seconds_elapsed"], "ns as Sensor Logger writes"),
        ("gx", "gX", ["rtcTime"], "dps as OpenLog Artemis writes"),
        ("ax", "aX", ["rtcTime"], "mg as OpenLog Artemis writes"),
        ("t_us", "rtcTime", ["rtcTime"], None),
        ("gx", "x", ["device_id", "error_count"], "rad/s as PX4 writes"),
        ("ax", "x", ["device_id", "error_count"], "m/s2 as PX4 writes"),
        ("t_us", "timestamp", ["device_id", "error_count"], "us as PX4 writes"),
        ("gx", "x", ["device_id"], None),
        ("gx", "x", ["error_count"], None),
        ("gx", "GyrX", ["TimeUS"], "rad/s as in ArduPilot"),
        ("ax", "AccX", ["TimeUS"], "m/s2 as in ArduPilot"),
        ("t_us", "TimeUS", ["TimeUS"], None),
        ("temp", "x", ["TimeUS", "seconds_elapsed", "rtcTime"], None),
        ("gx", "gx", [], None),
    ],
)
def test_programs_are_known_by_the_names_they_write(target, column, beside, told):
    found = by_habit(target, column, [column, *beside])
    assert (found and " ".join(found)) == told


@pytest.mark.parametrize(
    ("target", "values", "unit"),
    [
        ("t_us", [1.0000001e9], "s"), ("t_us", [1e9], None), ("t_us", [4.0999e9], "s"),
        ("t_us", [4.1e9], None), ("t_us", [1.7e12], "ms"), ("t_us", [1.7e15], "us"),
        ("t_us", [1.7e18], "ns"), ("t_us", [0, 1.7e9, 1.7e9, np.nan, np.inf], "s"),
        ("t_us", [np.nan], None), ("t_us", [1e3], None),
        ("temp", [-60] * 9 + [130] * 9, "degc"), ("temp", [-60.5] * 9 + [20], None),
        ("temp", [130.5] * 9 + [20], None), ("temp", [230] * 9 + [400] * 9, "k"),
        ("temp", [229.5] * 9 + [300], None), ("temp", [400.5] * 9 + [300], None),
        ("temp", [25] * 98 + [999], "degc"), ("temp", [25] * 98 + [-999], "degc"),
        ("temp", [25] * 40 + [999], None), ("gx", [0.1], None),
    ],
)  # fmt: skip
def test_dates_and_temperatures_tell_their_unit_by_their_size(target, values, unit):
    first = {COLUMNS[target]: np.array(values, float)}
    found, why = guessed_unit(target, wanted([target]), ["a"], first)
    assert found == unit and bool(why) == bool(unit)


def test_a_date_is_said_by_its_year():
    said = guessed_unit("t_us", wanted(["t_us"]), ["a"], {"t": np.array([1.7e12])})
    assert said == ("ms", "since 1970 that is the year 2023")


@pytest.mark.parametrize(("unit", "g"), [("m/s2", 9.80665), ("g", 1.0), ("mg", 1000.0)])
@pytest.mark.parametrize(("off", "told"), [(-0.16, 0), (-0.14, 1), (0.0, 1), (0.14, 1), (0.16, 0)])
def test_three_columns_as_long_as_gravity_within_15_percent_tell_its_unit(unit, g, off, told):
    along = g * (1 + off) / 3 * np.array([[1, 1, 1], [2, 2, np.nan], [2, 2, 9]])
    assert gravity_unit([*along]) == (unit if told else None)
    first = dict(zip("uvw", along))
    found, why = guessed_unit("ay", wanted(["ax", "ay", "az"]), ["a"], first)
    assert found == (unit if told else None)
    assert why == (f"its usual length is {g * (1 + off):.4g}" if told else "")
    assert gravity_unit([np.full(2, np.nan)] * 3) is None


@pytest.mark.parametrize(
    ("steps", "is_time"),
    [([1] * 5, True), ([0, 1, 0, 1, 1], True), ([0, 1, 0, 1], False), ([1] * 999 + [-1], False),
     ([1] * 1001 + [-1], True), ([], False), ([-1] * 5, False)],
)  # fmt: skip
def test_time_goes_on_at_more_than_half_of_the_rows_and_hardly_ever_back(steps, is_time):
    assert only_grows(np.cumsum([0, *steps])) is is_time


def some(*, rates=60.0, **more):
    """Columns of a time in ms and three rates, which no names tell, and more."""
    noise = np.random.default_rng(1).normal(0, rates, (3, 40))
    return {"t": np.arange(40) * 10.0, **dict(zip("abc", noise)), **more}


@pytest.mark.parametrize(("size", "unit"), [(0.2, ""), (1500.0, ""), (9000.0, ":lsb")])
def test_three_columns_beside_time_are_rates_of_no_unit_or_counts_where_no_sensor_is_so_fast(
    size, unit
):
    columns = some()
    for name in "abc":
        columns[name] = columns[name] * 1e-6 + size
    assert likely_columns(columns) == ["t_us=t:ms"] + [
        f"{axis}={name}{unit}" for axis, name in zip(("gx", "gy", "gz"), "abc")
    ]
    counts = {name: np.rint(values) for name, values in some().items()}
    assert likely_columns(counts)[1] == "gx=a:lsb"


@pytest.mark.parametrize("four", ["qabc", "aqbc", "abcq"])
@pytest.mark.parametrize(("length", "is_one"), [(1.0, True), (1.0001, True), (1.0002, False)])
def test_a_quaternion_is_no_rate_wherever_it_stands(four, length, is_one):
    turn = np.linspace(0, 9, 40)
    quaternion = length * np.array(
        [*np.outer((0.6, 0.8), np.cos(turn)), *np.outer((0.6, 0.8), np.sin(turn))]
    )
    columns = some()
    ordered = {"t": columns["t"]}
    for name in four:
        ordered |= dict(zip("0123", quaternion)) if name == "q" else {name: columns[name]}
    told = [word[:4] for word in likely_columns(ordered)]
    assert (told == ["t_us", "gx=a", "gy=b", "gz=c"]) is is_one


def test_a_row_without_some_number_is_not_looked_at_and_a_column_mostly_without_is_none():
    columns = some(d=np.full(40, np.nan))
    columns["d"][:20] = 5.5
    columns["a"][:19] = np.nan
    assert [word[:4] for word in likely_columns(columns)] == ["t_us", "gx=a", "gy=b", "gz=c"]


@pytest.mark.parametrize(("step", "unit"), [
    (1.1e-4, "s"), (0.09, "s"), (0.11, "ms"), (90.0, "ms"), (110.0, "us"), (9e4, "us"),
    (1.1e5, "ns"), (1.1e8, "s"), (0.9e-4, "s"),
])  # fmt: skip
def test_time_that_nothing_names_is_taken_in_the_unit_of_ten_to_ten_thousand_hertz(step, unit):
    assert likely_columns({**some(), "t": np.arange(40) * step})[0] == f"t_us=t:{unit}"


def test_a_date_comes_before_a_count_of_rows_and_acceleration_may_stand_after_rates():
    date = 1.7e9 + np.arange(40)
    found = likely_columns({**some(), "date": date}, frozenset(["date"]))
    assert found[0] == "t_us=date:s"
    force = {n: np.full(40, f) + np.arange(40) % 2 * 0.01 for n, f in zip("uvw", (0.6, 0.0, 0.8))}
    after = likely_columns(some(**force))
    before = likely_columns({**force, **some()})
    assert after == before
    assert [word.partition(":")[0] for word in after][1:4] == ["ax=u", "ay=v", "az=w"]
    apart = {"t": some()["t"], "u": force["u"], "name": np.full(40, np.nan), **force}
    assert likely_columns({**apart, **some()})[1:4] != after[1:4]


def judge_change(columns):
    """What the importer does about a table of such columns."""
    table = Table(list(columns), lambda wanted: iter([Chunk(np.arange(2000), columns)]))
    plan = Plan({n: Mapped(n, n) for n in columns}, dict.fromkeys(columns, (1.0, 0.0)))
    refuse_change_of_unit([columns], plan, table, Path("log.csv"))


@pytest.mark.parametrize("ratio", [0.0573, 0.01745, 17.45, 57.3, 1000.0])
@pytest.mark.parametrize("seed", range(3))
def test_motion_that_begins_or_ends_is_no_change_of_unit(ratio, seed):
    random = np.random.default_rng(seed)
    quiet = random.normal(0.5, 0.05, (3, 1000))
    swing = 1.1 * ratio * np.sin(np.arange(1000) / 30 + np.arange(3)[:, None])
    swing = 0.5 + swing + random.normal(0, 0.05 * max(ratio, 1.0), (3, 1000))
    force = random.normal(0, 0.004, (3, 2000)) + np.array([[0.1], [-0.2], [0.97]])
    for both in ((quiet, swing), (swing, quiet)):
        columns = dict(zip(("gx", "gy", "gz"), np.hstack(both)))
        columns |= dict(zip(("ax", "ay", "az"), force))
        judge_change(columns)
