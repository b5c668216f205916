"""Every program of the documents is an example that does what it says; so is the notebook."""

import ast
import contextlib
import io
import math
import os
import random
import re
import subprocess
import sys
import types
from pathlib import Path

import numpy as np
import pytest
import zerorate_tools as zt
from zerorate_fakes import FakeClock
from zerorate_tools.cli import main
from zerorate_tools.recordings import Recording, Scales

from host_tests.docs.outputs import blocks

HERE = Path(__file__).parent
#: Examples that each document shows, in their order.
SHOWN = {
    "faults.md": [],
    "wiring.md": [],
    "pico.md": ["main.py", "keep.py", "interrupt.py", "pins.py"],
    "raspberry-pi.md": ["raspberry_pi.py"],
    "linux-service.md": [],
    "any-imu.md": ["bmi160.py", "lsm6dso.py", "bmi270.py"],
}
BIAS_DPS = [0.31, -0.19, 0.08]
LINE = r"before (\S+) (\S+) (\S+)  after (\S+) (\S+) (\S+) dps"


def snippets(repository, document, language="python"):
    text = (repository / "docs" / document).read_text()
    return re.findall(rf"```{language}\n(.*?)```", text, re.DOTALL)


@pytest.mark.parametrize("document", SHOWN)
def test_every_program_of_a_document_is_an_example(repository, document):
    shown = [(repository / "examples" / name).read_text() for name in SHOWN[document]]
    assert snippets(repository, document) == shown


def rows(printed):
    """(n, 6) numbers of the lines that an example prints once a second."""
    return [[float(word) for word in found] for found in re.findall(LINE, printed)]


def takes_the_bias_off(printed):
    before, after = rows(printed)[0], rows(printed)[-1]
    assert before[:3] == pytest.approx(BIAS_DPS, abs=0.02)
    assert after[:3] == pytest.approx(BIAS_DPS, abs=0.02)
    assert after[3:] == pytest.approx([0, 0, 0], abs=0.02)


@pytest.fixture
def run(repository, find_runtime):
    """run(example, files, scl, sda, interrupt, seconds, setup) -> the result on a board at rest."""

    def run(example, files=(), scl=5, sda=4, interrupt=6, seconds=30, setup=b""):
        text = (
            (repository / "examples" / example).read_bytes().replace(b"sda=4)", b"sda=4%b)" % setup)
        )
        return find_runtime("x86").run(
            HERE / "on_board.py",
            ["main.py", seconds, scl, sda, interrupt],
            modules=[repository / folder for folder in ("firmware", "drivers", "host_tests/fakes")],
            files_in={"main.py": text, **dict(files)},
            files_out=["learned.bin"],
            check=True,
        )

    return run


class TestOnABoard:
    def test_four_wires_show_the_rates_before_and_after(self, run):
        result = run("main.py", interrupt=-1, setup=b", odr_hz=150")  # a thousand by seven
        assert len(rows(result.stdout)) == 29, result.stderr
        takes_the_bias_off(result.stdout)

    def test_yaw_stands_with_the_bias_taken_off_and_drifts_without(self, run):
        found = re.findall(r"yaw without (\S+)  with (\S+) deg", run("yaw.py", interrupt=-1).stdout)
        assert len(found) == 29
        without, corrected = map(float, found[-1])
        assert without == pytest.approx(29 * BIAS_DPS[2], abs=0.2)
        assert abs(corrected) < 0.1 * without

    def test_what_was_learned_is_kept_over_a_power_cut(self, run):
        first = run("keep.py", interrupt=-1)
        assert first.stdout.splitlines()[1:3] == ["nothing was ever stored", "kept"], first.stderr
        second = run(
            "keep.py", {"learned.bin": first.files["learned.bin"]}, interrupt=-1, seconds=1
        )
        assert second.stdout.splitlines()[:2] == ["found: MPU-6050", "loaded"], second.stderr

    def test_what_cannot_be_kept_is_said_once_an_hour(self, run):
        said = run("keep.py", {"learned.bin/in_its_place": b""}, interrupt=-1).stdout
        assert said.splitlines()[2:] == ["learned.bin: cannot be written; is there room?"]

    def test_with_int_every_sample_is_corrected(self, run):
        printed = run("interrupt.py").stdout.splitlines()[1:]
        rates = [[float(word) for word in line.removesuffix(" dps").split()] for line in printed]
        assert len(rates) > 2900
        last = [sum(row[axis] for row in rates[-500:]) / 500 for axis in range(3)]
        assert last == pytest.approx([0, 0, 0], abs=0.008)

    def test_without_int_it_says_what_is_missing(self, run):
        result = run("interrupt.py", interrupt=-1)
        assert "no pulse on INT" in result.stdout and "take main.py" in result.stdout

    def test_other_pins_are_said_once(self, run):
        assert run("pins.py", scl=22, sda=21).stdout == ""


