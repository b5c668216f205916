"""A board on a serial port, flashed and recorded from: MicroPython's unix port stands in for it."""

import re
import sys
import threading
from functools import cache
from pathlib import Path

import pytest
from zerorate_tools.boards import compiling
from zerorate_tools.boards.connection import BoardError, connected
from zerorate_tools.boards.flashing import flash
from zerorate_tools.boards.recording import record
from zerorate_tools.cli import main
from zerorate_tools.model import Slot, build_model, write_model
from zerorate_tools.model.term import Term
from zerorate_tools.recordings import Scales, read_recording

from host_tests.drivers.unix_board import UnixBoard

pytest.importorskip("mpremote")
pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="pseudo-terminals of Linux")

ROOT = Path(__file__).resolve().parents[2]
HERE = Path(__file__).parent / "on_micropython"
SETUP = (
    "import live_chip\nfrom zerorate_i2c.mpu6050 import MPU6050\nimu = MPU6050(live_chip.make())\n"
)
compiled_once = cache(compiling.compiled)


@pytest.fixture
def board(find_runtime, tmp_path):
    modules = [ROOT / "drivers", ROOT / "host_tests" / "fakes", HERE]
    board = UnixBoard(find_runtime("x86"), tmp_path, modules)
    yield board
    board.close()


@pytest.fixture
def blank_board(find_runtime, tmp_path, monkeypatch):
    monkeypatch.setattr(compiling, "compiled", compiled_once)
    board = UnixBoard(find_runtime("x86"), tmp_path)
    yield board
    board.close()


def files_below(folder):
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file()
    }


def board_says(board, source):
    with connected(board.port) as transport:
        return transport.exec(source).decode().strip()


def test_a_dry_run_writes_nothing_and_says_what_the_board_has(blank_board):
    said = []
    flash(blank_board.port, dry_run=True, say=said.append)
    assert "MicroPython 1." in said[0]
    assert any(re.search(r"heap needed: [\d,]+ bytes; it has [\d,]+ free", s) for s in said)
    assert list(blank_board.folder.iterdir()) == []


def test_the_board_imports_what_was_compiled_for_it_and_only_what_changed_is_sent_again(
    blank_board, tmp_path_factory
):
    slot = Slot(Term("temp", 20, 45, 32.5, power=2), (0.001, -0.002, 0.0003))
    model = build_model([slot], Scales("MPU-6050", 100.0, 131.0, 16384.0, 340.0, 36.53))
    readable, binary = write_model(model, tmp_path_factory.mktemp("models"))
    program, folder = HERE / "live_chip.py", blank_board.folder
    options = {"main": program, "model": readable, "parts": ["bursts"], "say": lambda line: None}
    done = flash(blank_board.port, **options)
    there = files_below(folder)
    assert {*there} == {str(name) for name in done.files}
    assert there["main.py"] == program.read_bytes() and there["model.bin"] == binary.read_bytes()
    assert {f"lib/zerorate/{name}.mpy" for name in ("bursts", "model")} <= {*there}
    assert not any("in_motion" in name for name in there)
    imports = "import zerorate.bursts, zerorate.model, zerorate_i2c.fifo; print(2)"
    assert board_says(blank_board, imports) == "2"

    (folder / "lib/zerorate_i2c/parts.mpy").write_text("old")
    (folder / "lib/zerorate_i2c/parts.py").write_text("shadows it")
    (folder / "lib/others.py").write_text("not of this project")
    again = flash(blank_board.port, **options)
    assert [name.name for name in again.sent] == ["parts.mpy"]
    assert files_below(folder) == {**there, "lib/others.py": b"not of this project"}


def test_a_package_that_arrives_damaged_replaces_nothing(blank_board, monkeypatch):
    flash(blank_board.port, say=lambda line: None)
    library = blank_board.folder / "lib"
    before = files_below(library)
    monkeypatch.setattr("zerorate_tools.boards.flashing.b64encode", lambda data: b"AAAA")
    with pytest.raises(BoardError, match="did not arrive whole and nothing was replaced"):
        flash(blank_board.port, say=lambda line: None, parts=["motion"])
    assert files_below(library) == before
    monkeypatch.undo()
    flash(blank_board.port, say=lambda line: None, parts=["motion"])
    assert list(library.rglob("in_motion.mpy"))


def test_every_sample_of_the_board_is_in_the_recording_and_the_board_is_free_again(board, tmp_path):
    out = tmp_path / "run.parquet"
    result = record(board.port, out, seconds=3, setup=SETUP)
    recording = read_recording(out)
    numbers = recording.columns["gz"]
    assert len(numbers) == result.samples > 100
    assert (numbers[1:] > numbers[:-1]).all()
    missing = int(numbers[-1] - numbers[0] + 1 - len(numbers))
    assert missing <= result.lost + 2
    assert result.dropped == 0
    assert recording.scales.gyro_lsb_per_dps == 131.0
    assert recording.scales.sensor == "MPU-6050"
    assert board_says(board, "print('here')") == "here"


def test_bytes_lost_on_the_port_are_counted_and_give_no_false_row(board, tmp_path):
    out = tmp_path / "run.csv"
    threading.Timer(2.0, board.drop, [40]).start()
    result = record(board.port, out, seconds=4, setup=SETUP)
    numbers = read_recording(out).columns["gz"]
    assert result.dropped >= 1
    assert result.bytes_skipped > 0
    assert (numbers[1:] > numbers[:-1]).all()


def test_a_board_without_the_driver_says_what_it_lacks(blank_board, tmp_path):
    with pytest.raises(BoardError, match="no module named 'zerorate_i2c|ImportError"):
        record(blank_board.port, tmp_path / "run.csv", seconds=1)
    assert not (tmp_path / "run.csv").exists()


def test_a_board_is_watched_on_a_port_of_any_name_and_free_again(board, tmp_path, capsys):
    setup, link = tmp_path / "setup.py", tmp_path / "tty-a"
    setup.write_text(SETUP)
    link.symlink_to(board.port)
    options = ["--for", "3", "--every", "0.5", "--setup", str(setup)]
    assert main(["watch", str(link), *options]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) >= 2 and all("bias dps" in line for line in lines)
    assert board_says(board, "print('here')") == "here"
