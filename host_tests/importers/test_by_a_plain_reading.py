"""An import makes of rows in chunks what a plain reading of the whole makes of them."""

from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from zerorate_tools.errors import BadRecording
from zerorate_tools.importers import Options, parsed_mapping
from zerorate_tools.importers.importing import _gathered, _How, _ready
from zerorate_tools.importers.samples.between import _usual_us, refuse_two_recordings
from zerorate_tools.importers.samples.gather import _are_held
from zerorate_tools.importers.samples.spool import Spool
from zerorate_tools.importers.tables.table import Chunk, Table
from zerorate_tools.numbers import duration
from zerorate_tools.recordings.checks import GAP
from zerorate_tools.recordings.reading import whole

RATES, FORCE = ("gx_dps", "gy_dps", "gz_dps"), ("ax_g", "ay_g", "az_g")
PATH = Path("log.csv")


def table(columns, cuts=()):
    """A table whose rows come in chunks that end there."""
    size = len(next(iter(columns.values())))
    bounds = [0, *sorted(cuts), size]

    def chunks(wanted):
        for a, b in zip(bounds, bounds[1:]):
            yield Chunk(np.arange(a, b), {name: columns[name][a:b].copy() for name in wanted})

    return Table(list(columns), chunks)


def imported(columns, cuts=(), **options):
    """(columns, scales, report) of an import of such a table."""
    mapping = [parsed_mapping("level=level")] if "level" in columns else ()
    source = _gathered(table(columns, cuts), PATH, _How(Options(**options), mapping, None, 0), None)
    one = _ready([source])[0]
    return whole(one.batches, one.names, PATH), one.scales, one.report


def log(random, n, hz):
    """A log of a gyroscope and slower sensors, with rows that are none, in no strict order."""
    # what goes back by 10 s, or on, is a torn stamp: less than three gaps within four rows
    at = np.cumsum(1 + (random.random(n) < 0.02) * random.integers(0, 30, n) * (hz > 1)) / hz
    columns = {"t_s": at + random.choice([0.0, 1.7e9])}
    fastest = random.choice([3.0, 240.0, 249.0, 400.0, 900.0, 1800.0])
    columns |= {name: fastest * random.uniform(-1, 1, n) for name in RATES}
    columns |= {name: (name == "az_g") + random.normal(0, 0.05, n) for name in FORCE}
    columns |= {"temp_c": random.normal(25, 3, n), "level": random.integers(-9, 9, n) + 0.0}
    within = slice(1, n - 1)
    for names in (FORCE, ("temp_c",), ("level",), RATES, ("gy_dps",), ("t_s",)):
        share = 0.05 if names[0] in (*RATES, "t_s") else random.choice([0.0, 0.5, 0.95, 1.0])
        lacks = random.random(n)[within] < (0.0 if hz < 1 and share == 0.05 else share)
        for name in names:
            columns[name][within][lacks] = np.nan
    late = random.uniform(0, random.choice([1.0, 4.0]) if hz > 1 else 1.0, n - 2)
    order = np.r_[0, 1 + np.argsort(np.arange(n - 2) + late), n - 1]
    return {name: values[order] for name, values in columns.items()}


def plainly(columns, hz):
    """(columns as floats, dropped, longest line of each slower sensor), by the whole at once."""
    rows = {name: values.copy() for name, values in columns.items()}
    readings = [name for name in rows if name != "t_s"]
    dropped = Counter()

    def keep(good, reason):
        dropped[reason] += int((~good).sum())
        for name in rows:
            rows[name] = rows[name][good]

    keep(np.isfinite(rows["t_s"]), "the time stamp is no number")
    keep(np.any([np.isfinite(rows[n]) for n in readings], axis=0), "no reading of these columns")
    rates = np.isfinite([rows[name] for name in RATES])
    keep(rates.all(axis=0) | ~rates.any(axis=0), "a reading is no number")
    order = np.argsort(rows["t_s"], kind="stable")
    rows = {name: values[order] for name, values in rows.items()}
    sample, longest = np.isfinite(rows["gx_dps"]), {}
    near = np.ones(sample.sum(), bool)
    t_us, out = rows["t_s"] * 1e6, {}
    for name in (*RATES, *FORCE, "temp_c"):
        there = np.isfinite(rows[name])
        lacks = (sample & ~there)[sample]
        at, mine = t_us[there], t_us[sample]
        out[name] = np.where(lacks, np.interp(mine, at, rows[name][there]), rows[name][sample])
        after = np.searchsorted(at, mine).clip(1, len(at) - 1)
        spans = at[after] - at[after - 1]
        no_gap = spans <= max(1e6, 3 * np.quantile(np.diff(at), 0.9))
        if (lacks & no_gap).any():
            longest[name] = spans[lacks & no_gap].max()
        in_gap = lacks & ~no_gap
        if name in ("ax_g", "temp_c"):
            what = {"ax_g": "acceleration", "temp_c": "temperature"}[name]
            reason = f"in a gap of the {what}; without it: --map {name.partition('_')[0]}=none"
            dropped[reason] = int((near & in_gap).sum())
        near &= ~in_gap
    out["t_us"] = t_us[sample]
    level = rows["level"][sample]
    out["level"] = np.where(np.isnan(level), GAP, level)
    return {name: values[near] for name, values in out.items()}, +dropped, longest


