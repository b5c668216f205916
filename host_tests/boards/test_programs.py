"""The programs of docs/pico.md, word for word, on an emulated Pico with stock MicroPython."""

import re
import time
from contextlib import suppress
from dataclasses import replace

import numpy as np
import pytest
import serial
from zerorate_bench.boards.measuring import LIMITS, plays
from zerorate_bench.boards.pico import EmulatedPico, Play, on_host, on_pico
from zerorate_bench.workload import workload
from zerorate_tools.boards.connection import BoardError, connected
from zerorate_tools.boards.flashing import flash
from zerorate_tools.cli import main
from zerorate_tools.recordings import read_recording

from host_tests.firmware import trace
from host_tests.firmware.trace_on_host import checksums, corrector_for, frames, golden

from .day import Day, passed

# The board's own seconds are a fraction of these where the machine is free.
PATIENCE_S = 240


class Console:
    """Lines that the board prints, and keys to it."""

    def __init__(self, port):
        self._serial = serial.Serial(port, timeout=0.2)
        self._rest = b""
        self.said = []

    def close(self):
        self._serial.close()

    def press(self, keys):
        """Send bytes as a terminal does."""
        self._serial.write(keys)

    def lines(self):
        """Whole lines, for as long as the board prints any in time."""
        until = time.monotonic() + PATIENCE_S
        while time.monotonic() < until:
            *whole, self._rest = (self._rest + self._serial.read(4096)).split(b"\n")
            for line in whole:
                self.said.append(line.decode(errors="replace").strip())
                yield self.said[-1]
        raise AssertionError(f"after {self.said} the board said no more than {self._rest!r}")

    def line_with(self, word):
        """The next line in which the word is."""
        return next(line for line in self.lines() if word in line)


@pytest.fixture(scope="session")
def flashed_pico(pico_parts, tmp_path_factory):
    """A Pico that was flashed with the rest path; port: a symbolic link to its serial device."""
    link = tmp_path_factory.mktemp("run") / "tty-a"
    with EmulatedPico(pico_parts, link=link) as board:
        board.flashed = flash(board.port, say=lambda line: None)
        yield board


@pytest.fixture(scope="module")
def pico(flashed_pico):
    """The same, which runs for this module alone: an idle board takes a whole processor."""
    flashed_pico.resume()
    yield flashed_pico
    flashed_pico.pause()


RATES = re.compile(r"before (\S+) (\S+) (\S+)  after (\S+) (\S+) (\S+) dps")
BIAS_DPS = [40 / 131, -25 / 131, 10 / 131]


@pytest.fixture(scope="module")
def programs(repository):
    """The programs as the page has them, in its order."""
    return re.findall(r"```python\n(.*?)```", (repository / "docs/pico.md").read_text(), re.DOTALL)


@pytest.fixture
def start(pico):
    """start(program) -> the board's console, with the program as its main.py after a power-on."""
    opened = []

    def start(program):
        with connected(pico.port, go_on=False) as board:
            board.fs_writefile("main.py", program.encode(), chunk_size=1024)
        opened.append(Console(pico.port))
        pico.ask("power")
        return opened[-1]

    yield start
    for console in opened:
        console.close()


def rates(console):
    """Lists of three rates before and three after, once a second of the board."""
    for line in console.lines():
        if found := RATES.search(line):
            numbers = [float(word) for word in found.groups()]
            yield numbers[:3], numbers[3:]


def learned(console):
    """Wait until the rates come without their bias."""
    for before, after in rates(console):
        assert before == pytest.approx(BIAS_DPS, abs=0.02)
        if after == pytest.approx([0, 0, 0], abs=0.01):
            return
    raise AssertionError("nothing was learned")


def test_the_first_program_learns_and_goes_on_after_every_fault_of_the_sensor(
    pico, programs, start
):
    console = start(programs[0])
    learned(console)
    pico.ask("brownout")
    learned(console)
    pico.ask("dead", dead=True)
    console.line_with("bus:")
    pico.ask("brownout")
    pico.ask("dead", dead=False)
    learned(console)


def test_after_each_command_the_program_runs_again_at_a_friendly_prompt(
    pico, programs, start, tmp_path, capsys
):
    start(programs[0]).close()
    out, setup = tmp_path / "run.parquet", tmp_path / "pins.py"
    setup.write_text("from zerorate_i2c.board import setup\nimu = setup(scl=5, sda=4)\n")
    for command, words in (
        ("flash", []),
        ("record", ["--out", str(out), "--seconds", "1", "--setup", str(setup)]),
        ("watch", ["--for", "1", "--setup", str(setup)]),
    ):
        assert main([command, pico.port, *words]) == 0
        console = Console(pico.port)
        try:
            assert next(rates(console))
            console.press(b"\x03")
            assert "KeyboardInterrupt" in console.line_with("KeyboardInterrupt")
            console.press(b"\x04")
            assert console.line_with("soft reboot")
            assert not any("raw REPL" in line for line in console.said), command
        finally:
            console.close()
    recording = read_recording(out)
    assert len(recording.columns["gx"]) > 10
    assert recording.columns["gx"].mean() == pytest.approx(40, abs=3)
    assert "bias dps" in capsys.readouterr().out


