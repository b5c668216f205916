"""The programs of docs/pico.md, word for word, on an emulated Pico with stock MicroPython."""

import re

import pytest
from zerorate_i2c.mpu6050 import MPU6050
from zerorate_tools.boards.connection import connected
from zerorate_tools.cli import main
from zerorate_tools.recordings import read_recording

from .conftest import Console
from .day import Day, passed

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


def test_the_second_program_keeps_what_it_learned_through_a_power_cut(pico, programs, start):
    console = start(programs[2])
    assert console.line_with("stored")
    assert console.line_with("kept")
    pico.ask("power")
    assert console.line_with("loaded")


def test_the_yaw_that_is_printed_stands_still_with_the_bias_taken_off(pico, programs, start):
    console = start(programs[1])
    for _ in range(15):
        without, corrected = re.search(
            r"without (\S+)  with (\S+) deg", console.line_with("yaw")
        ).groups()
    assert float(without) == pytest.approx(15 * BIAS_DPS[2], abs=0.2)
    assert abs(float(corrected)) < 0.2


def test_a_recording_is_made_and_the_firmware_watched(pico, tmp_path, capsys):
    out = tmp_path / "run.parquet"
    setup = tmp_path / "pins.py"
    setup.write_text("from zerorate_i2c.board import setup\nimu = setup(scl=5, sda=4)\n")
    options = ["--seconds", "3", "--setup", str(setup)]
    assert main(["record", pico.port, "--out", str(out), *options]) == 0
    recording = read_recording(out)
    assert len(recording.columns["gx"]) > 10
    assert recording.columns["gx"].mean() == pytest.approx(40, abs=3)
    assert main(["watch", pico.port, "--for", "3", "--setup", str(setup)]) == 0
    assert "bias dps" in capsys.readouterr().out


@pytest.mark.parametrize("command", ["flash", "flash --dry-run", "record", "watch"])
def test_after_each_command_the_program_runs_again_at_a_friendly_prompt(
    pico, programs, start, tmp_path, command
):
    start(programs[0]).close()
    arguments = [*command.split(), pico.port]
    if command == "record":
        arguments += ["--out", str(tmp_path / "run.csv")]
    if command in ("record", "watch"):
        arguments += ["--seconds" if command == "record" else "--for", "2"]
    assert main(arguments) == 0
    console = Console(pico.port)
    try:
        assert next(rates(console))
        console.press(b"\x03")
        assert "KeyboardInterrupt" in console.line_with("KeyboardInterrupt")
        console.press(b"\x04")
        assert console.line_with("soft reboot")
        assert next(rates(console))
        assert not any("raw REPL" in line for line in console.said)
    finally:
        console.close()


def seven_minutes():
    """What came of a reset or an unplugging every quarter of a minute, while the bias drifts."""
    return Day(hours=0.12, resets=14, unplugs=14, odr_hz=10, seed=1, drift_dps_per_h=2.0).run()


def test_rates_are_corrected_again_within_three_seconds_of_each_reset_and_unplugging():
    found = seven_minutes()
    assert found["resets"] == found["unplugs"] == 14
    assert found["lines"] > 400
    assert passed(found), found


def test_the_judge_notices_a_driver_that_never_looks_whether_the_chip_was_reset(monkeypatch):
    monkeypatch.setattr(MPU6050, "doubt", lambda self, frozen: None)
    monkeypatch.setattr(MPU6050, "check", lambda self: True)
    assert not passed(seven_minutes())