@given(
    st.integers(0, 1 << 30), st.integers(60, 300), st.sampled_from([0.4, 10.0, 100.0]), st.data()
)
def test_rows_in_chunks_are_read_as_the_whole(seed, n, hz, data):
    columns = log(np.random.default_rng(seed), n, hz)
    cuts = data.draw(st.lists(st.integers(1, n - 1), max_size=5))
    found, scales, report = imported(columns, cuts)
    plain, dropped, longest = plainly(columns, hz)
    assert (found["t_us"] == np.rint(plain["t_us"])).all() and len(found["t_us"]) == len(
        found["gx"]
    )
    assert (found["level"] == plain["level"]).all()
    lsb = dict.fromkeys(RATES, scales.gyro_lsb_per_dps) | dict.fromkeys(
        FORCE, scales.accel_lsb_per_g
    )
    for name, per_unit in {**lsb, "temp_c": scales.temp_lsb_per_degc}.items():
        short = name.partition("_")[0]
        counts = np.rint(plain[name] * per_unit)
        assert np.abs(found[short] - counts).max() <= (name in longest), name
    assert report.dropped == dropped and not report.clipped
    assert (report.rows_read, report.rows_written) == (n, len(plain["t_us"]))
    for name, what in (("ax_g", "acceleration"), ("temp_c", "temperature")):
        said = [note for note in report.notes if note.startswith(f"{what} interpolated")]
        wanted = [f"at most {duration(longest[name] * 1e-6)}"] if name in longest else []
        assert [note.partition("over ")[2] for note in said] == wanted


SIZES = {name: st.floats(0.1, most) for name, most in (("rate", 2040.0), ("force", 15.0))}


@given(SIZES["rate"], SIZES["force"], st.sampled_from([0.02, 3.0]))
def test_the_scale_is_the_finest_that_holds_every_reading(rate, force, step_s):
    n = 80
    ups = np.where(np.arange(n) % 2, 1.0, -1.0)
    columns = {"t_s": np.arange(n) * step_s, **dict.fromkeys(RATES, rate * ups)}
    columns |= {name: np.full(n, 0.577) for name in FORCE}
    columns["az_g"][7] = force
    found, scales, report = imported(columns)
    ranges = [1000.0, 500.0, 200.0] * (step_s > 2) + [131.0, 65.5, 32.8, 16.4]
    fit = [lsb for lsb in ranges if rate * lsb < 32767]
    assert scales.gyro_lsb_per_dps == (fit or ranges[-1:])[0]
    assert scales.accel_lsb_per_g == max(r for r in (2048, 4096, 8192, 16384) if force * r < 32767)
    assert bool(report.clipped) == (not fit)
    assert found["gx"].max() == round(min(rate * scales.gyro_lsb_per_dps, 32767))
    assert ("row_is_mean_of_s" in scales.more) == (step_s > 2)


