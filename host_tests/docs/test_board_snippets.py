"""Every snippet of the documents on boards runs, and what it should learn it learns."""

import ast
import re
import subprocess
import sys
from pathlib import Path

import pytest
from zerorate_fakes import FakeClock, FakeI2C, FakeMPU6050
from zerorate_fakes.smbus import SMBus

HERE = Path(__file__).parent
DOCUMENTS = ("faults.md", "wiring.md", "pico.md", "raspberry-pi.md", "unit-tests.md")


def snippets(repository, document, language):
    text = (repository / "docs" / document).read_text()
    return re.findall(rf"```{language}\n(.*?)```", text, re.DOTALL)


def test_every_document_has_its_snippets(repository):
    count = {name: len(snippets(repository, name, "python")) for name in DOCUMENTS}
    some = {"pico.md": 2, "raspberry-pi.md": 1, "unit-tests.md": 5}
    assert count == {**dict.fromkeys(DOCUMENTS, 0), **some}


def test_the_example_is_the_one_in_the_document(repository):
    text = (repository / "examples" / "main.py").read_text()
    assert snippets(repository, "pico.md", "python")[0] == text
    assert len(text.splitlines()) <= 15


class TestPico:
    @pytest.fixture
    def run(self, repository, find_runtime):
        """run(snippet number, files) -> the result of thirty seconds on a board at rest."""

        def run(number, files=()):
            files_in = {"main.py": snippets(repository, "pico.md", "python")[number].encode()}
            folders = ("firmware", "drivers", "host_tests/fakes")
            return find_runtime("x86").run(
                HERE / "on_board.py",
                ["main.py", 30],
                modules=[repository / folder for folder in folders],
                files_in={**files_in, **dict(files)},
                files_out=["learned.bin"],
            )

        return run

    def test_the_example_takes_the_bias_off(self, run):
        result = run(0)
        rows = [[int(word) for word in line.split()] for line in result.stdout.splitlines()]
        assert len(rows) > 2900, result.stderr
        assert mean(rows[:20]) == pytest.approx([40, -25, 10], abs=3)
        assert mean(rows[-500:]) == pytest.approx([0, 0, 0], abs=1)

    def test_what_was_learned_is_kept_over_a_power_cut(self, run):
        first = run(1)
        assert first.stdout.splitlines()[0] == "nothing was ever stored", first.stderr
        second = run(1, {"learned.bin": first.files["learned.bin"]})
        assert second.stdout.splitlines()[0] == "loaded", second.stderr


def mean(rows):
    return [sum(row[axis] for row in rows) / len(rows) for axis in range(3)]


def test_the_raspberry_pi_snippet_corrects(repository, monkeypatch, capsys):
    smbus2 = pytest.importorskip("smbus2")
    samples = [
        [k % 7, k % 5, 16384 + k % 3, -3000, 40 + k % 3, -20, 10 + k % 2] for k in range(9999)
    ]
    chip = FakeMPU6050(samples)
    clock = FakeClock(chip)
    monkeypatch.setattr(smbus2, "SMBus", lambda number: SMBus(FakeI2C(chip)))
    monkeypatch.setattr("time.sleep", lambda seconds: clock.advance_us(int(seconds * 1e6)))
    for name in ("ticks_us", "ticks_diff", "ticks_add", "sleep_ms"):
        monkeypatch.setattr(f"zerorate_i2c.clock.{name}", getattr(clock, name))
    exec(snippets(repository, "raspberry-pi.md", "python")[0], {})
    rates_dps = ast.literal_eval(capsys.readouterr().out.splitlines()[0])
    assert rates_dps == pytest.approx([0, 0, 0], abs=0.02)


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
    assert "7 passed" in done.stdout


def test_a_typed_test_passes_the_strict_type_check(unit_tests):
    done = in_folder(unit_tests, "mypy", "--strict", "test_recording.py")
    assert done.returncode == 0, done.stdout
