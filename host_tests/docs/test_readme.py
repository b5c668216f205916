"""The README's programs for each user do what they say, and its commands are commands."""

import re
import subprocess
import sys
from pathlib import Path

import pytest
from zerorate_fakes import FakeClock, FakeI2C, FakeMPU6050
from zerorate_fakes.smbus import SMBus
from zerorate_tools import __version__

from host_tests.docs.pages import blocks

HERE = Path(__file__).parent


@pytest.fixture
def programs(repository):
    """The README's Python blocks: for a board, for Linux, for a test suite."""
    board, linux, suite = (block.text for block in blocks(repository / "README.md", "python"))
    return {"board": board, "linux": linux, "suite": suite}


def test_the_program_for_a_board_reads_and_corrects(programs, repository, find_runtime):
    folders = ("firmware", "drivers", "host_tests/fakes")
    done = find_runtime("x86").run(
        HERE / "on_board.py",
        ["main.py", 10, 5, 4, -1],
        modules=[repository / folder for folder in folders],
        files_in={"main.py": (programs["board"] + "print(imu.part, sample[2] > 16000)\n").encode()},
        check=True,
    )
    assert done.stdout.split() == ["MPU-6050", "True"]


def test_the_program_for_linux_takes_the_bias_off(programs, monkeypatch):
    smbus2 = pytest.importorskip("smbus2")
    samples = [[0, k % 5, 16384, -3000, 40 + k % 3, -20, 10 + k % 2] for k in range(3000)]
    chip = FakeMPU6050(samples)
    clock = FakeClock(chip)
    seconds = []

    def slept(s):
        seconds.append(s)
        if sum(seconds) > 20:
            raise KeyboardInterrupt
        clock.advance_us(int(s * 1e6))

    monkeypatch.setattr(smbus2, "SMBus", lambda number: SMBus(FakeI2C(chip)))
    monkeypatch.setattr("time.sleep", slept)
    for name in ("ticks_us", "ticks_diff", "ticks_add", "sleep_ms"):
        monkeypatch.setattr(f"zerorate_i2c.clock.{name}", getattr(clock, name))
    names = {}
    with pytest.raises(KeyboardInterrupt):
        exec(compile(programs["linux"], "README.md", "exec"), names)
    assert names["corrector"].bias_lsb(0) == pytest.approx(41, abs=0.5)
    assert list(names["sample"])[4:] == pytest.approx([0, 0, 0], abs=2)


def test_the_program_for_a_test_suite_passes(programs, tmp_path):
    (tmp_path / "test_snippet.py").write_text(programs["suite"])
    (tmp_path / "pytest.ini").write_text("[pytest]\n")
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path)
    assert "1 passed" in done.stdout, done.stdout


def test_the_wheel_that_is_named_is_of_this_version(repository):
    named = 0
    for page in (repository / "README.md", *(repository / "docs").glob("*.md")):
        versions = re.findall(r"zerorate-([\d.]+)-py3-none-any.whl", page.read_text("utf-8"))
        assert set(versions) <= {__version__}, page.name
        named += len(versions)
    assert named


def test_every_make_target_that_is_named_is_one(repository):
    targets = set(re.findall(r"^([a-z-]+):", (repository / "Makefile").read_text(), re.MULTILINE))
    for page in (repository / "README.md", repository / "docs" / "README.md"):
        named = re.findall(r"`make ([a-z-]+)`", page.read_text(encoding="utf-8"))
        assert named and set(named) <= targets
