"""Steps from rows to samples, each against a plain computation or at the edges of what it asks."""

from collections import Counter
from itertools import groupby
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from zerorate_tools.errors import BadRecording
from zerorate_tools.importers.columns.chip_steps import unit_by_steps
from zerorate_tools.importers.columns.units import factors_of
from zerorate_tools.importers.logs import json_file, ros_bag
from zerorate_tools.importers.samples import lines
from zerorate_tools.importers.samples.clock import (
    Gaps,
    Pace,
    Ticks,
    Unwrapped,
    evenly,
    longest_us,
    whole_stamps,
)
from zerorate_tools.importers.samples.one_device import clocks_in_turn, levels_in_turn
from zerorate_tools.importers.samples.spool import Runs, Spool, in_order
from zerorate_tools.numbers import duration

from .test_by_a_plain_reading import RATES, at_rest, imported
from .test_units_told import judge_change

PATH = Path("log.csv")


def spooled(columns, cuts=()):
    spool, size = Spool(list(columns)), len(columns["t_us"])
    for a, b in zip([0, *sorted(cuts)], [*sorted(cuts), size]):
        spool.append({name: values[a:b] for name, values in columns.items()})
    spool.finish()
    return spool


def read(spool):
    return {name: np.concatenate([one[name] for one in spool]) for name in spool.names}


cuts = st.lists(st.integers(1, 120), max_size=6)


@given(st.lists(st.integers(0, 40), min_size=121, max_size=160), cuts, st.booleans())
def test_rows_in_any_order_come_by_time_and_then_by_place(t_us, cuts, is_sorted):
    t_us = np.array(sorted(t_us) if is_sorted else t_us, float)
    columns = {"t_us": t_us, "place": np.arange(len(t_us)) + 0.0, "x": t_us * 3}
    spool = spooled(columns, cuts)
    out = in_order(spool, PATH, None)
    assert (out is spool) is bool((np.diff(t_us) >= 0).all())
    order = np.argsort(t_us, kind="stable")
    assert all((values == columns[name][order]).all() for name, values in read(out).items())


stretches = st.tuples(st.sampled_from([1, 2, 99, 100, 101, 130]), st.integers(0, 9))


@given(st.lists(stretches, min_size=1, max_size=6), cuts)
def test_stretches_of_a_hundred_rows_in_order_are_seen_across_pieces(parts, cuts):
    t_us = np.concatenate([300.0 * begin + np.arange(rows) for rows, begin in parts])
    begins = [0, *(np.flatnonzero(np.diff(t_us) < 0) + 1), len(t_us)]
    ends = [(a, b) for a, b in zip(begins, begins[1:]) if b - a >= 100]
    runs, bounds = Runs(), [0, *sorted(cuts), len(t_us)]
    for a, b in zip(bounds, bounds[1:]):
        runs.add(t_us[a:b], np.arange(len(t_us))[a:b] + 7)
    runs._close(runs._last)
    assert runs.steps_back == len(begins) - 2
    assert runs._long == [(t_us[a], t_us[b - 1], a + 7) for a, b in ends]


@pytest.mark.parametrize(
    ("first", "second", "fits"),
    [
        *((0, 1000, True), (0, 900, True), (0, 890, False)),  # a tenth of it may be shared
        *((2000, 900, True), (2000, 890, False), (2000, 1100, True), (2000, 1110, False)),
    ],
)
def test_two_stretches_that_claim_the_same_time_are_two_recordings(first, second, fits):
    runs = Runs()
    for number, begin in enumerate((first, second)):
        runs.add(begin + 10.0 * np.arange(101), np.arange(101) + 101 * number)
    if fits:
        runs.refuse_a_restart(PATH)
        return
    with pytest.raises(BadRecording, match="row 102: "):
        runs.refuse_a_restart(PATH)


