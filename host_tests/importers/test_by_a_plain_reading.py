"""An import makes of rows in chunks what a plain reading of the whole makes of them."""

from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from zerorate_tools.errors import BadRecording
from zerorate_tools.importers import Options, parsed_mapping
from zerorate_tools.importers.importing import _gathered, _How, _ready
from zerorate_tools.importers.samples.gather import Counts, _are_held
from zerorate_tools.importers.samples.spool import Runs
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
@example(1.0, 7.99967, 0.02)  # rounds to the rail of 8 g
def test_the_scale_is_the_finest_that_holds_every_reading(rate, force, step_s):
    n = 80
    ups = np.where(np.arange(n) % 2, 1.0, -1.0)
    columns = {"t_s": np.arange(n) * step_s, **dict.fromkeys(RATES, rate * ups)}
    columns |= {name: np.full(n, 0.577) for name in FORCE}
    columns["az_g"][7] = force
    found, scales, report = imported(columns)
    ranges = [1000.0, 500.0, 200.0] * (step_s > 2) + [131.0, 65.5, 32.8, 16.4]
    fit = [lsb for lsb in ranges if rate * lsb < 32766.5]
    assert scales.gyro_lsb_per_dps == (fit or ranges[-1:])[0]
    assert scales.accel_lsb_per_g == max(
        r for r in (2048, 4096, 8192, 16384) if force * r < 32766.5
    )
    assert bool(report.clipped) == (not fit)
    assert found["gx"].max() == round(min(rate * scales.gyro_lsb_per_dps, 32767))
    assert ("row_is_mean_of_s" in scales.more) == (step_s > 2)


def at_rest(n):
    """n rows of a sensor of everything, 100 a second."""
    columns = {"t_s": np.arange(n) / 100, **{name: np.sin(np.arange(n) + 1.0) for name in RATES}}
    return columns | {name: np.full(n, 0.577) for name in FORCE} | {"temp_c": np.arange(n) + 1.0}


@pytest.mark.parametrize(
    ("rows", "second", "fits"),
    [
        *((101, 1000, True), (101, 900, True), (101, 890, False)),  # a tenth of it may be shared
        *((101, -1100, True), (101, -1110, False), (100, 0, False), (99, 0, True)),
    ],
)
def test_two_stretches_that_claim_the_same_time_are_two_recordings(rows, second, fits):
    runs = Runs()
    for number, begin in enumerate((0, second)):
        runs.add(begin + 10.0 * np.arange(rows), np.arange(rows) + rows * number)
    if fits:
        runs.refuse_a_restart(PATH)
        return
    with pytest.raises(BadRecording, match=f"row {rows + 1}: "):
        runs.refuse_a_restart(PATH)


@pytest.mark.parametrize(
    ("counts", "said"),
    [
        *(
            ([-32_768, 32_767], ""),
            ([0] * 99 + [32_768], "negative ones"),
            ([0, 65_535], "negative ones"),
        ),
        *(([0, 65_536], "no words of 16 bits"), ([-1, 32_768], "no words of 16 bits")),
        *(([-32_769, 0], "no words of 16 bits"), ([0] * 98 + [65_000, 24_576], "negative ones")),
        *(([0] * 98 + [24_576] * 2, ""), ([0] * 97 + [65_000] + [24_576] * 2, "around 32768")),
        *(([0] * 98 + [40_959] * 2, "around 32768"), ([0] * 98 + [40_960] * 2, "negative ones")),
        ([0] * 97 + [65_000] + [24_575] * 2, "negative ones"),
    ],
)
def test_counts_are_words_of_16_bits_with_a_sign_or_without(counts, said):
    seen, found = Counts(frozenset(["accel"])), []
    for part in np.split(np.array(counts, float), [len(counts) // 2]):
        columns = {"az": part, "level": part.copy()}
        seen.signed(columns)
        found += columns["az"].tolist()
    try:
        told = seen.notes(PATH)
    except BadRecording as error:
        told = [str(error)]
    assert said in "".join(told) and bool(told) is bool(said)
    assert found == [n - 65_536 if 32_768 <= n < 65_536 else n for n in counts]


@pytest.mark.parametrize(
    ("changes", "alone", "held"), [(79, 0, True), (80, 0, False), (50, 25, True), (50, 26, False)]
)
def test_rates_that_often_stand_still_together_are_read_too_often(changes, alone, held):
    step = np.arange(100)
    at = np.r_[0, np.cumsum(step % 2 > 0 if changes == 50 else step < changes)]
    rates = np.sin(np.tile(at, (3, 1)) + 1.0)
    rates[2, : 2 * alone] = 7.0  # so often the other two change alone
    assert _are_held(rates, 10.0 * np.arange(101)) is held
    assert not _are_held(rates, np.zeros(101))  # no time goes on between them


def test_of_a_long_log_the_beginning_of_each_piece_is_looked_at():
    sizes, kept = [12_000, 500, 201, 200, 199], [10_000, 200, 200, 200, 199]
    how = _How(Options(), (), None, 0)
    opened = _gathered(table(at_rest(sum(sizes)), np.cumsum(sizes)[:-1].tolist()), PATH, how, None)
    begins = np.cumsum([0, *sizes])
    expected = [at + k for at, count in zip(begins, kept) for k in range(count)]
    seen = opened.found.looked_at
    assert (np.rint(seen["t_us"] / 10_000) == expected).all() and len(seen["ax"]) == len(expected)


def test_a_log_in_very_many_pieces_is_read_as_in_one():
    (one, scales, _), (many, same, _) = (imported(at_rest(900), c) for c in ((), range(1, 900)))
    assert scales == same and all((one[name] == many[name]).all() for name in one)


def test_more_than_one_rate_in_a_thousand_beyond_every_sensor_refuses_the_unit():
    for fast, refused in ((2, False), (3, True)):
        columns = at_rest(2000)
        columns["gy_dps"][500 : 500 + fast] = 3000.0
        if not refused:
            report = imported(columns)[2]
            assert report.rows_written == 2000 - fast and [*report.dropped.values()] == [fast]
            continue
        with pytest.raises(BadRecording, match=f"3000 dps is more .* in {fast} rows") as caught:
            imported(columns)
        assert "did you mean mdps?" in str(caught.value)