@pytest.mark.parametrize(
    ("rates_s", "force_s", "is_one"),
    [
        ((0, 100), (5, 95), True),  # 5 s of 100 s are not too many
        ((0, 100), (5.1, 100), False),
        ((0, 100), (0, 94.9), False),
        ((0, 1000), (-20, 1020), True),  # a fiftieth of 1000 s
        ((0, 1000), (20.1, 1000), False),
        ((0, 100), None, True),
    ],
)
def test_tables_of_one_recording_begin_and_end_together(rates_s, force_s, is_one):
    spool = Spool(["t_us", "gx", "ax"])
    for name, span in (("gx", rates_s), ("ax", force_s or ())):
        at = np.array(span) * 1e6
        other = np.full(len(at), np.nan)
        spool.append({"t_us": at, "gx": other, "ax": other, name: at * 0 + 1})
    if is_one:
        refuse_two_recordings(spool, PATH)
        return
    with pytest.raises(BadRecording, match="do not begin and end together"):
        refuse_two_recordings(spool, PATH)


@pytest.mark.parametrize("every", [3, 120])
def test_what_lies_on_lines_is_said_with_the_longest_of_them(every):
    columns, at = at_rest(1000), np.arange(1000)
    for name in (*FORCE, "temp_c"):
        columns[name] = np.where(at % every, np.nan, columns[name])
    _, _, report = imported(columns)
    lines = [note for note in report.notes if "interpolated" in note]
    assert [line.partition("over at most ")[2] for line in lines] == [duration(every / 100)] * 2
    assert report.rows_written == 1000 and not report.dropped


@given(st.floats(0.01, 1000.0), st.lists(st.integers(1, 79), max_size=3))
def test_rows_that_are_counted_come_at_the_rate_that_is_given(hz, cuts):
    columns = {name: np.sin(np.arange(80.0)) for name in RATES}
    found, scales, _ = imported(columns, cuts, hz=hz)
    assert np.abs(found["t_us"] - np.arange(80) * 1e6 / hz).max() <= 0.5
    assert scales.odr_hz == hz


def at_rest(n):
    """n rows of a sensor of everything, 100 a second."""
    columns = {"t_s": np.arange(n) / 100, **{name: np.sin(np.arange(n) + 1.0) for name in RATES}}
    return columns | {name: np.full(n, 0.577) for name in FORCE} | {"temp_c": np.arange(n) + 1.0}


def gathered_of(columns, cuts, **options):
    how = _How(Options(**options), (), None, 0)
    return _gathered(table(columns, cuts), PATH, how, None)


@pytest.mark.parametrize(
    ("sizes", "kept"),
    [
        ([12_000, 500, 201, 200, 199], [10_000, 200, 200, 200, 199]),
        ([1] * 400, [1] * 400),
        ([1] * 401, [1] + [1, 0] * 200),  # every second of many, but for the first
    ],
)
def test_of_a_long_log_the_beginning_of_each_piece_is_looked_at(sizes, kept):
    n = sum(sizes)
    found = gathered_of(at_rest(n), np.cumsum(sizes)[:-1].tolist()).found
    begins = np.cumsum([0, *sizes])
    expected = [at + k for at, count in zip(begins, kept) for k in range(count)]
    assert (np.rint(found.looked_at["t_us"] / 10_000) == expected).all()
    if len(sizes) < 9:
        assert (found.looked_at["temp"] == np.array(expected) + 1.0).all()
        assert len(found.looked_at["ax"]) == len(expected)


def test_the_usual_interval_of_a_slower_sensor_is_across_pieces():
    spool, at = Spool(["t_us", "gx", "ax"]), np.array([0, 1, 2, 5, 9, 14, 20, 27, 35, 44, 54.0])
    for part in (at[:4], at[4:5], np.array([10.0]), at[5:]):
        there = np.isin(part, at)
        spool.append({"t_us": part, "gx": part, "ax": np.where(there, 1.0, np.nan)})
    spool.finish()
    assert _usual_us(spool, "ax") == np.quantile(np.diff(at), 0.9)
    steps, spool = np.repeat([1.0, 5.0], [900, 200]), Spool(["t_us", "ax"])
    spool.append({"t_us": np.cumsum(np.r_[0.0, steps]), "ax": np.ones(1101)})
    spool.finish()
    assert _usual_us(spool, "ax") == pytest.approx(np.quantile(steps[:1000], 0.9))


