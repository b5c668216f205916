"""`zerorate demo`: learn, close the loop, put what was found back on the chip, and say so.

What it prints is what docs/commands.md shows: host_tests/package runs it and compares.
"""

import re
import shutil
import socket
import sys
from pathlib import Path

import pytest
from zerorate_tools import demo
from zerorate_tools.cli import main
from zerorate_tools.demo import broad_trial, story
from zerorate_tools.demo import real as by_real
from zerorate_tools.demo.broad import trials
from zerorate_tools.demo.real import WAYS, real
from zerorate_tools.errors import CannotFetch
from zerorate_tools.runtimes import node

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


def test_commands_are_said_as_a_shell_finds_them(monkeypatch, tmp_path):
    own = Path(sys.executable).parent
    monkeypatch.chdir(own.parent)
    monkeypatch.setenv("PATH", "")
    assert f"  {own.name}/zerorate flash" in story.ending([(Path("a"), "b")])
    (tmp_path / "zerorate").symlink_to(own / "zerorate")
    for folder in (own, tmp_path):
        monkeypatch.setenv("PATH", str(folder))
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


NOBODY = "http://127.0.0.1:9/"


@pytest.fixture
def cache(tmp_path, monkeypatch):
    """A cache of this test's own."""
    monkeypatch.setenv("ZERORATE_CACHE", str(tmp_path))
    return tmp_path


@pytest.fixture
def filled(real_data, cache):
    """The cache with the trial in it, as if fetched."""
    (cache / "broad").mkdir()
    name = f"{broad_trial.NAME}.mat"
    shutil.copyfile(real_data / "broad" / name, cache / "broad" / name)
    return cache


@pytest.fixture(scope="module")
def shown(real_data, find_runtime):
    (trial,) = (t for t in trials(real_data / "broad") if t.name == broad_trial.NAME)
    return real(trial, find_runtime("x86").name)


def test_a_trial_in_the_cache_needs_no_network(filled):
    trial = broad_trial.broad_trial(NOBODY)
    assert trial.name == broad_trial.NAME
    assert len(trial.rate_dps) > 50_000


@pytest.fixture
def built_in(monkeypatch):
    """The runtimes on which the built-in device was shown."""
    shown_on = []
    job = lambda arguments: shown_on.append(arguments.runtime) or 0  # noqa: E731
    monkeypatch.setattr("zerorate_tools.commands.demo.run_job", job)
    return shown_on


@pytest.fixture
def silent_server():
    """The address of a server that takes connections and answers none."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        yield f"http://127.0.0.1:{server.getsockname()[1]}/"


def test_without_a_network_it_is_said_what_to_do_and_the_built_in_device_is_shown(
    cache, built_in, monkeypatch, capsys
):
    monkeypatch.setattr(broad_trial, "FOLDER_URL", NOBODY)
    assert main(["demo", "--real", "--runtime", "cpython"]) == 2
    line, instead = capsys.readouterr().err.splitlines()
    assert "is there a network?" in line and str(cache / "broad") in line
    assert "built-in" in instead and built_in == ["cpython"]


def test_a_server_that_never_answers_is_waited_for_aloud_and_not_for_long(
    cache, built_in, silent_server, monkeypatch, capsys
):
    monkeypatch.setattr(broad_trial, "FOLDER_URL", silent_server)
    monkeypatch.setattr(broad_trial, "_SILENT_S", 0.5)
    monkeypatch.setattr("zerorate_tools.progress.QUIET_S", 0.1)
    assert main(["demo", "--real", "--runtime", "cpython"]) == 2
    said = capsys.readouterr().err
    assert "s so far" in said and "is there a network?" in said and built_in == ["cpython"]
    assert list((cache / "broad").iterdir()) == []


def test_this_python_stands_in_for_a_micropython_that_cannot_be_fetched(
    cache, built_in, silent_server, monkeypatch, capsys
):
    monkeypatch.setattr(node, "_PATIENCE", ["--fetch-retries=0", "--fetch-timeout=500"])
    monkeypatch.setenv("npm_config_registry", silent_server)
    monkeypatch.setattr("zerorate_tools.progress.QUIET_S", 0.1)
    assert main(["demo"]) == 0
    said = capsys.readouterr().err
    assert "s so far" in said and "is there a network?" in said and built_in == ["cpython"]


def test_a_damaged_trial_is_fetched_again_and_never_used(filled):
    file = filled / "broad" / f"{broad_trial.NAME}.mat"
    file.write_bytes(file.read_bytes()[:-1] + b"x")
    with pytest.raises(CannotFetch, match="network"):
        broad_trial.broad_trial(NOBODY)


def test_nothing_is_left_in_the_cache_by_a_failure(cache):
    with pytest.raises(CannotFetch):
        broad_trial.broad_trial(NOBODY)
    assert list((cache / "broad").iterdir()) == []


def test_the_firmware_finds_the_bias_that_the_cameras_tell(shown):
    four_sigma_mdps = 4e3 * shown.truth.sigma_dps.max()
    assert shown.whole_mdps["zerorate, from rests"] < four_sigma_mdps
    # who was never at rest knows nothing from rests, and most of it from motion
    nothing, rests, motion = (shown.motion_mdps[way] for way in (WAYS[0], *WAYS[3:]))
    assert rests == nothing
    assert motion < nothing / 2


def test_the_command_credits_the_authors_and_prints_the_table(filled, shown, monkeypatch, capsys):
    monkeypatch.setattr("zerorate_tools.commands.demo.get_ready", lambda runtime: None)
    asked = []
    monkeypatch.setattr(by_real, "real", lambda *given: asked.append(given) or shown)
    assert main(["demo", "--real", "--runtime", "x86"]) == 0
    assert [(trial.name, runtime) for trial, runtime, _ in asked] == [(broad_trial.NAME, "x86")]
    said = capsys.readouterr().out
    assert "D. Laidig" in said and "CC BY 4.0" in said
    rows = [line for line in said.splitlines() if re.search(r"\d\.\d\s+[\d,]+\.\d$", line)]
    assert len(rows) >= len(WAYS) - 1
