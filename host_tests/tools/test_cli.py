"""The command line: what it lists, what it says when something is wrong, and how it ends."""

import io
import subprocess
import sys
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass

import numpy as np
import pytest
import zerorate_tools
from zerorate_tools import cli
from zerorate_tools.recordings import Scales, read_recording, recording_writer

SCALES = Scales("X", 1.0, 1.0)


@dataclass
class Ended:
    """How a command ended: its exit code and what it printed."""

    returncode: int
    stdout: str
    stderr: str


def zerorate(*words):
    """Run the command in this process."""
    out, err = io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err):
        try:
            code = cli.main([str(word) for word in words])
        except SystemExit as ended:
            code = ended.code
    return Ended(code, out.getvalue(), err.getvalue())


def test_the_module_runs_as_a_program_and_its_exit_code_reaches_the_shell(tmp_path):
    words = [sys.executable, "-m", "zerorate_tools.cli", "import", "none.csv", "--out", "x.csv"]
    ran = subprocess.run(words, capture_output=True, text=True)
    assert ran.returncode == 2
    assert ran.stderr == "zerorate: none.csv: no such file; name a file to import\n"


def test_help_lists_every_command_that_is_there():
    listed = zerorate("--help").stdout
    for name in ("import", "simulate"):
        assert f"\n    {name} " in listed


def test_without_a_word_it_helps_and_says_where_to_begin():
    ran = zerorate()
    assert ran.returncode == 0
    assert "zerorate demo" in ran.stdout


def test_a_command_whose_module_is_not_there_is_not_listed(monkeypatch, capsys):
    monkeypatch.setattr(cli, "COMMANDS", ("simulate", "imagine"))
    with pytest.raises(SystemExit):
        cli.main(["--help"])
    assert "simulate" in (listed := capsys.readouterr().out) and "imagine" not in listed


def test_help_imports_nothing_that_a_command_needs():
    heavy = ("numpy", "pandas", "pyarrow", "scipy", "rich", "matplotlib", "plotly", "dask")
    code = (
        "import sys\nfrom zerorate_tools import cli\n"
        "try: cli.main(['--help'])\nexcept SystemExit: pass\n"
        f"sys.exit(' '.join(name for name in {heavy!r} if name in sys.modules) or 0)"
    )
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert ran.returncode == 0, ran.stderr


def test_the_version_is_the_packages():
    assert zerorate_tools.__version__ in zerorate("--version").stdout


def test_bad_input_ends_in_one_line_and_2(tmp_path):
    (tmp_path / "in.csv").write_text("t_s,gx_dps,gy_dps,gz_dps\n")
    ran = zerorate("import", tmp_path / "in.csv", "--out", tmp_path / "out.parquet")
    assert ran.returncode == 2
    assert ran.stderr.startswith("zerorate: ") and ran.stderr.count("\n") == 1
    assert "in.csv" in ran.stderr and "no data row" in ran.stderr
    assert [p.name for p in tmp_path.iterdir()] == ["in.csv"]


def test_a_folder_that_is_not_there_ends_in_one_line_and_2(tmp_path):
    ran = zerorate("simulate", "car", "--out", tmp_path / "nowhere" / "run.parquet")
    assert ran.returncode == 2
    assert "nowhere" in ran.stderr and ran.stderr.count("\n") == 1


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
def test_no_command_writes_over_what_it_reads_or_writes(words, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "state.parquet").write_text("the only copy")
    with recording_writer("run.parquet", ["t_us", "gx", "gy", "gz"], SCALES) as writer:
        writer.append({name: np.arange(9) for name in ("t_us", "gx", "gy", "gz")})
    (tmp_path / "again").symlink_to(tmp_path)
    before = {p.name: p.read_bytes() for p in tmp_path.glob("*.parquet")}
    ran = zerorate(*words.split())
    assert ran.returncode == 2 and ran.stderr.count("\n") == 1
    assert "written" in ran.stderr and "name" in ran.stderr
    assert {p.name: p.read_bytes() for p in tmp_path.glob("*.parquet")} == before


@pytest.mark.parametrize(
    "words", [["fly"], ["simulate"], ["import", "x"], ["import", "x", "--out", "y", "--hz", "0"]]
)
def test_wrong_words_end_in_2_with_the_usage(words):
    ran = zerorate(*words)
    assert ran.returncode == 2
    assert "usage: zerorate" in ran.stderr and "Traceback" not in ran.stderr


def test_an_error_of_the_bus_is_one_line(monkeypatch, capsys):
    def fail(arguments):
        raise OSError(5, "Input/output error", "/dev/i2c-1")

    monkeypatch.setattr(cli, "parser", lambda: _Parser(fail))
    assert cli.main([]) == 2
    assert capsys.readouterr().err == "zerorate: /dev/i2c-1: Input/output error\n"


