"""`zerorate bench cost`: every figure that it promises."""

import pyarrow.parquet as pq
import pytest
from zerorate_bench import cost_report as bench
from zerorate_bench.cost_report import in_markdown
from zerorate_bench.limits import ACCURACY, COST, limits_table, verdicts
from zerorate_bench.replay_speed import replay_speed, write_long
from zerorate_tools.errors import MissingRuntime

ONE = {"instructions": 480.0, "instructions_c": 470.0, "median": 400, "worst": 9000}
CYCLES = {"cycles": 560.0, "cycles_worst": 12000.0}
NATIVE = {
    "thumb": {"alone": ONE | CYCLES, "bursts": ONE | CYCLES | {"instructions": 940.0}},
    "rv32": {"alone": ONE, "bursts": ONE},
}


@pytest.fixture
def measured(monkeypatch):
    """The bench with its measures of minutes replaced by their figures."""
    figures = {
        "native_cost": NATIVE,
        "mpy_sizes": {"bytecode": 50_000},
        "replay_speed": {"1": {"samples_per_s": 2.5e6, "peak_bytes": 3e8}},
    }
    for name, value in figures.items():
        monkeypatch.setattr(bench, name, lambda *args, value=value: value)
    return bench


def test_the_figures_stand_under_the_names_that_others_read(measured, find_runtime):
    find_runtime("wasm")
    found = measured.cost()
    assert found["native"] == NATIVE
    assert found["heap_bytes_per_update"] == 0
    assert 0 < found["state_bytes"] <= 3072
    assert found["replay_samples_per_s"] == 2.5e6
    assert found["machine"]["numpy"]
    met = {limit["figure"]: limit["met"] for limit in found["limits"]}
    assert [figure for figure, kept in met.items() if not kept] == [
        "instructions against C -O2, Cortex-M0+, bursts",
        "cycles a sample in bursts",
    ]
    assert len(met) == 10


def test_what_cannot_be_measured_is_left_out_and_said(measured, monkeypatch):
    def missing(*args):
        raise MissingRuntime("no C compiler here")

    monkeypatch.setattr(bench, "native_cost", missing)
    found = measured.cost()
    assert found["native"] is None
    assert "Left out: native: no C compiler here" in in_markdown(found)


ONE_LIMITS = {"instructions": 480.0, "instructions_c": 470.0, "cycles": 480.0, "cycles_worst": 12e3}
BAD = {"instructions": 880.0, "instructions_c": 470.0, "cycles": 680.0, "cycles_worst": 18e3}


def native(**worse):
    """Good figures, or for thumb_alone, rv32_bursts, ... a bad one."""
    return {
        "native": {
            processor: {
                how: ONE_LIMITS | {name: BAD[name] for name in worse.get(f"{processor}_{how}", ())}
                for how in ("alone", "bursts")
            }
            for processor in ("thumb", "rv32")
        }
    }


GOOD = native() | {
    "heap_bytes_per_update": 0.0,
    "replay_samples_per_s": 2_500_000.0,
    "replay_by_hours": {"1": {"peak_bytes": 300e6}, "100": {"peak_bytes": 330e6}},
}


def met(found, limits=COST):
    return {verdict.limit.figure: verdict.met for verdict in verdicts(found, limits)}


def test_good_figures_meet_every_limit_of_cost():
    assert set(met(GOOD).values()) == {True}


@pytest.mark.parametrize(
    ("figure", "worse"),
    [
        (COST[0].figure, native(thumb_alone=["instructions"])),
        (COST[1].figure, native(thumb_bursts=["instructions"])),
        (COST[2].figure, native(rv32_alone=["instructions"])),
        (COST[3].figure, native(rv32_bursts=["instructions"])),
        (COST[4].figure, native(thumb_alone=["cycles"])),
        (COST[5].figure, native(thumb_alone=["cycles_worst"])),
        (COST[6].figure, native(thumb_bursts=["cycles"])),
        (COST[7].figure, {"heap_bytes_per_update": 0.1}),
        (COST[8].figure, {"replay_samples_per_s": 1_999_999.0}),
        (
            COST[9].figure,
            {"replay_by_hours": {"10": {"peak_bytes": 500e6}, "9": {"peak_bytes": 400e6}}},
        ),
    ],
)
def test_each_limit_of_cost_can_be_missed_and_alone_is(figure, worse):
    assert [name for name, is_met in met(GOOD | worse).items() if not is_met] == [figure]


def test_what_was_not_measured_is_neither_met_nor_missed():
    found = GOOD | {"native": None}
    assert met(found)[COST[0].figure] is None
    assert "not measured" in limits_table(verdicts(found, COST))


def test_a_missed_limit_stands_out_in_the_table():
    found = GOOD | native(thumb_bursts=["cycles"])
    assert "| 680 cycles | at most 500 cycles | **no** |" in limits_table(verdicts(found, COST))


def test_every_scenario_and_part_of_session_2_has_its_limit():
    figures = {
        f"warm-up-{name}": {"zerorate": {"all": everything, "first": first}}
        for name, everything, first in (("a", 1.1, 3.1), ("b", 3.6, 9.9), ("c", 13.9, 15.1))
    }
    found = met({"session_2_rms_mdps": figures}, ACCURACY)
    missed = [name for name, is_met in found.items() if not is_met]
    assert len(found) == 6
    assert missed == ["session 2, RMS, B", "session 2, first 15 s, A", "session 2, first 15 s, C"]


MOST_GROWTH = 1.2


@pytest.mark.parametrize("suffix", [".parquet", ".csv"])
def test_a_recording_ten_times_as_long_takes_no_more_memory(suffix):
    short, long = replay_speed((0.3, 3.0), suffix, runs=1).values()
    assert long["peak_bytes"] <= MOST_GROWTH * short["peak_bytes"]


def test_the_recording_is_as_long_as_asked_and_its_time_runs_on(tmp_path):
    path = tmp_path / "long.parquet"
    write_long(path, 1.2)
    t_us = pq.read_table(path, columns=["t_us"])["t_us"].to_numpy()
    assert len(t_us) == 432_000
    assert set(t_us[1:] - t_us[:-1]) == {10_000}
