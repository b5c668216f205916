"""`zerorate bench cost`: every figure that it promises."""

import pytest
from zerorate_bench import cost_report as bench
from zerorate_bench.cost_report import in_markdown
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