@pytest.mark.parametrize(("name", "library"), [("run.ulg", "pyulog"), ("run.bin", "pymavlink")])
def test_a_missing_library_is_said_with_a_command_that_a_shell_takes(
    tmp_path, monkeypatch, name, library
):
    missing = f'raise ModuleNotFoundError("not here", name="{library}")'
    (tmp_path / f"{library}.py").write_text(missing)
    monkeypatch.syspath_prepend(tmp_path)
    (tmp_path / name).write_bytes(b"ULog\x01")
    ran = zerorate("import", tmp_path / name, "--out", tmp_path / "run.parquet")
    assert ran.stderr.endswith(f"needs {library}, which is not installed; {_installing('tools')}\n")


def test_a_library_of_another_extra_is_said_with_that_extra(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "dask", None)
    (tmp_path / "run.csv").write_text("")
    ran = zerorate("fleet", tmp_path / "run.csv", "--out", tmp_path / "out")
    assert ran.stderr.endswith(f"needs dask, which is not installed; {_installing('fleet')}\n")


def _installing(extra):
    return f"pip install 'zerorate[{extra}]'"


class _Parser:
    """Parses nothing and runs what it was given."""

    def __init__(self, run):
        self.run = run

    def parse_args(self, argv):
        return self


def test_an_interrupt_ends_in_130_and_leaves_nothing_half_written(tmp_path, monkeypatch, capsys):
    def interrupted(arguments):
        with recording_writer(tmp_path / "run.csv", ["t_us", "gx", "gy", "gz"], SCALES) as writer:
            writer.append(dict.fromkeys(("t_us", "gx", "gy", "gz"), np.arange(9)))
            raise KeyboardInterrupt

    monkeypatch.setattr(cli, "parser", lambda: _Parser(interrupted))
    assert cli.main([]) == 130
    assert capsys.readouterr().err == "zerorate: interrupted; nothing half-written was left\n"
    assert list(tmp_path.iterdir()) == []


def test_import_prints_what_it_did(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    rows = "".join(f"{i},1,{i},3,20\n" for i in range(5)) + "9,0,0,0,0\n"
    (tmp_path / "in.csv").write_text("t_s,gx_dps,gy_dps,gz_dps,temp_C\n" + rows)
    ran = zerorate("import", "in.csv", "--out", "out.csv.gz")
    assert ran.returncode == 0, ran.stderr
    assert "out.csv.gz" in ran.stdout and "5 samples: 4 s at 1 Hz, of 6 rows" in ran.stdout
    assert "dropped 1 rows: all readings are zero" in ran.stdout
    assert read_recording(tmp_path / "out.csv.gz").columns["gz"].tolist() == [393] * 5


def test_import_takes_a_fraction_as_a_rate(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "in.csv").write_text("gx_dps,gy_dps,gz_dps\n" + "0.1,0.2,0.3\n" * 3)
    words = ["import", "in.csv", "--out", "out.parquet", "--hz"]
    assert zerorate(*words, "1/15").returncode == 0
    assert [zerorate(*words, bad).returncode for bad in ("1/0", "fast", "1/")] == [2, 2, 2]
    t_us = read_recording(tmp_path / "out.parquet").columns["t_us"]
    assert t_us.tolist() == [0, 15_000_000, 30_000_000]


def test_import_takes_a_mapping_and_refuses_a_wrong_one(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "in.csv").write_text("a,b,c\n1,2,3\n4,5,6\n")
    words = ["import", "in.csv", "--out", "out.parquet", "--hz", "10"]
    maps = ["--map", "gx=a:dps", "--map", "gy=b:dps", "--map", "gz=c:dps"]
    assert zerorate(*words, *maps).returncode == 0
    assert read_recording(tmp_path / "out.parquet").columns["gx"].tolist() == [131, 524]
    ran = zerorate(*words, "--map", "gx=a:knots")
    assert ran.returncode == 2 and "unit 'knots' of gx is none of dps" in ran.stderr


def test_simulate_writes_every_session_and_lists_its_scenarios(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    listed = zerorate("simulate", "--list").stdout.split()
    assert "warm-up-a" in listed
    words = ["--seed", "3", "--session", "1", "--truth", "t.parquet"]
    ran = zerorate("simulate", "turntable", "--out", "run.parquet", *words)
    assert ran.returncode == 0, ran.stderr
    assert sorted(p.name for p in tmp_path.iterdir()) == ["run.parquet", "t.parquet"]


def test_the_public_names_are_there_and_nothing_else_is():
    for name in zerorate_tools.__all__:
        assert callable(getattr(zerorate_tools, name))
        assert name in dir(zerorate_tools)
    with pytest.raises(AttributeError, match="no attribute 'nonsense'"):
        _ = zerorate_tools.nonsense
