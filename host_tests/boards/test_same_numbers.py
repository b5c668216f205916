"""Machine code on an emulated Pico gives what the kernels give on this host, to the last bit."""

import json
from dataclasses import replace

import numpy as np
import pytest
from zerorate_bench.boards.measuring import plays
from zerorate_bench.boards.playing import Play, on_host, on_pico
from zerorate_bench.workload import workload
from zerorate_tools.boards.connection import BoardError, connected
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


def test_the_board_is_asked_what_it_is(pico):
    facts = pico.flashed.facts
    assert (facts.machine, facts.architecture) == ("Raspberry Pi Pico with RP2040", "armv6m")
    assert facts.mpy[0] == 6
    assert facts.heap_free > 200_000 and facts.disk_free > 1_000_000


def test_forty_two_kilobytes_at_most_are_sent(pico):
    assert 10_000 < pico.flashed.sent_bytes <= 42 << 10


def test_flashing_again_sends_nothing(pico):
    assert flash(pico.port, say=lambda line: None).sent_bytes == 0


def test_a_board_with_little_heap_says_so_in_a_sentence(pico):
    hog = "import gc\ngc.collect()\nhog = bytearray(gc.mem_free() - 9000)\n"
    with connected(pico.port, go_on=False) as board:
        board.fs_writefile("boot.py", hog.encode())
    try:
        with pytest.raises(BoardError, match="too little heap free; .*boot.py"):
            flash(pico.port, parts=["motion"], say=lambda line: None)
    finally:
        with connected(pico.port, go_on=False) as board:
            board.exec("import os\nos.remove('boot.py')")


def test_power_cut_while_a_part_is_put_in_place_leaves_a_firmware_that_runs(pico, monkeypatch):
    erased = pico.ask("stat")["erases"]
    pico.cut_power_after(40)
    with monkeypatch.context() as patch:
        patch.setattr("zerorate_tools.boards.connection._LONG_S", 20)
        try:
            flash(pico.port, parts=["self-test"], say=lambda line: None)
        except Exception:  # what the cut does to a serial port is no one error
            pass
    assert pico.ask("stat")["cuts"] == 1 and pico.ask("stat")["erases"] > erased
    with connected(pico.port) as board:
        said = board.exec("from zerorate import Corrector; print(Corrector().source(0))")
    assert said.strip() == b"0"
    assert flash(pico.port, parts=["self-test"], say=lambda line: None).sent_bytes < 10_000
