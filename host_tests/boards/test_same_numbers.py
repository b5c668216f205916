"""Machine code on an emulated Pico gives what the kernels give on this host, to the last bit."""

import json
from dataclasses import replace

import numpy as np
import pytest
from zerorate_bench.boards.measuring import plays
from zerorate_bench.boards.playing import Play, on_host, on_pico
from zerorate_bench.workload import workload
from zerorate_tools.boards.flashing import flash

from host_tests.firmware import trace
from host_tests.firmware.trace_on_host import GOLDEN, checksums, corrector_for, frames

ROWS = 128


@pytest.fixture(scope="module")
def all_parts(pico):
    """The Pico with every part of the firmware."""
    flash(pico.port, say=lambda line: None, parts=["all"])
    return pico


@pytest.fixture(scope="module")
def modes():
    return plays(workload(ROWS))


@pytest.mark.parametrize("mode", ["rest", "bursts", "motion and gravity", "effects, refined"])
def test_rates_and_states_are_equal(all_parts, modes, mode):
    play = replace(modes[mode], rows=modes[mode].rows[:ROWS])
    played = on_pico(all_parts, play)
    assert len(played.cycles) == (ROWS // play.at_once if play.at_once else ROWS)
    assert played.data == on_host(play).data


@pytest.mark.parametrize("odr_hz", [12.5, 100.0, 1000 / 7, 500.0])
def test_a_board_computes_the_settings_of_this_host(all_parts, odr_hz):
    rows = np.zeros((1, 8), np.int32)
    for gyro, accel, temp in ((131.0, 16384.0, 340.0), (16.4, 2048.0, 326.8)):
        play = Play(rows, {}, sensor=(odr_hz, gyro, accel, temp, 36.53))
        assert on_pico(all_parts, play).data == on_host(play).data


def test_a_difference_in_one_sample_is_found(all_parts, modes):
    rows = modes["rest"].rows[:ROWS].copy()
    play = replace(modes["rest"], rows=rows)
    other = rows.copy()
    other[ROWS // 2, 5] += 1
    assert on_pico(all_parts, play).data != on_host(replace(play, rows=other)).data


def test_the_golden_trace_ends_in_the_committed_state(all_parts):
    mode = "ignoring"
    samples, dt_us = frames(trace.UPDATES[mode])
    rows = np.c_[dt_us, samples].astype(np.int32)
    options = {**trace.LIMITS, **trace.MODES[mode]}
    data = on_pico(all_parts, Play(rows, options, sensor=trace.SENSOR)).data
    state = data[-4 * len(corrector_for(mode).state) :]
    assert checksums(state, b"")["state"] == json.loads(GOLDEN.read_text())[mode]["state"]
