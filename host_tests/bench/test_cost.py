"""`zerorate bench cost`: every figure that it promises, and profiles read aright."""

import pytest
from zerorate_tools.bench import cost as bench
from zerorate_tools.bench.cost_report import in_markdown
from zerorate_tools.bench.viper_profile import own_costs
from zerorate_tools.errors import MissingRuntime

PROFILE = """\
ob=(1) /usr/bin/micropython
fn=(1)
0 100
cob=(2) ???
cfn=(2)
calls=1 0
0 900
0 20
ob=(2)
fn=(2)
0 700
cob=(1)
calls=1 0
0 200
"""
COUNTS = {"bytecode": 60_000.0, "viper": 3_000.0, "c": 300.0}


@pytest.fixture
def measured(monkeypatch):
    """The bench with its measures of minutes replaced by their figures."""
    figures = {
        "instructions_per_sample": COUNTS,
        "machine_code_per_sample": 2_100.0,
        "seconds_per_sample": {kind: count * 1e-9 for kind, count in COUNTS.items()},
        "worst_against_median": {"worst_us": 80.0, "median_us": 10.0, "ratio": 8.0},
        "mpy_sizes": {"bytecode": 50_000},
        "replay_speed": {"1": {"samples_per_s": 2.5e6, "peak_bytes": 3e8}},
    }
    for name, value in figures.items():
        monkeypatch.setattr(bench, name, lambda *args, value=value: value)
    return bench


def test_the_figures_stand_under_the_names_that_others_read(measured, find_runtime):
    find_runtime("wasm")
    found = measured.cost()
    assert found["instructions_per_sample"] == COUNTS
    assert found["heap_bytes_per_update"] == 0
    assert 0 < found["state_bytes"] <= 3072
    assert found["replay_samples_per_s"] == 2.5e6
    assert found["machine"]["numpy"]
    assert {limit["figure"]: limit["met"] for limit in found["limits"]} == {
        "viper against C -O2, instructions in bursts": False,
        "viper against bytecode, fewer in bursts": True,
        "worst sample against the median": True,
        "heap an update": True,
        "replay on one core": True,
        "replay's memory, longest against shortest": True,
        "viper against C -O2, alone": False,
        "viper against bytecode, fewer alone": True,
    }


def test_a_missed_bound_comes_with_what_the_profile_says(measured):
    said = in_markdown(measured.cost())
    assert "| 10.0 x | at most 4 x | **no** |" in said
    assert "70% of its instructions are machine code" in said
    assert "7.0 times C's" in said


def test_what_cannot_be_measured_is_left_out_and_said(measured, monkeypatch):
    def missing(*args):
        raise MissingRuntime("no C compiler here")

    monkeypatch.setattr(bench, "instructions_per_sample", missing)
    found = measured.cost()
    assert found["instructions_per_sample"] is None
    assert "Left out: instructions_per_sample: no C compiler here" in in_markdown(found)


def test_a_profile_is_read_without_what_is_called():
    assert own_costs(PROFILE.splitlines()) == {"/usr/bin/micropython": 120, "???": 700}
