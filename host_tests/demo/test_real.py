"""`zerorate demo --real`: a public recording, fetched once, against what cameras saw."""

import re
import shutil

import pytest
from zerorate_tools.cli import main
from zerorate_tools.demo import broad_trial
from zerorate_tools.demo import real as by_real
from zerorate_tools.demo.broad import trials
from zerorate_tools.demo.real import WAYS, real
from zerorate_tools.errors import CannotFetch

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


def test_without_a_network_one_line_says_so_and_what_to_do(cache, monkeypatch, capsys):
    monkeypatch.setattr(broad_trial, "FOLDER_URL", NOBODY)
    assert main(["demo", "--real", "--runtime", "cpython"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "is there a network?" in line and str(cache / "broad") in line


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
