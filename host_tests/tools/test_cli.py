"""The command line: what it lists, what it says when something is wrong, how it ends, JSON."""

import json
import os
import subprocess
import sys
from types import SimpleNamespace
from unittest.mock import Mock

import numpy as np
import pandas as pd
import pytest
import zerorate_tools
from zerorate_tools import cli, installed, runtimes
from zerorate_tools.cli import main
from zerorate_tools.commands.demo import get_ready
from zerorate_tools.errors import MissingRuntime
from zerorate_tools.installed import adding, beside
from zerorate_tools.recordings import Scales, recording_writer
from zerorate_tools.simulate import simulate_to_files

from host_tests.fleet.conftest import run_here

SCALES = Scales("X", 1.0, 1.0)


def test_the_module_runs_as_a_program_and_its_exit_code_reaches_the_shell(tmp_path):
    words = [sys.executable, "-m", "zerorate_tools.cli", "import", "none.csv", "--out", "x.csv"]
    ran = subprocess.run(words, capture_output=True, text=True)
    assert ran.returncode == 2
    assert ran.stderr == "zerorate: none.csv: no such file; name a file to import\n"


def test_without_a_word_it_helps_and_says_where_to_begin(capsys):
    with pytest.raises(SystemExit) as ended:
        main([])
    assert ended.value.code == 0 and "zerorate demo" in capsys.readouterr().out


def test_help_imports_nothing_that_a_command_needs():
    heavy = ("numpy", "pandas", "pyarrow", "scipy", "rich", "matplotlib", "plotly", "dask")
    code = (
        "import sys\nfrom zerorate_tools import cli\n"
        "try: cli.main(['--help'])\nexcept SystemExit: pass\n"
        f"sys.exit(' '.join(name for name in {heavy!r} if name in sys.modules) or 0)"
    )
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert ran.returncode == 0, ran.stderr


@pytest.mark.skipif(not os.path.isdir("/proc"), reason="a folder that even root cannot write")
@pytest.mark.parametrize("words", ["import in.csv --out", "record /dev/ttyNONE --out"])
def test_a_folder_that_cannot_be_written_is_told_at_once_by_the_name_given(tmp_path, words, capsys):
    (tmp_path / "in.csv").write_text("t_s,gx_dps,gy_dps,gz_dps\n" + "0,1,2,3\n" * 9)
    command, source, option = words.replace("in.csv", str(tmp_path / "in.csv")).split()
    for out in ("/proc/x.parquet", "/proc/x.csv"):
        assert main([command, source, option, out]) == 2
        assert capsys.readouterr().err.startswith(f"zerorate: {out}: ")


@pytest.mark.parametrize(
    "words",
    [
        "replay run.parquet --out run.parquet",
        "replay run.parquet --out new.parquet --state ./run.parquet",
        "replay run.parquet --out new.parquet --state new.parquet",
        "replay run.parquet --out state.parquet --from-state state.parquet",
        "import run.parquet --out again/run.parquet",
        "compare run.parquet --out run.parquet",
        "simulate turntable --out new.parquet --truth new.parquet",
    ],
)
def test_no_command_writes_over_what_it_reads_or_writes(words, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "state.parquet").write_text("the only copy")
    with recording_writer("run.parquet", ["t_us", "gx", "gy", "gz"], SCALES) as writer:
        writer.append({name: np.arange(9) for name in ("t_us", "gx", "gy", "gz")})
    (tmp_path / "again").symlink_to(tmp_path)
    before = {p.name: p.read_bytes() for p in tmp_path.glob("*.parquet")}
    assert main(words.split()) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1 and "written" in said and "name" in said
    assert {p.name: p.read_bytes() for p in tmp_path.glob("*.parquet")} == before


@pytest.fixture
def running(monkeypatch):
    """running(function): what the command line does then, whatever is typed."""

    def put(function):
        parsed = SimpleNamespace(run=function)
        monkeypatch.setattr(cli, "parser", lambda: SimpleNamespace(parse_args=lambda argv: parsed))

    return put


def test_an_error_of_the_bus_is_one_line(running, capsys):
    running(Mock(side_effect=OSError(5, "Input/output error", "/dev/i2c-1")))
    assert main([]) == 2
    assert capsys.readouterr().err == "zerorate: /dev/i2c-1: Input/output error\n"