@given(st.integers(3, 3000), st.integers(0, 1 << 30), cuts)
def test_the_usual_interval_and_the_mean_one_are_those_of_the_whole(n, seed, cuts):
    steps = np.random.default_rng(seed).choice([9e3, 1e4, 2e4, 1e6, 1e6 + 1], n)
    t_us, pace, gaps = np.cumsum(np.r_[0.0, steps]), Pace(), Gaps(1e4)
    pace.add(t_us)
    for part in np.split(t_us, sorted(cuts)):
        gaps.add(part)
    each = min(64, max(1, len(t_us) // 16))
    assert pace.interval_us(PATH) == np.median(np.diff(t_us[::each]) / each)
    short = steps[steps < 1e6 + 1]
    assert pace.mean_us == pytest.approx(short.mean() if len(short) else 0.0)
    assert gaps.count == len(steps) - len(short)
    assert gaps.longest_us == (1e6 + 1 if gaps.count else 0.0)


@pytest.mark.parametrize(("interval", "longest"), [(1e5, 1e6), (4e5, 1.2e6), (333_333, 1e6)])
def test_a_gap_is_longer_than_three_intervals_and_a_second(interval, longest):
    assert longest_us(interval) == longest


def stamped(counts, steps):
    """Rows that share stamps: so many at each, which are so many ticks of 1 s apart."""
    stamps = 1e6 * np.cumsum([0, *steps[: len(counts) - 1]])
    t_us = np.repeat(stamps, counts)
    columns = {"t_us": t_us, "place": np.arange(len(t_us)) + 0.0, "gx": t_us * 0}
    return columns, Ticks(t_us)


@given(st.integers(3, 10), st.integers(1, 7), st.integers(0, 30), cuts)
def test_rows_that_share_a_stamp_lie_evenly_from_where_a_stretch_begins_to_where_it_ends(
    first, last, at, cuts
):
    counts = [10 - first, *[10] * at, last, 10 - first, *[10] * 40]
    columns, ticks = stamped(counts, [*[1] * (at + 1), 5, *[1] * 50])
    out, _ = evenly(spooled(columns, cuts), ticks, PATH, None)
    # a stretch that begins within a tick ends with it, and one that ends within it begins with it
    begins = np.repeat([1 + first * (n in (0, at + 2)) - 1 for n in range(len(counts))], counts)
    within = np.concatenate([np.arange(count) for count in counts])
    assert (ticks.tick_us, ticks.sample_us) == (1e6, pytest.approx(1e5))
    assert read(out)["t_us"] == pytest.approx(columns["t_us"] + 1e5 * (begins + within), abs=1.0)


@pytest.mark.parametrize(
    ("odd", "rows", "told"), [(10, 7, 10), (11, 7, None), (30, 8, 0), (30, 12, 0), (11, 13, None)]
)
def test_more_than_a_tenth_of_stamps_two_rows_off_tell_no_times(odd, rows, told):
    counts = np.full(100, 10)
    counts[20 : 20 + 2 * odd : 2] = rows
    columns, ticks = stamped(counts, [1] * 99)
    if told is None:
        with pytest.raises(BadRecording, match=f"{min(10, rows)} to {max(10, rows)} rows"):
            evenly(spooled(columns), ticks, PATH, None)
        return
    note = evenly(spooled(columns), ticks, PATH, None)[1]
    each = f"{1e6 / ticks.sample_us:.4g} each"
    assert duration(1.0) in note and each in note and (f"in {told} of" in note) is bool(told)


def test_many_rows_of_the_last_stamp_lie_within_its_tick():
    columns, ticks = stamped([2] * 30 + [5], [1] * 30)
    out, _ = evenly(spooled(columns), ticks, PATH, None)
    assert read(out)["t_us"][-5:] == pytest.approx(30e6 + 2e5 * np.arange(5))


@given(st.lists(st.tuples(st.sampled_from([0.5, 1, 1.5, 8, 9]), st.booleans()), max_size=40), cuts)
def test_rows_on_lines_are_counted_as_they_lie(rows, cuts):
    off, moves = np.array(rows, float).reshape(-1, 2).T
    seen = lines._Seen()
    longest = 0
    for a, b in zip([0, *sorted(cuts)], [*sorted(cuts), len(off)]):
        seen.add(off[a:b], moves[a:b] > 0)
        runs = groupby(o <= 1 and m for o, m in rows[a:b])
        longest = max(longest, *(len([*run]) for on, run in runs if on), 0)
    moved = [o for o, m in rows if m]
    assert seen.longest == longest
    assert (seen.rows, seen.lines) == (len(rows), sum(o <= 1 for o, _ in rows))
    assert seen.on == sum(o <= 1 for o in moved) and seen.off == sum(o > 8 for o in moved)
    assert seen.near == sum(1 < o <= 8 for o in moved)


@pytest.mark.parametrize(
    ("on", "longest", "near", "off", "are"),
    [
        *((1, 4, 0, 99, False), (2, 1, 0, 99, True), (1, 5, 0, 99, True)),
        *((50, 9, 4, 100, True), (50, 9, 5, 100, False)),
    ],
)
def test_lines_are_clear_and_more_than_chance_gives(on, longest, near, off, are):
    seen = lines._Seen(100, on, on, near, off, longest)
    assert seen.are_lines is are


@pytest.mark.parametrize(
    ("period", "refused"), [(0.0, False), (2.4, False), (2.53, True), (2.6, True)]
)
def test_lines_whose_ends_are_no_readings_are_refused_with_their_share(
    monkeypatch, period, refused
):
    readings = np.random.default_rng(1).integers(-99, 99, (3, 100)) * 100.0
    every = np.array([np.interp(np.arange(199) / 2, np.arange(100), axis) for axis in readings])
    columns = {"t_us": np.arange(199) * 1e4, **dict(zip(("gx", "gy", "gz"), every))}
    monkeypatch.setattr(lines, "base_period", lambda frame, digits: period)
    if refused:
        with pytest.raises(BadRecording, match=f" {100 / period:.0f} %"):
            lines.without_lines(spooled(columns), PATH, None)
        return
    out, lost = lines.without_lines(spooled(columns, [60, 61, 130]), PATH, None)
    assert lost == 99 and (read(out)["gx"] == readings[0]).all()


@pytest.mark.parametrize(
    ("louder", "shift", "push", "at", "is_change"),
    [
        *((1 / 1.38, 0, 0, 1000, True), (1.38, 0, 0, 1000, True), (1.42, 0, 0, 1000, False)),
        *((1, 0.06, 0, 1000, True), (1, -0.06, 0, 1000, True), (1, 0.09, 0, 1000, False)),
        *((1, 0, 0.018, 1000, True), (1, 0, 0.022, 1000, False), (1, 0, 0, 100, True)),
        *((1, 0, 0, 60, False), (1, 0, 0, 1900, True), (1, 0, 0, 1940, False)),
    ],
)
def test_a_change_of_unit_is_the_same_rest_in_other_numbers(louder, shift, push, at, is_change):
    noise = np.tile(np.random.default_rng(1).normal(0, 0.05, (3, 100)), 20)
    rates = 0.5 + noise
    rates[:, at:] = 1000 * (0.5 + shift + louder * noise[:, at:])
    force = np.random.default_rng(2).normal(0, 0.004, (3, 2000)) + np.array([[0.1], [-0.2], [0.97]])
    force[2, at:] += push
    columns = dict(zip(("gx", "gy", "gz", "ax", "ay", "az"), [*rates, *force]))
    if not is_change:
        judge_change(columns)
        return
    with pytest.raises(BadRecording, match=f"row {at + 1}: .* 1000 times"):
        judge_change(columns)


@pytest.mark.parametrize(
    ("name", "step", "given", "told"),
    [
        *(("t_s", 1 / 39e3, None, ""), ("t_s", 1 / 41e3, None, "--hz"), ("t_s", 1e-9, 41e3, "")),
        *(
            ("t_us", 20.0, None, "t_us:s"),
            ("t_us", 26.0, None, ""),
        ),
    ],
)
def test_samples_that_come_faster_than_any_such_sensor_has_them_are_refused(
    name, step, given, told
):
    columns = at_rest(99)
    columns = {name: step * np.arange(99), **{n: v for n, v in columns.items() if n != "t_s"}}
    if not told:
        imported(columns, hz=given)
        return
    with pytest.raises(BadRecording, match=told):
        imported(columns, hz=given)


@pytest.mark.parametrize(
    ("dps", "spread", "doubted"),
    [(26.0, 0.5, 1), (24.0, 0.5, 0), (40.0, 7.9, 1), (40.0, 8.1, 0), (-40.0, 0.5, 1)],
)
def test_a_steady_rate_that_no_bias_has_is_doubted(dps, spread, doubted):
    columns = at_rest(400)
    noise = np.random.default_rng(1).permuted([np.linspace(-spread, spread, 400)] * 3, axis=1)
    columns |= dict(zip(RATES, noise + [[dps], [0.0], [0.0]]))
    assert sum(f"{abs(dps):.2g}" in said for said in imported(columns)[2].doubts) == doubted


@pytest.mark.parametrize(
    ("unit", "read", "degc"), [("degf", 212, 100), ("degf", -40, -40), ("k", 300, 26.85)]
)
def test_temperatures_of_other_scales_become_degrees_celsius(unit, read, degc):
    factor, offset = factors_of("temp")[unit]
    assert read * factor + offset == pytest.approx(degc)


@pytest.mark.parametrize(
    ("holds_us", "step_us", "every_us"),
    [
        *((2.0**30, 1.0, 1e4), (2.0**31, 1.0, 9e6), (2.0**32, 1.0, 1e4), (86_400e6, 1.0, 1e4)),
        *((2.0**30 * 1e3, 1e3, 1e4), (2.0**32 * 1e3, 1e3, 1e4), (86_400e6, 0.0, 3e9)),
    ],
)
@pytest.mark.parametrize("cut", [1, 5, 6, 7, 12])
def test_a_clock_that_runs_over_goes_on(holds_us, step_us, every_us, cut):
    true = holds_us - 5.5 * every_us + every_us * np.arange(12)
    clock, found = Unwrapped(step_us), []
    for part in (slice(cut), slice(cut, None)):
        found += clock(true[part] % holds_us, np.arange(12)[part]).tolist()
    assert found == true.tolist() and len(clock.notes) == 1 and "row 7:" in clock.notes[0]


@pytest.mark.parametrize(("back_us", "every_us"), [(2.0**30 - 1e8, 1e4), (2.0**30, 11e6)])
def test_a_clock_that_goes_back_by_what_no_counter_holds_is_left(back_us, every_us):
    t_us = 2.0**30 - 5.5 * every_us + every_us * np.arange(12)
    t_us[6:] -= back_us
    clock = Unwrapped(1.0)
    assert (clock(t_us, np.arange(12)) == t_us).all() and clock.notes == []


@pytest.mark.parametrize(
    ("off_s", "beside_s", "torn"),
    [(10.1, 0.01, 1), (-10.1, 0.01, 1), (9.8, 0.01, 0), (99.0, 0.49, 1), (99.0, 0.51, 0)],
)
def test_a_stamp_far_from_both_neighbours_is_torn_where_it_is_one_of_a_hundred(
    off_s, beside_s, torn
):
    t_us = 1e6 * beside_s * np.arange(102)
    t_us[50] += 1e6 * off_s
    assert np.flatnonzero(~whole_stamps(t_us)).tolist() == [50] * torn
    assert whole_stamps(t_us[:101]).all() and whole_stamps(t_us[:2]).all()


@pytest.mark.parametrize("devices", range(1, 10))
def test_up_to_eight_devices_that_take_turns_are_counted(devices):
    row, rng = np.arange(1200), np.random.default_rng(1)
    of = rng.permutation(devices)[row % devices]
    told = devices if 1 < devices < 9 else 0
    t_us = row // devices * 1e4 - 5e6 * (row % devices)
    assert clocks_in_turn(t_us) == told == clocks_in_turn(t_us[: 60 + told])
    assert clocks_in_turn(t_us[: 59 + told]) == 0
    rates = 10.0 * of[:, None] + rng.normal(0, 0.5, (1200, 3))
    found = levels_in_turn([rates[:700], rates[700:]])
    assert found > 1 and devices % found == 0 if devices > 1 else found == 0


LSB_DPS = [*(range_dps / 32768 for range_dps in (125, 250, 500, 1000, 2000, 4000))]
LSB_DPS += [0.00875, 0.0175, 0.035, 0.07]


@pytest.mark.parametrize("lsb", LSB_DPS)
@pytest.mark.parametrize(("unit", "of"), [("dps", 1), ("mdps", 1e-3), ("rad/s", np.degrees(1))])
def test_the_steps_of_a_chip_tell_the_unit(lsb, unit, of):
    counts = np.random.default_rng(1).integers(-99, 99, 400)
    assert unit_by_steps(counts * lsb / of) == unit
    assert unit_by_steps(counts * 1.01 * lsb / of) != unit


@pytest.mark.parametrize("step", [0.1, 0.01, 0.001, 0.0001, 0.05, 0.002, 0.0625, 1 / 900])
def test_digits_that_somebody_printed_are_no_steps_of_a_chip(step):
    assert unit_by_steps(step * np.random.default_rng(1).integers(-99, 99, 400)) is None


@pytest.mark.parametrize("line", [b"(1, 2", b"{[]: 1, 'a': 2}", b"(" * 3000, b"[" * 10**6, b"'"])
def test_a_line_that_is_neither_json_nor_python_is_counted(line):
    dropped = Counter()
    assert json_file._object(line, dropped) is None and sum(dropped.values()) == 1


def test_a_database_that_is_damaged_is_no_bag(tmp_path):
    path = tmp_path / "a#b.db3"
    path.write_bytes(b"SQLite format 3\0" + bytes(range(256)) * 40)
    pytest.importorskip("rosbags")
    with pytest.raises(BadRecording):
        ros_bag._database(path)
