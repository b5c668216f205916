"""`zerorate demo`: learn, close the loop, put what was found back on the chip, and say so.

What it prints is what docs/commands.md shows: host_tests/package runs it and compares.
"""

import re
import shutil
import socket

import pytest
from zerorate_tools.cli import main
from zerorate_tools.demo import broad, demo
from zerorate_tools.demo.broad import WAYS, real, trials
from zerorate_tools.errors import CannotFetch, ZerorateError
from zerorate_tools.recordings import write_recording
from zerorate_tools.runtimes import node
from zerorate_tools.simulate import simulate

from host_tests.docs.outputs import demo_shown


@pytest.fixture(scope="module")
def said(repository):
    return demo_shown(repository)


def figures(said, row):
    """The numbers of every line that begins with `row`."""
    lines = [line for line in said.splitlines() if line.strip().startswith(row)]
    return [[float(n) for n in re.findall(r"-?\d+\.\d", line.replace(",", ""))] for line in lines]


def test_what_nobody_told_the_firmware_is_found_and_makes_it_several_times_better(said):
    assert "found: thermal-hysteresis (confirmed)" in said
    (before,), (after,) = figures(said, "before "), figures(said, "after  ")
    assert sum(after) < sum(before) / 4
    (without,), (with_it,) = figures(said, "without"), figures(said, "with it")
    assert sum(with_it[:3]) < sum(without) / 2
    assert "equal to the last bit" in said
    assert "Final states equal to those of this computer: yes." in said


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
    name = f"{broad.NAME}.mat"
    shutil.copyfile(real_data / "broad" / name, cache / "broad" / name)
    return cache


@pytest.fixture(scope="module")
def shown(real_data, find_runtime):
    (trial,) = (t for t in trials(real_data / "broad") if t.name == broad.NAME)
    return real(trial, find_runtime("x86").name)


def test_a_trial_in_the_cache_needs_no_network(filled):
    trial = broad.broad_trial(NOBODY)
    assert trial.name == broad.NAME
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
    monkeypatch.setattr(broad, "FOLDER_URL", NOBODY)
    assert main(["demo", "--real", "--runtime", "cpython"]) == 2
    line, instead = capsys.readouterr().err.splitlines()
    assert "is there a network?" in line and str(cache / "broad") in line
    assert "built-in" in instead and built_in == ["cpython"]


def test_a_folder_for_what_is_only_printed_is_refused(capsys, tmp_path):
    assert main(["demo", "--real", "--out", str(tmp_path / "out")]) == 2
    assert "leave --out away" in capsys.readouterr().err


def test_a_server_that_never_answers_is_waited_for_aloud_and_not_for_long(
    cache, built_in, silent_server, monkeypatch, capsys
):
    monkeypatch.setattr(broad, "FOLDER_URL", silent_server)
    monkeypatch.setattr(broad, "_SILENT_S", 0.5)
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
    file = filled / "broad" / f"{broad.NAME}.mat"
    file.write_bytes(file.read_bytes()[:-1] + b"x")
    with pytest.raises(CannotFetch, match="network"):
        broad.broad_trial(NOBODY)


def test_a_folder_without_a_trial_is_said(tmp_path):
    with pytest.raises(ZerorateError, match="no BROAD trial .* --data"):
        next(trials(tmp_path))


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
    monkeypatch.setattr(broad, "real", lambda *given: asked.append(given) or shown)
    assert main(["demo", "--real", "--runtime", "x86"]) == 0
    assert [(trial.name, runtime) for trial, runtime, _ in asked] == [(broad.NAME, "x86")]
    said = capsys.readouterr().out
    assert "D. Laidig" in said and "CC BY 4.0" in said
    rows = [line for line in said.splitlines() if re.search(r"\d\.\d\s+[\d,]+\.\d$", line)]
    assert len(rows) >= len(WAYS) - 1


DESCRIPTION = {
    "name": "on the table",
    "seed": 8,
    "sensor": {"odr_hz": 50.0, "gyro_noise_dps": 0.05},
    "bias": {"b0": [5.0, -2.0, 0.5], "b1": [0.05, -0.03, 0.02]},
    "session": [{"start_degc": 22.0, "temperature": [{"to": 24.0, "minutes": 1}]}],
}


def test_the_bias_is_gone_at_the_end_of_the_chain(micropython, tmp_path):
    recording, truth = simulate(DESCRIPTION)
    write_recording(recording, tmp_path / "table.parquet")
    truth_dps = truth.bias_lsb / recording.scales.gyro_lsb_per_dps
    shown = demo(tmp_path / "table.parquet", micropython.name, truth_dps)
    assert shown.same_state
    assert "MPU-6050 at 0x68" in shown.said
    assert shown.score.firmware_mdps < shown.score.first_ten_s_mdps / 5
    assert shown.score.first_ten_s_mdps < shown.score.uncorrected_mdps
    last = shown.corrected_dps[-500:]
    # 0.05 dps of noise over 500 samples leaves 2 mdps
    assert abs(last.mean(axis=0)).max() < 0.010
