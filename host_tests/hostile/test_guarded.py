"""What reads files runs in a child: no program ends with it, no file beside it is run, and no file
takes more than 600 MB, be it small and claim or unpack to gigabytes.
"""

import gzip
import json
import os
import sqlite3
import struct
import subprocess
import sys
import zlib
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from zerorate_tools import cli
from zerorate_tools.bounds import MEMORY_MB
from zerorate_tools.errors import BadRecording
from zerorate_tools.fleet.devices import Device
from zerorate_tools.fleet.job import Job, run_device
from zerorate_tools.importers import read_foreign
from zerorate_tools.importers.logs import apart
from zerorate_tools.importers.logs.ros_bag import read
from zerorate_tools.kernels.library import zig_cc
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


_IMPORTED = "multiprocessing pyulog numpy scipy pymavlink rosbags ziglang pyarrow json"
_TRAP = "open('sprung', 'w').close(); raise SystemExit(3)\n"
_BEGINNINGS = {
    "x.mat": b"MATLAB 5.0 MAT-file",
    "x.bag": b"#ROSBAG V2.0\n",
    "x.parquet": b"PAR1",
}


@pytest.fixture
def trapped(tmp_path, monkeypatch):
    """A working folder in which every module that a child imports is a trap."""
    for name in _IMPORTED.split():
        (tmp_path / f"{name}.py").write_text(_TRAP)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("name", _BEGINNINGS)
def test_an_import_runs_nothing_of_the_working_folder(trapped, name):
    (trapped / name).write_bytes(_BEGINNINGS[name] + bytes(200))
    zerorate = Path(sys.executable).with_name("zerorate")
    done = subprocess.run([zerorate, "import", name, "--out", "o.parquet"], capture_output=True)
    assert done.returncode in (1, 2), done.stderr
    assert not (trapped / "sprung").exists()


def test_a_fleet_runs_nothing_of_the_working_folder_and_names_a_folder_that_is_not_utf8(trapped):
    for name in ("good", os.fsdecode(b"b\xffd")):
        (trapped / "logs" / name).mkdir(parents=True)
        (trapped / "logs" / name / "1.csv").write_text("t_us,gx,gy,gz\n1,2,3,4\n")
    zerorate = Path(sys.executable).with_name("zerorate")
    fleet = [zerorate, "fleet", "logs", "--out", "o", "--workers", "1"]
    done = subprocess.run(fleet, capture_output=True, timeout=100)
    said = (done.stdout + done.stderr).decode()
    assert r"b\udcffd/1.csv: its name is not UTF-8; rename it" in said and "Traceback" not in said
    assert (trapped / "o" / "fleet.json").exists()
    assert not (trapped / "sprung").exists()


def test_the_compiler_is_not_looked_for_in_the_working_folder(trapped):
    done = subprocess.run([*zig_cc("missing"), "--version"], capture_output=True, text=True)
    assert "clang" in done.stdout
    assert not (trapped / "sprung").exists()


def test_a_database_whose_name_has_marks_of_a_uri_is_read_and_nothing_is_made(tmp_path):
    path = tmp_path / "a#b?c%20.db3"
    with sqlite3.connect(path) as bag:
        bag.execute("CREATE TABLE topics (id, name, type)")
        bag.execute("CREATE TABLE messages (id, topic_id, timestamp, data)")
    with pytest.raises(Exception, match="no"):  # it has no topic, which is said of this very file
        read(path)
    assert [p.name for p in tmp_path.iterdir()] == [path.name]


MOST_MB = 600
_UNPACKED_MB = 1600
_RUN = """
import resource, sys
from zerorate_tools.errors import ZerorateError
from zerorate_tools.importers import Options, import_recording
from zerorate_tools.recordings import open_recording
what, source, out = sys.argv[1:]
try:
    if what == "import":
        import_recording(source, out, options=Options(hz=100), units={"gyro": "dps"})
    else:
        for batch in open_recording(source).batches():
            pass
    print("read")
except ZerorateError as error:
    print(error)
# ru_maxrss of this process would be that of the one that began it
own = next(line for line in open("/proc/self/status") if line.startswith("VmHWM"))
print(int(own.split()[1]) + resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
"""