ON_LINUX = """
import time, smbus2, zerorate_i2c.clock
from zerorate_fakes import FakeClock, FakeI2C, FakeMPU6050, Physical
from zerorate_fakes.smbus import SMBus

def at_rest(now):
    if now > {seconds}:
        raise KeyboardInterrupt
    if now >= 20 and pulled_out:
        bus.fault("nack", times=30)
        pulled_out.clear()
    return {bias}

pulled_out = [True]
chip = FakeMPU6050(Physical(gyro_dps=at_rest))
clock = FakeClock(chip)
bus = FakeI2C(chip)
smbus2.SMBus = lambda number: SMBus(bus)
time.sleep = lambda seconds: clock.advance_us(int(seconds * 1e6))
for name in ("ticks_us", "ticks_diff", "ticks_add", "sleep_ms"):
    setattr(zerorate_i2c.clock, name, getattr(clock, name))
try:
    exec(open({example!r}).read(), {{}})
except KeyboardInterrupt:
    print("ended")
"""


@pytest.fixture
def power_on(repository, tmp_path):
    """power_on(seconds) -> what the example printed, in a process that has its own clock."""
    pytest.importorskip("smbus2")
    example = str(repository / "examples" / "raspberry_pi.py")

    def power_on(seconds, **more):
        program = ON_LINUX.format(seconds=seconds, bias=BIAS_DPS, example=example)
        command = [sys.executable, "-c", program]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, **more)
        assert done.stdout.endswith("ended\n"), done.stderr
        return done.stdout

    return power_on


def test_on_linux_it_goes_on_with_what_was_learned(repository, power_on):
    first, second = power_on(40), power_on(5)
    shown = snippets(repository, "raspberry-pi.md", "text")[-1]
    assert first.startswith(shown) and "bus: " in first
    takes_the_bias_off(first)
    assert second.startswith("loaded")
    assert rows(second)[0][3:] == pytest.approx([0, 0, 0], abs=0.02)


def test_on_linux_a_full_disk_is_said_and_the_rates_go_on(power_on):
    limits = pytest.importorskip("resource")  # no file may grow, which is not a pipe's business
    full = limits.RLIMIT_FSIZE, (0, 0)
    said = power_on(15, preexec_fn=lambda: limits.setrlimit(*full))
    assert said.count("learned.bin: cannot be written; is there room?") == 1
    takes_the_bias_off(said)


def test_a_recording_without_a_chip_ends_with_the_line_of_the_page(
    repository, tmp_path, monkeypatch, capsys
):
    page = (repository / "docs" / "raspberry-pi.md").read_text()
    (command,) = re.findall(r"^zerorate (record .*)$", page, re.MULTILINE)
    monkeypatch.chdir(tmp_path)
    assert main(command.replace("/dev/i2c-1", "fake:").split()) == 0
    assert capsys.readouterr().out == snippets(repository, "raspberry-pi.md", "text")[0]


class OtherChip:
    """Stands for a driver whose chip nobody here has: what it gives, a hundred times a second."""

    def __init__(self, *bus):
        self.left = 3000
        self.noise = random.Random(1)

    def getMotion6(self):
        rates = [round(131.2 * (bias + self.noise.gauss(0, 0.05))) for bias in BIAS_DPS]
        return (*rates, 0, 0, 16384 + self.noise.randrange(40))

    def getTemperature(self):
        self.left -= 1
        if not self.left:
            raise KeyboardInterrupt
        return 25.0

    def setFullScaleGyroRange(self, code, dps):
        assert (code, dps) == (3, 250)

    @property
    def gyro(self):
        self.getTemperature()
        return tuple(math.radians(word / 131.2) for word in self.getMotion6()[:3])

    @property
    def acceleration(self):
        return (0.0, 0.0, 9.81 + self.noise.gauss(0, 0.01))