def test_an_interrupt_ends_in_130_and_leaves_nothing_half_written(running, tmp_path, capsys):
    def interrupted(arguments):
        with recording_writer(tmp_path / "run.csv", ["t_us", "gx", "gy", "gz"], SCALES) as writer:
            writer.append(dict.fromkeys(("t_us", "gx", "gy", "gz"), np.arange(9)))
            raise KeyboardInterrupt

    running(interrupted)
    assert main([]) == 130
    assert capsys.readouterr().err == "zerorate: interrupted; nothing half-written was left\n"
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(("name", "library"), [("run.ulg", "pyulog"), ("run.bin", "pymavlink")])
def test_a_missing_library_is_said_with_a_command_that_a_shell_takes(
    tmp_path, monkeypatch, capsys, name, library
):
    missing = f'raise ModuleNotFoundError("not here", name="{library}")'
    (tmp_path / f"{library}.py").write_text(missing)
    monkeypatch.syspath_prepend(tmp_path)
    (tmp_path / name).write_bytes(b"ULog\x01")
    assert main(["import", f"{tmp_path}/{name}", "--out", f"{tmp_path}/run.parquet"]) == 2
    said = capsys.readouterr().err
    assert said.endswith(f"needs {library}, which is not installed; {adding('tools')}\n")


@pytest.mark.parametrize(
    ("record", "command"),
    [
        (None, "pip install 'zerorate[linux]'"),
        ({"url": "https://host/a.whl", "archive_info": {}}, "pip install 'zerorate[linux]'"),
        ({"url": "file:///a%20b/c.whl", "archive_info": {}}, "pip install '/a b/c.whl[linux]'"),
        ({"url": "file:///src", "dir_info": {"editable": True}}, "pip install -e '/src[linux]'"),
    ],
)
def test_an_extra_is_added_from_where_the_package_came(monkeypatch, record, command):
    came = SimpleNamespace(read_text=lambda name: record and json.dumps(record))
    monkeypatch.setattr(installed, "distribution", lambda name: came)
    assert adding("linux") == command


@pytest.mark.parametrize(
    ("left", "command", "inject"),
    [
        ("pipx_metadata.json", "pipx install --force", "pipx inject zerorate"),
        ("uv-receipt.toml", "uv tool install", f"uv pip install --python '{sys.prefix}'"),
    ],
)
def test_an_installer_of_commands_adds_to_its_own(monkeypatch, tmp_path, left, command, inject):
    (tmp_path / left).touch()
    monkeypatch.setattr(sys, "prefix", str(tmp_path))
    monkeypatch.setattr(installed, "_source", lambda: ("a.whl", False))
    assert adding("linux") == f"{command} 'a.whl[tools,linux]'"
    assert adding("tools") == f"{command} 'a.whl[tools]'"
    assert beside("vqf") == f"{inject} vqf"


def test_the_public_names_are_there_and_nothing_else_is():
    for name in zerorate_tools.__all__:
        assert callable(getattr(zerorate_tools, name))
        assert name in dir(zerorate_tools)
    with pytest.raises(AttributeError, match="no attribute 'nonsense'"):
        _ = zerorate_tools.nonsense


def test_the_demo_says_that_it_fetches_before_it_does(monkeypatch, capsys):
    def fetched(name):
        assert f"fetching MicroPython ({name}), once" in capsys.readouterr().err

    monkeypatch.setattr(runtimes, "find", Mock(side_effect=MissingRuntime("none")))
    monkeypatch.setattr(runtimes, "fetch", fetched)
    get_ready("wasm")


@pytest.mark.parametrize(
    ("typed", "meant"),
    [
        (["f1eet", "x.csv"], "did you mean fleet?"),
        (["import", "x.csv", "--out", "y", "--rate-hz", "40"], "did you mean --hz?"),
        (["close", "x.parquet", "--out", "x", "--holdut=y"], "did you mean --holdout?"),
        (["fleet", "x", "--out", "y", "--job", "repaly"], "did you mean replay?"),
        (["allan", "a.csv", "--holdout", "b"], "it is an option of close"),
        (["replay", "a.csv", "--out", "b", "--plot", "c"], "it is an option of watch"),
    ],
)
def test_a_wrong_word_is_answered_with_the_nearest(capsys, typed, meant):
    with pytest.raises(SystemExit) as ended:
        main(typed)
    assert ended.value.code == 2 and meant in capsys.readouterr().err


@pytest.mark.parametrize("typed", [["xyzzy"], ["model", "", "a.json"]])
def test_a_word_like_no_other_is_answered_with_none(capsys, typed):
    with pytest.raises(SystemExit):
        main(typed)
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
def test_json_is_one_document_on_standard_output(
    sessions, tmp_path, monkeypatch, capsys, command, key
):
    run_here(monkeypatch)
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
