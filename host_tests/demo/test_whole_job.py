"""`zerorate demo`: learn, close the loop, put what was found back on the chip, and say so.

What it prints is what docs/commands.md shows: host_tests/package runs it and compares.
"""

import re
import sys
from pathlib import Path

import pytest
from zerorate_tools import demo
from zerorate_tools.demo import story

from host_tests.docs.outputs import demo_shown


@pytest.fixture(scope="module")
def said(repository):
    return demo_shown(repository)


def figures(said, row):
    """The numbers of every line that begins with `row`."""
    lines = [line for line in said.splitlines() if line.strip().startswith(row)]
    return [[float(n) for n in re.findall(r"-?\d+\.\d", line.replace(",", ""))] for line in lines]


def test_what_nobody_told_the_firmware_is_found_and_named(said):
    assert "found: thermal-hysteresis (confirmed)" in said


def test_the_power_on_held_out_is_several_times_better(said):
    (before,), (after,) = figures(said, "before "), figures(said, "after  ")
    assert sum(after) < sum(before) / 4


def test_micropython_does_better_with_the_model(said):
    (without,), (with_it,) = figures(said, "without"), figures(said, "with it")
    assert sum(with_it[:3]) < sum(without) / 2


def test_micropython_and_this_computer_agree_in_all_three_runs(said):
    assert "equal to the last bit" in said
    assert "Final states equal to those of this computer: yes." in said


def test_each_users_next_command_is_said(said):
    for command in ("flash", "record", "import", "close"):
        assert f"zerorate {command} " in said
    assert "pydoc zerorate_fakes" in said


def test_commands_are_said_as_a_shell_finds_them(monkeypatch):
    own = Path(sys.executable).parent
    monkeypatch.chdir(own.parent)
    monkeypatch.setenv("PATH", "")
    assert f"  {own.name}/zerorate flash" in story.ending([(Path("a"), "b")])
    monkeypatch.setenv("PATH", str(own))
    assert "  zerorate flash" in story.ending([(Path("a"), "b")])


def test_an_interpreter_that_is_not_there_is_fetched(monkeypatch, tmp_path):
    from zerorate_tools.commands.demo import get_ready
    from zerorate_tools.errors import MissingRuntime

    monkeypatch.setenv("ZERORATE_CACHE", str(tmp_path))
    monkeypatch.setenv("PATH", "")
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    with pytest.raises(MissingRuntime, match="Node.js"):
        get_ready("wasm")


def test_nothing_found_is_said_as_such(tmp_path):
    device = demo.Device("plain", [tmp_path / "a.parquet", tmp_path / "b.parquet"], [], [])
    result = {"split": {"test": ["b"]}, "effects": []}
    result |= {f"{name}_mdps": [1.0, 2.0, 3.0] for name in ("before", "after", "floor")}
    assert "found: nothing" in story.chapter_two(device, result)