def test_rates_are_corrected_again_within_three_seconds_of_each_reset_and_unplugging():
    """While the bias drifts, one every quarter of a minute."""
    found = Day(hours=0.12, resets=14, unplugs=14, odr_hz=10, seed=1, drift_dps_per_h=2.0).run()
    assert found["resets"] == found["unplugs"] == 14
    assert found["lines"] > 400
    assert passed(found), found


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


ROWS = 128


@pytest.fixture(scope="module")
def all_parts(pico):
    """The Pico with every part of the firmware; the power was cut when they were sent first.

    after_cut: what a program printed then; flashed: what was sent the second time.
    """
    with connected(pico.port, go_on=False) as board:  # what prints for ever is read for ever
        board.exec("import os\nif 'main.py' in os.listdir(): os.remove('main.py')")
    before = pico.ask("stat")
    pico.cut_power_after(40)

    class UntilCut(float):
        """Seconds that a silent board is waited for; none once its power was cut."""

        def __radd__(self, begun):
            return begun + (0.0 if pico.ask("stat")["cuts"] else float(self))

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("zerorate_tools.boards.connection._LONG_S", UntilCut(20))
        with suppress(Exception):  # what the cut does to a serial port is no one error
            flash(pico.port, parts=["all"], say=lambda line: None)
    after = pico.ask("stat")
    assert after["cuts"] == 1 and after["erases"] > before["erases"]
    with connected(pico.port) as board:
        pico.after_cut = board.exec("from zerorate import Corrector; print(Corrector().source(0))")
    pico.flashed = flash(pico.port, parts=["all"], say=lambda line: None)
    return pico


def test_power_cut_while_parts_are_sent_leaves_a_firmware_that_runs(all_parts):
    assert all_parts.after_cut.strip() == b"0"
    assert all_parts.flashed.sent_bytes < all_parts.flashed.total - 20_000  # what it has, it keeps


@pytest.fixture(scope="module")
def modes():
    return plays(workload(ROWS))


@pytest.mark.parametrize("mode", ["rest", "bursts", "motion and gravity", "effects, refined"])
def test_rates_and_states_are_equal(all_parts, modes, mode):
    play = replace(modes[mode], rows=modes[mode].rows[:ROWS])
    played = on_pico(all_parts, play)
    assert len(played.cycles) == (ROWS // play.at_once if play.at_once else ROWS)
    assert played.data == on_host(play).data


def test_a_sample_of_a_burst_takes_no_more_cycles_than_its_limit(all_parts):
    played = on_pico(all_parts, plays(workload())["bursts"])
    limit = next(limit for limit in LIMITS if "bursts" in limit.figure)
    assert sum(played.cycles) / len(played.cycles) / 64 <= limit.bound


def test_a_board_computes_the_settings_of_this_host(all_parts):
    rows = np.zeros((1, 8), np.int32)
    play = Play(rows, {}, sensor=(1000 / 7, 16.4, 2048.0, 326.8, 36.53))
    assert on_pico(all_parts, play).data == on_host(play).data


def test_the_golden_trace_ends_in_the_committed_state(all_parts):
    mode = "ignoring"
    samples, dt_us = frames(trace.UPDATES[mode])
    rows = np.c_[dt_us, samples].astype(np.int32)
    options = {**trace.LIMITS, **trace.MODES[mode]}
    data = on_pico(all_parts, Play(rows, options, sensor=trace.SENSOR)).data
    state = data[-4 * len(corrector_for(mode).state) :]
    assert checksums(state, b"")["state"] == golden(mode)["state"]


def test_what_the_own_program_learned_is_watched_and_not_replaced(
    pico, programs, start, tmp_path, capsys
):
    explains = "    if count >= imu.odr_hz:\n        print(corrector.corrector.explain())\n"
    console = start(programs[0].replace("    if count >= imu.odr_hz:\n", explains))
    learned(console)
    console.close()
    picture = tmp_path / "own.png"
    assert main(["watch", pico.port, "--own", "--for", "3", "--plot", str(picture)]) == 0
    x_dps, source = re.search(r"x (\S+)±\S+ (\S+)", capsys.readouterr().out).groups()
    assert float(x_dps) == pytest.approx(BIAS_DPS[0], abs=0.02)
    assert source in ("any-temperature", "fit", "this-temperature")
    assert picture.read_bytes().startswith(b"\x89PNG")
    console = Console(pico.port)
    try:
        _, after = next(rates(console))
        assert after == pytest.approx([0, 0, 0], abs=0.02)
        assert not any("reboot" in line or "found:" in line for line in console.said)
    finally:
        console.close()
