"""Names, numbers and files that are none: one printable line, exit code 2, no traceback."""

import os
import signal
import subprocess
import sys
import traceback
from pathlib import Path

import pytest
from zerorate_tools.cli import main

_LOG = "t_us,gx,gy,gz\n" + "".join(f"{i * 10000},{i % 7},{i % 5},{i % 3}\n" for i in range(500))
_NOT_UTF8 = os.fsdecode(b"a\xff.csv")
_LOOP = ["import", "loop", "--out", "o.parquet"]


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "loop").symlink_to("loop")
    os.mkfifo(tmp_path / "fifo")
    (tmp_path / "link").symlink_to("fifo")
    (tmp_path / "folder").mkdir()
    for name in ("folder/gyro.csv", "piped.json"):
        os.mkfifo(tmp_path / name)
    (tmp_path / "piped.csv").write_text(_LOG)
    (tmp_path / _NOT_UTF8).write_text(_LOG)
    (tmp_path / "run.csv").write_text(_LOG)
    (tmp_path / "log.csv").write_text(_LOG.replace("gx,gy,gz", "gx_dps,gy_dps,gz_dps"))
    (tmp_path / "run.json").write_text('{"sensor":"x","odr_hz":100,"gyro_lsb_per_dps":131.0}')
    (tmp_path / "dev.toml").write_text("[every_session]\nminutes = 0.1\n")
    (tmp_path / "deep.toml").write_text("a=" + "[" * 5000 + "]" * 5000)
    (tmp_path / "deep.yaml").write_text("[" * 5000 + "]" * 5000)
    return tmp_path


def ended(words, folder):
    """(exit code, standard error) of a command in a fork, which alone waits for a pipe for ever."""
    said = folder / "said.txt"
    if (child := os.fork()) == 0:
        code = 99
        try:
            signal.alarm(60)
            os.chdir(folder)
            sys.stdout, sys.stderr = open(os.devnull, "w"), open(said, "w", errors="strict")
            code = main(words)
        except SystemExit as end:
            code = end.code
        except BaseException:
            traceback.print_exc()
        finally:
            sys.stderr.flush()
            os._exit(code)
    code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    return code, said.read_text()


def ended_alone(words, folder):
    """The same of a process of its own: workers of a fleet are no children of this one's fork."""
    command = [sys.executable, "-m", "zerorate_tools.cli", *words]
    done = subprocess.run(command, cwd=folder, capture_output=True, timeout=60)
    return done.returncode, done.stderr.decode()


@pytest.mark.parametrize(
    ("words", "problem"),
    [
        (["import", _NOT_UTF8, "--out", "o.parquet"], r"a\udcff.csv: its name is not UTF-8"),
        (["allan", _NOT_UTF8], r"a\udcff.csv: its name is not UTF-8"),
        (["replay", _NOT_UTF8, "--out", "o.parquet"], r"a\udcff.csv: its name is not UTF-8"),
        (["allan", "\x1b[31mx\u202e.csv"], r"\x1b[31mx\u202e.csv: no such file"),
        (_LOOP, "loop: Too many levels of symbolic links"),
        (["import", "fifo", "--out", "o.parquet"], "fifo: neither a file nor a folder"),
        (["simulate", "hysteresis", "--seed", "-1"], "-1 is below 0"),
        (["simulate", "deep.toml", "--out", "s.parquet"], "deep.toml: nested too deeply"),
        (["simulate", "deep.yaml", "--out", "s.parquet"], "deep.yaml: nested too deeply"),
        (["replay", "run.csv", "--out", "o.parquet", "--set", "bins=1e400"], "bins=1e400: not of"),
        (["replay", "run.csv", "--out", "o.parquet", "--model", "/dev/zero"], "zero: is no file"),
        (["replay", "run.csv", "--out", "o.parquet", "--from-state", "fifo"], "fifo: is no file"),
        (["record", "--recover", "."], ".: nothing that `zerorate record` leaves behind"),
        (["import", "loop", "--out", "folder"], "loop: Too many levels of symbolic links"),
        (["state", "show", "run.csv", "--set", "\x1b[31m"], r"\x1b[31m: not of the form"),
        (["import", "folder", "--out", "o.parquet"], "folder: no table with rates in it"),
        (["allan", "piped.csv"], "piped.json: is no file; write there"),
        (["simulate", "fifo", "--out", "s.parquet"], "fifo: is no file"),
        (["state", "show", "/dev/zero"], "zero: is no file"),
        (["flash", "none", "--dry-run", "--main", "/dev/zero"], "zero: is no file"),
        (["flash", "file:///x", "--with", "rest"], "file:///x: is not there"),
        (["watch", "fake:", "--own"], "fake: is an emulated chip without a board; name a board's"),
        (["record", "none", "--out", "o.csv", "--setup", "fifo"], "fifo: is no file"),
        (["record", "fake:", "--out", "o.csv", "--seconds", "nan"], "nan is no finite number"),
        (["record", "fake:", "--out", "o.csv", "--seconds", "0"], "0 is not above 0"),
        (["fleet", "run.csv", "--out", "loop"], "loop/parts: Too many levels of symbolic links"),
        (["run", "none", "--socket", "o.parquet", "--udp", "x"], "--udp x: write ADDRESS:PORT"),
        (["replay", "run.csv", "--out", "o.parquet", "--state", "fifo"], "fifo: cannot be written"),
        (["simulate", "dev.toml", "--out", "o.parquet", "--truth", "fifo"], "fifo: cannot be"),
        (["simulate", "dev.toml", "--out", "o.parquet", "--truth", "link"], "link: cannot be"),
        (["record", "/dev/i2c-77", "--out", "o.csv", "--setup", "\n"], "no such file"),
        (["import", "run.csv", "--out", "o.parquet", "--hz", "inf"], "inf is no finite number"),
        (["import", "log.csv", "--out", "o.parquet", "--hz", "1e-300"], "the time stamp is 1e+306"),
    ],
    ids=str,
)
def test_it_is_one_printable_line_that_says_what_to_do(folder, words, problem):
    code, said = (ended_alone if words[0] == "fleet" else ended)(words, folder)
    assert code == 2 and problem in said and "Traceback" not in said
    assert "\x1b" not in said and "\u202e" not in said
    assert said.startswith("usage") or len(said.splitlines()) == 1
    assert not list(Path(folder).glob("[os].parquet")) and (folder / "fifo").is_fifo()


def test_one_folder_that_is_not_utf8_leaves_the_fleet_standing(folder):
    for name in ("good", os.fsdecode(b"b\xffd")):
        (folder / "logs" / name).mkdir(parents=True)
        for kind in ("csv", "json"):
            text = (folder / f"run.{kind}").read_text()
            (folder / "logs" / name / f"1.{kind}").write_text(text)
    command = [sys.executable, "-m", "zerorate_tools.cli", "fleet", "logs", "--out", "found"]
    done = subprocess.run(command, cwd=folder, capture_output=True, timeout=100)
    said = (done.stdout + done.stderr).decode()
    assert r"b\udcffd/1.csv: its name is not UTF-8; rename it" in said and "Traceback" not in said
