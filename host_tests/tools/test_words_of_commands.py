"""Commands for people and for programs: what was meant, what may come next, and JSON."""

import json
import os
import subprocess
import sys

import numpy as np
import pandas as pd
import pytest
from zerorate_tools.cli import main
from zerorate_tools.numbers import fixed
from zerorate_tools.simulate import simulate_to_files


@pytest.mark.parametrize(
    ("typed", "meant"),
    [
        (["f1eet", "x.csv"], "did you mean fleet?"),
        (["close", "x.parquet", "--out", "x", "--holdut=y"], "did you mean --holdout?"),
        (["fleet", "x", "--out", "y", "--job", "repaly"], "did you mean replay?"),
    ],
)
def test_a_wrong_word_is_answered_with_the_nearest(capsys, typed, meant):
    with pytest.raises(SystemExit) as ended:
        main(typed)
    assert ended.value.code == 2 and meant in capsys.readouterr().err


def test_a_word_like_no_other_is_answered_with_none(capsys):
    with pytest.raises(SystemExit):
        main(["xyzzy"])
    assert "did you mean" not in capsys.readouterr().err


@pytest.mark.parametrize(
    ("line", "offered"), [("zerorate comp", "compare"), ("zerorate close --hold", "--holdout")]
)
def test_a_shell_is_told_what_may_come_next(tmp_path, line, offered):
    told = tmp_path / "told"
    shell = {"_ARGCOMPLETE": "1", "COMP_LINE": line, "COMP_POINT": str(len(line))}
    shell |= {"_ARGCOMPLETE_STDOUT_FILENAME": str(told), "_ARGCOMPLETE_IFS": "\n"}
    command = [sys.executable, "-m", "zerorate_tools.cli"]
    subprocess.run(command, env=os.environ | shell, check=True, timeout=60)
    assert offered in told.read_text()


@pytest.fixture(scope="module")
def sessions(tmp_path_factory):
    """Two short power-ons of one device."""
    folder = tmp_path_factory.mktemp("sessions")
    described = {
        "sensor": {"odr_hz": 10.0},
        "bias": {"b0": [0.5, -0.3, 0.1]},
        "session": [{"minutes": 4, "start_degc": 20}] * 2,
    }
    return [str(file) for file in simulate_to_files(described, folder / "run.parquet")]


@pytest.mark.parametrize(
    ("command", "key"),
    [
        ("compare {0} {1}", "ways"),
        ("replay {0} --out {out}/r.parquet", "samples"),
        ("close {0} {1} --out {out}/closed", "verdict"),
        ("fleet {0} {1} --workers 1 --out {out}/fleet", "sessions"),
    ],
)
def test_json_is_one_document_on_standard_output(sessions, tmp_path, capsys, command, key):
    words = command.format(*sessions, out=tmp_path).split()
    assert main([*words, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)[key]


def test_json_of_an_import_has_a_recording_for_each_source(tmp_path, capsys):
    frame = pd.DataFrame(np.ones((50, 4)), columns=["t_s", "gx_dps", "gy_dps", "gz_dps"])
    frame["t_s"] = np.arange(50) / 10
    frame.to_csv(tmp_path / "a.csv", index=False)
    source, out = str(tmp_path / "a.csv"), str(tmp_path / "a.parquet")
    assert main(["import", source, "--out", out, "--json"]) == 0
    [one] = json.loads(capsys.readouterr().out)["recordings"]
    assert one["file"] == out and one["rows_written"] == 50


def test_the_demo_says_that_it_fetches_before_it_does(monkeypatch, capsys):
    from zerorate_tools import runtimes
    from zerorate_tools.commands.demo import get_ready
    from zerorate_tools.errors import MissingRuntime

    def not_there(name):
        raise MissingRuntime(name)

    def fetched(name):
        assert f"fetching MicroPython ({name}), once" in capsys.readouterr().err

    monkeypatch.setattr(runtimes, "find", not_there)
    monkeypatch.setattr(runtimes, "fetch", fetched)
    get_ready("wasm")


@pytest.mark.parametrize(
    ("value", "sign", "shown"),
    [(-0.0004, "+", "+0.000"), (-0.0, "", "0.000"), (-0.0006, "+", "-0.001"), (1.5, "", "1.500")],
)
def test_what_rounds_to_zero_has_no_minus(value, sign, shown):
    assert fixed(value, 3, sign) == shown