def taken(what, source, tmp_path):
    """(what it said, MB at most) of reading a file in a process of its own and its children's."""
    if sys.platform != "linux":
        pytest.skip("its limits are Linux's")
    command = [sys.executable, "-c", _RUN, what, str(source), str(tmp_path / "out.parquet")]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    *said, peak_kb = done.stdout.splitlines()
    assert len(said) == 1
    bomb = os.environ["PYTEST_CURRENT_TEST"].partition("::test_")[2].partition("[")[0]
    print(f"\n{bomb.partition(' ')[0]}, {what}: at most {int(peak_kb) / 1024:.0f} MB", end="")
    return said[0], int(peak_kb) / 1024


def packed(path, start, repeated, megabytes=_UNPACKED_MB):
    """A gzip of `start` and then of as many megabytes of what is repeated."""
    block = gzip.compress(repeated * ((16 << 20) // len(repeated)))
    path.write_bytes(gzip.compress(start) + block * (megabytes // 16))
    path.with_name(path.name.replace(".csv.gz", ".json")).write_text(
        json.dumps({"sensor": "X", "odr_hz": 100, "gyro_lsb_per_dps": 131})
    )
    return path


@pytest.mark.parametrize("what", ["import", "open"])
@pytest.mark.parametrize(
    ("start", "complaint"),
    [
        (b"t_us,gx", "no line ends within the first"),
        (b"t_us,gx,gy,gz\n1,2,3,4\n2,", "a row is longer than"),
    ],
)
def test_a_line_without_an_end(tmp_path, what, start, complaint):
    source = packed(tmp_path / "x.csv.gz", start, b"a")
    assert source.stat().st_size < 7_000_000
    said, peak_mb = taken(what, source, tmp_path)
    assert complaint in said
    assert peak_mb < MOST_MB


@pytest.mark.parametrize("what", ["import", "open"])
def test_rows_without_an_end(tmp_path, what):
    source = packed(tmp_path / "x.csv.gz", b"t_us,gx,gy,gz\n", b"1,2,3,4\n", megabytes=160)
    said, peak_mb = taken(what, source, tmp_path)
    assert said == "read"
    assert peak_mb < MOST_MB


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """A Parquet file with one page a column, that of its times of half a gigabyte."""
    path = tmp_path_factory.mktemp("page") / "x.parquet"
    zeros = pa.array(np.zeros(1 << 26, np.int64))
    table = pa.table({"t_us": zeros} | dict.fromkeys(("gx", "gy", "gz"), zeros.cast(pa.int8())))
    scales = b'{"sensor": "X", "odr_hz": 1, "gyro_lsb_per_dps": 1}'
    pq.write_table(
        table.replace_schema_metadata({b"zerorate": scales}), path,
        compression="zstd", use_dictionary=False, data_page_size=1 << 31, row_group_size=1 << 30,
        write_batch_size=1 << 28, column_encoding=dict.fromkeys(table.column_names, "PLAIN"),
        max_rows_per_page=1 << 30,
    )  # fmt: skip
    return path


@pytest.mark.parametrize("what", ["import", "open"])
def test_a_page_of_parquet_that_unpacks_to_half_a_gigabyte(tmp_path, page, what):
    said, peak_mb = taken(what, page, tmp_path)
    assert "a page of it takes more than" in said
    assert peak_mb < MOST_MB


def test_a_mat_that_unpacks_to_a_gigabyte(tmp_path):
    rows = 100_000_000
    array = struct.pack("<IIII", 6, 8, 6, 0) + struct.pack("<IIii", 5, 8, rows, 1)
    array += struct.pack("<II", 1, 1) + b"g" + bytes(7) + struct.pack("<II", 9, rows * 8)
    packer = zlib.compressobj(1)
    body = packer.compress(struct.pack("<II", 14, len(array) + rows * 8) + array)
    block = bytes(16 << 20)
    body += b"".join(packer.compress(block) for _ in range(rows * 8 // len(block))) + packer.flush()
    header = b"MATLAB 5.0 MAT-file".ljust(124) + struct.pack("<HH", 0x0100, 0x4D49)
    (tmp_path / "x.mat").write_bytes(header + struct.pack("<II", 15, len(body)) + body)
    said, peak_mb = taken("import", tmp_path / "x.mat", tmp_path)
    assert "needs more than 400 MB to be read; cut it into parts" in said
    assert peak_mb < MOST_MB


def test_a_sidecar_of_gigabytes(tmp_path):
    (tmp_path / "x.csv").write_text("t_us,gx,gy,gz\n1,2,3,4\n")
    with open(tmp_path / "x.json", "wb") as file:
        file.truncate(4 << 30)
    said, peak_mb = taken("open", tmp_path / "x.csv", tmp_path)
    assert "more than 1 MiB" in said
    assert peak_mb < MOST_MB
