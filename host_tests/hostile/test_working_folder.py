"""Files in the folder that one stands in are data: no child runs them as code."""

import sqlite3
import subprocess
import sys
from pathlib import Path

import pytest
from zerorate_tools.importers.logs.ros_bag import read
from zerorate_tools.kernels.library import zig_cc

_TRAP = "open('sprung', 'w').close(); raise SystemExit(3)\n"
_BEGINNINGS = {
    "x.ulg": b"ULog\x01\x12\x35\x01",
    "x.mat": b"MATLAB 5.0 MAT-file",
    "x.bin": b"\xa3\x95\x80",
    "x.bag": b"#ROSBAG V2.0\n",
    "x.db3": b"SQLite format 3\0",
    "x.mcap": b"\x89MCAP0\r\n",
    "x.parquet": b"PAR1",
}


@pytest.fixture
def trapped(tmp_path, monkeypatch):
    """A working folder in which every module that a child imports is a trap."""
    for name in (
        "multiprocessing",
        "pyulog",
        "numpy",
        "scipy",
        "pymavlink",
        "rosbags",
        "ziglang",
        "pyarrow",
        "json",
    ):
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


def test_a_fleet_runs_nothing_of_the_working_folder(trapped):
    (trapped / "x.csv").write_text("t_us,gx,gy,gz\n1,2,3,4\n")
    zerorate = Path(sys.executable).with_name("zerorate")
    fleet = [zerorate, "fleet", "x.csv", "--out", "o", "--workers", "1"]
    subprocess.run(fleet, capture_output=True)
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