@pytest.mark.parametrize("example, unit", [("bmi160.py", 1.0), ("lsm6dso.py", math.pi / 180)])
def test_beside_another_driver_the_bias_goes(example, unit, repository, monkeypatch, capsys):
    modules = {
        "BMI160_i2c": {"Driver": OtherChip},
        "board": {"I2C": object},
        "adafruit_lsm6ds": {},
        "adafruit_lsm6ds.lsm6dsox": {"LSM6DSOX": OtherChip},
    }
    for name, words in modules.items():
        monkeypatch.setitem(sys.modules, name, types.SimpleNamespace(**words))
    clock = FakeClock()
    monkeypatch.setattr("time.sleep", lambda seconds: clock.advance_us(round(seconds * 1e6)))
    monkeypatch.setattr("time.monotonic", lambda: clock.now_us / 1e6)
    monkeypatch.setattr("time.monotonic_ns", lambda: clock.now_us * 1000)
    with pytest.raises(KeyboardInterrupt):
        exec(compile((repository / "examples" / example).read_text(), example, "exec"), {})
    lines = [line for line in capsys.readouterr().out.splitlines() if line[0] in "[("]
    rates = [ast.literal_eval(line) for line in lines]
    # the first bias is known after 80 ms
    for part, left, within in ((rates[:7], BIAS_DPS, 0.06), (rates[-500:], [0, 0, 0], 0.02)):
        means = [sum(row[axis] for row in part) / len(part) / unit for axis in range(3)]
        assert means == pytest.approx(left, abs=within)


def test_a_chip_of_ones_own_is_a_table_and_its_bias_is_found(repository):
    program = str(repository / "examples" / "bmi270.py")
    done = subprocess.run([sys.executable, program], capture_output=True, text=True, check=True)
    assert done.stdout in snippets(repository, "any-imu.md", "text")
    found = ast.literal_eval(done.stdout.partition(": ")[2])
    assert found == pytest.approx([0.5, -0.3, 0.1], abs=0.005)


@pytest.fixture
def unit_tests(repository, tmp_path):
    """The files that the page on unit tests shows, in a folder of their own."""
    for text in snippets(repository, "unit-tests.md", "python"):
        (tmp_path / text.split("\n")[0].removeprefix("# ")).write_text(text)
    (tmp_path / "pytest.ini").write_text("[pytest]\n")
    return tmp_path


def in_folder(folder, *words):
    """What a command of this environment does in `folder`, which knows nothing of this project."""
    command = [sys.executable, "-m", *words]
    return subprocess.run(command, capture_output=True, text=True, cwd=folder)


def test_the_snippets_for_pytest_pass(unit_tests):
    plugin = ["-p", "zerorate_fakes.pytest_plugin"]
    done = in_folder(unit_tests, "pytest", "-q", *plugin, "-p", "no:cacheprovider")
    assert done.returncode == 0, done.stdout
    assert "9 passed" in done.stdout


def test_a_typed_test_passes_the_strict_type_check(unit_tests):
    done = in_folder(unit_tests, "mypy", "--strict", "test_recording.py")
    assert done.returncode == 0, done.stdout


@pytest.fixture(scope="module")
def ran(repository, tmp_path_factory):
    """(what each cell printed, the names that the cells left, their folder)."""
    folder = tmp_path_factory.mktemp("notebook")
    names, printed = {}, []
    with inside(folder):
        for cell in blocks(repository / "docs" / "notebook.md", "python"):
            out = io.StringIO()
            with contextlib.redirect_stdout(out):
                exec(cell.text, names)
            printed.append(out.getvalue())
    return printed, names, folder


@contextlib.contextmanager
def inside(folder):
    """contextlib.chdir, which Python 3.10 lacks."""
    before = os.getcwd()
    os.chdir(folder)
    try:
        yield
    finally:
        os.chdir(before)


def test_what_was_hidden_is_found(ran):
    printed, names, _ = ran
    assert names["found"]["effects"][0]["effect"] == "thermal-hysteresis"
    assert sum(names["found"]["after_mdps"]) < sum(names["found"]["before_mdps"])
    assert names["better"].samples == len(zt.read_recording(ran[2] / "run-4.parquet"))


def test_the_plot_is_a_page_with_three_axes_and_the_temperature(ran):
    _, names, folder = ran
    assert {"gx", "gy", "gz", "temperature"} <= {trace.name for trace in names["figure"].data}
    assert "plotly" in (folder / "bias.html").read_text(encoding="utf-8")


def test_an_error_is_a_line_with_the_file(ran):
    assert "no-such.parquet" in ran[0][-1]
    assert len(ran[0][-1].splitlines()) == 1


def test_a_recording_without_temperature_has_a_plot_of_one_panel():
    columns = {name: np.arange(500, dtype=np.int32) % 3 for name in ("gx", "gy", "gz")}
    columns["t_us"] = np.arange(500, dtype=np.int64) * 10_000
    recording = Recording(columns, Scales("X", 100.0, 131.0), "bare")
    figure = zt.plot_replay(recording, zt.replay_recording(recording, runtime="cpython"))
    assert "temperature" not in {trace.name for trace in figure.data}


def test_a_replay_that_went_to_a_file_says_where_its_table_is(ran, tmp_path):
    done = zt.replay_recording(ran[2] / "run-1.parquet", tmp_path / "out.parquet")
    with pytest.raises(ValueError, match="read_parquet"):
        done.to_frame()
