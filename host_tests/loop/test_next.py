"""What a report asks for next: recordings of one device, over the whole range of temperature."""

from dataclasses import replace

import numpy as np
import pytest
from zerorate_tools.bench.loop.simulated import simulate
from zerorate_tools.closing import load
from zerorate_tools.loop.analyse import analyse
from zerorate_tools.loop.report.report import report
from zerorate_tools.loop.report.unexplained import _unrecorded, measure_next
from zerorate_tools.recordings import Recording, Scales, write_recording

N, HZ = 3000, 5.0
MPU = Scales("MPU-6050", HZ, 131.0, 16384.0, 340.0, 36.53)


def at_rest(seed, bias_lsb=30, middle_degc=25.0, **more):
    """Ten minutes, the temperature going up and down by 4 degC."""
    rng, at = np.random.default_rng(seed), np.arange(N)
    degc = middle_degc + 4 * np.sin(at / N * 6 + seed)
    return {
        "t_us": (at * 1e6 / HZ).astype(np.int64),
        **{a: np.rint(rng.normal(bias_lsb, 4, N)).astype(np.int32) for a in ("gx", "gy", "gz")},
        **{a: np.rint(rng.normal(g, 60, N)) for a, g in (("ax", 0), ("ay", 0), ("az", 16384))},
        "temp": np.rint((degc - 36.53) * 340).astype(np.int32),
        **more,
    }


@pytest.fixture
def closed(tmp_path):
    """Loop over recordings given as columns."""

    def run(*every, scales=MPU):
        paths = [tmp_path / f"s{i}.parquet" for i in range(len(every))]
        for path, one in zip(paths, every):
            write_recording(Recording(one, scales, path.stem), path)
        return load(paths)

    return run


def test_recordings_that_begin_far_apart_are_asked_whether_they_are_of_one_device(closed):
    asked = measure_next(closed(at_rest(0), at_rest(1), at_rest(2, bias_lsb=160)))
    assert "of one device: s2 begins 1.2 dps away from what the others taught" in asked[0]


def test_temperatures_that_nothing_fitted_has_seen_are_asked_for(closed):
    asked = measure_next(closed(at_rest(0), at_rest(1), at_rest(2, middle_degc=40.0)))
    assert "s2 goes from 36 to 44 degC, what was fitted from 21 to 29" in asked[0]


def test_of_recordings_alike_neither_is_asked(closed):
    asked = " ".join(measure_next(closed(*(at_rest(i) for i in range(3)))))
    assert "one device" not in asked and "whole range" not in asked


def test_what_an_import_declares_a_reference_is_no_channel(closed):
    declared = replace(MPU, more={"channels": {"moving": {"role": "reference"}, "odd": None}})
    wander = np.cumsum(np.random.default_rng(5).normal(0, 3, N)).astype(np.int32)
    analysis = closed(*(at_rest(i, moving=wander) for i in range(3)), scales=declared)
    assert "moving" not in analysis.sessions[0].sources and analysis.gate.dropped == {}


def test_one_recording_alone_speaks_of_its_pieces(closed):
    result = report(closed(at_rest(0)))
    assert not any("sessions" in why for _, why in result["gate"]["considered_and_refused"])


@pytest.mark.parametrize(
    ("course", "asked"),
    [
        ([52, -18, 74, 36], None),
        ([20, 60], "a cool-down at the same rate as the warm-up"),
        ([60, 20], "a warm-up at the same rate as the cool-down"),
    ],
)
def test_a_course_that_is_there_is_not_asked_for(course, asked):
    (session,) = simulate(1, sessions=1).sessions
    places = np.linspace(0, 1, len(course))
    at = np.linspace(0, 1, len(session.sources["temp"]))
    session.sources["temp"] = np.interp(at, places, course)
    told = [t for t in measure_next(analyse([session])) if "at the same rate" in t]
    assert [t.split(" (")[0] for t in told] == ([asked] if asked else [])


def test_a_humidity_that_is_there_is_not_asked_for():
    assert "humidity" in _unrecorded(["temp"]) and "board temperature" in _unrecorded(["temp"])
    assert _unrecorded(["temp", "humidity_mpct", "aht_temp_mdegc"]) == "one screw loosened"
