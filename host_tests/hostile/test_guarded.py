"""A Parquet file that ends its parser ends a child, whoever reads it, and no command or program."""

import os
import struct
import subprocess
import sys

import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from zerorate_tools import cli
from zerorate_tools.child import MEMORY_MB
from zerorate_tools.errors import BadRecording
from zerorate_tools.fleet.devices import Device
from zerorate_tools.fleet.job import Job, run_device
from zerorate_tools.importers import read_foreign
from zerorate_tools.importers.logs import apart
from zerorate_tools.recordings import guarded, parquet_format, read_recording, write_recording

from ..tools.killed_writers import recording

_ENDED = "x.parquet: its reader ended with -6; the file is damaged: copy it again"


@pytest.fixture
def log(tmp_path):
    write_recording(recording(1, 50), tmp_path / "x.parquet")
    return tmp_path / "x.parquet"


@pytest.fixture
def deadly(monkeypatch, log):
    """A log at which every child of a reader dies."""
    dies = [sys.executable, "-c", "import os; os.abort()"]
    for module in (apart, guarded):
        monkeypatch.setattr(module, "python_child", lambda *words: dies)
    monkeypatch.setattr(guarded, "_readers", {})
    monkeypatch.setattr(parquet_format, "open_file", None)  # not in this process
    return log


@pytest.mark.parametrize("command", ["import", "cut", "replay", "close", "allan", "compare"])
def test_it_is_one_line_of_a_command(deadly, capsys, command):
    more = {"allan": [], "compare": [], "cut": ["--at-row", "9", "--out", "parts"]}
    out = more.get(command, ["--out", str(deadly.with_name("out.parquet"))])
    assert cli.main([command, str(deadly), *out]) == 2
    said = capsys.readouterr().err
    assert _ENDED in said and len(said.splitlines()) == 1


def test_it_is_an_error_in_python_and_a_failure_of_one_device(deadly):
    with pytest.raises(BadRecording, match="its reader ended with -6"):
        read_recording(deadly)
    (failure,) = run_device(Job(), Device("a", (str(deadly),)))["failures"]
    assert _ENDED in failure["reason"]


@pytest.mark.parametrize("footer", [b"\xff" * 30_000_000, b"\x19\xfc" * 1000])
def test_any_footer_is_one_line(tmp_path, footer):
    whole = b"PAR1" + footer + struct.pack("<I", len(footer)) + b"PAR1"
    (tmp_path / "x.parquet").write_bytes(whole)
    for reads in (read_recording, read_foreign):
        with pytest.raises(BadRecording, match="x.parquet: ") as refused:
            reads(tmp_path / "x.parquet")
        assert "\n" not in str(refused.value)


def test_a_column_that_is_there_twice_is_named(tmp_path):
    table = pa.table([pa.array([1, 2])] * 3, names=["t_us", "gx_dps", "gx_dps"])
    pq.write_table(table, tmp_path / "x.parquet")
    with pytest.raises(BadRecording, match="gx_dps comes twice"):
        read_recording(tmp_path / "x.parquet")
    with pytest.raises(BadRecording, match="the column 'gx_dps' is there twice"):
        read_foreign(tmp_path / "x.parquet")


def test_limits_that_a_user_set_lower_stop_no_reader(log):
    whose = "import resource as r; r.setrlimit(r.RLIMIT_CPU, (20, 20)); "
    whose += f"r.setrlimit(r.RLIMIT_DATA, ({MEMORY_MB << 20},) * 2); "
    reads = f"import zerorate_tools as z; print(len(z.read_recording({str(log)!r})))"
    done = subprocess.run([sys.executable, "-c", whose + reads], capture_output=True, text=True)
    assert done.stdout == "50\n", done.stderr


def test_a_reader_that_was_killed_or_is_a_parents_is_replaced(log, tmp_path, monkeypatch):
    monkeypatch.setattr(guarded, "_readers", {})
    assert len(read_recording(log)) == 50
    reader = guarded._readers[os.getpid()]
    reader._child.kill()
    reader._child.wait()
    log.touch()
    assert len(read_recording(log)) == 50
    log.touch()
    if (child := os.fork()) == 0:
        os._exit(len(read_recording(log)) != 50 or len(guarded._readers) != 2)
    assert os.waitpid(child, 0)[1] == 0
    assert len(read_recording(log)) == 50