@pytest.mark.parametrize(
    ("kind", "lsb", "divided"),
    [
        *(("gyro", 2184.0, False), ("gyro", 2185.0, True), ("accel", 32768.0, False)),
        *(("accel", 32769.0, True), ("temp", 1e6, False), ("gyro", None, False)),
    ],
)
def test_counts_that_16_bits_cannot_hold_are_divided(kind, lsb, divided):
    key = {"gyro": "gyro_lsb_per_dps", "accel": "accel_lsb_per_g", "temp": "temp_lsb_per_degc"}
    names = {"t_s": "t_us", **dict(zip("pqrabcT", "gx gy gz ax ay az temp".split()))}
    columns = {name: np.rint(1000 * np.sin(np.arange(80) + n)) for n, name in enumerate(names)}
    columns["t_s"] = np.arange(80.0)
    mapping = [
        parsed_mapping(f"{to}={name}:{'s' if to == 't_us' else 'lsb'}")
        for name, to in names.items()
    ]
    options = Options(**{**dict.fromkeys(key.values(), 10.0), key[kind]: lsb})
    source = _gathered(table(columns), PATH, _How(options, mapping, None, 0), None)
    assert getattr(source.options, key[kind]) == (None if divided else lsb)
    assert (kind in source.plan.raw) is not divided
    others = {k: v for k, v in key.items() if k != kind}
    assert all(getattr(source.options, k) == 10.0 for k in others.values())


@pytest.mark.parametrize(
    ("rows", "stands", "coarse", "held"),
    [(100, 2, False, True), (100, 2, True, False), (100, 1, False, False), (1, 1, False, False)],
)
def test_rates_that_stand_still_together_are_read_too_often(rows, stands, coarse, held):
    at = np.arange(rows)
    places = [at // stands + (n * coarse * at % 3 > 0) for n in range(3)]
    rates = np.array([np.sin(1.0 + p) for p in places])
    assert _are_held(rates, 100.0 * at) is held
    assert not _are_held(rates, 0.0 * at)  # no time goes on between them


def test_changes_that_are_as_frequent_as_four_in_five_are_readings_of_their_own():
    for changes, held in ((79, True), (80, False)):
        at = np.r_[0, np.cumsum(np.arange(100) < changes)]
        assert _are_held(np.sin(np.tile(at, (3, 1)) + 1.0), 10.0 * np.arange(101)) is held
    rates = np.tile(np.sin(np.arange(101) // 2), (3, 1))
    for alone, held in ((25, True), (26, False)):  # half of them change all three
        some = rates.copy()
        some[2, np.arange(101) < 2 * alone] = 7.0
        assert _are_held(some, 10.0 * np.arange(101)) is held


def test_more_than_one_rate_in_a_thousand_beyond_every_sensor_refuses_the_unit():
    for fast, refused in ((2, False), (3, True)):
        columns = at_rest(2000)
        columns["gy_dps"][500 : 500 + fast] = 3000.0
        if not refused:
            found = gathered_of(columns, []).found
            assert found.samples == 2000 - fast and list(found.dropped.values()) == [fast]
            continue
        with pytest.raises(BadRecording, match=f"3000 dps is more .* in {fast} rows") as caught:
            gathered_of(columns, [])
        assert "did you mean mdps?" in str(caught.value)


@pytest.mark.parametrize(("reading", "clipped"), [(250.12, 0), (250.13, 1), (251.0, 1)])
def test_a_reading_at_the_rail_is_counted_and_kept_in_16_bits(reading, clipped):
    columns = at_rest(80)
    columns["gx_dps"][5:7] = reading, -reading
    found, _, report = imported(columns, gyro_lsb_per_dps=131.0)
    assert report.clipped == ({"gx": 2 * clipped} if clipped else {})
    assert found["gx"][5] == min(round(131 * reading), 32767)
    assert found["gx"][6] == max(round(-131 * reading), -32768)
    assert report.lines()[0] == "80 samples: 790 ms at 100 Hz, of 80 rows"


@pytest.mark.parametrize(("level", "fits"), [(2**31 - 1, True), (2**31, False), (-(2**31), False)])
def test_a_channel_of_more_than_32_bits_is_refused_by_its_row(level, fits):
    columns = at_rest(80) | {"level": np.arange(80.0)}
    columns["level"][7] = level
    if fits:
        assert imported(columns)[0]["level"][7] == level
        return
    with pytest.raises(BadRecording, match="row 8: level is .*no integer of 32 bits"):
        imported(columns)
