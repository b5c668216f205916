"""Boards on a serial port: flashed and recorded from, the unix port standing in for one."""

import os
import pty
import re
import sys
import threading
from functools import cache
from pathlib import Path, PurePosixPath
from unittest import mock

import pytest
from zerorate_fakes import FakeI2C, FakeMPU6050
from zerorate_fakes.smbus import SMBus
from zerorate_tools.boards import compiling
from zerorate_tools.boards.connection import BoardError, BoardFacts, listening
from zerorate_tools.boards.flashing import flash, older
from zerorate_tools.boards.parts import needs
from zerorate_tools.boards.port import MESSAGE, SAMPLE, FrameReader, encode
from zerorate_tools.boards.recording import record, stream
from zerorate_tools.cli import main
from zerorate_tools.errors import ZerorateError
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


class TestPortThatDoesNotOpen:
    """Each reason has its own sentence, with what to do."""

    def said(self, capsys, port):
        assert main(["flash", str(port)]) == 2
        (line,) = capsys.readouterr().err.splitlines()
        return line

    def test_no_such_port(self, capsys):
        assert "is not there" in self.said(capsys, "/dev/no-such-port")

    def test_a_port_that_another_program_has_open(self, capsys):
        serial = pytest.importorskip("serial")
        _, slave = pty.openpty()
        with serial.Serial(os.ttyname(slave), exclusive=True):
            assert "another program has it open" in self.said(capsys, os.ttyname(slave))

    @pytest.mark.parametrize("name", ["a-file", "."])
    def test_what_is_no_serial_port(self, capsys, tmp_path, name):
        (tmp_path / "a-file").write_text("")
        assert "is no serial port" in self.said(capsys, tmp_path / name)

    def test_who_listens_has_the_port_alone_and_sends_nothing(self):
        board, slave = pty.openpty()
        os.set_blocking(board, False)
        with listening(os.ttyname(slave)):
            with pytest.raises(BoardError), listening(os.ttyname(slave)):
                pass
            with pytest.raises(BlockingIOError):
                os.read(board, 1)

    def test_a_port_of_another_group(self, capsys, monkeypatch):
        def refuse(*args, **options):
            raise PermissionError(13, "Permission denied")

        monkeypatch.setattr("serial.Serial.open", refuse)
        assert "dialout" in self.said(capsys, "/dev/ttyACM0")


@pytest.mark.parametrize(
    ("mpy", "architecture", "told"),
    [((6, 1), "armv6m", True), ((6, 2), "rv32imc", True), ((6, 3), "armv6m", False)]
    + [((6, 2), "xtensawin", False), ((5, 0), "armv6m", False)],
)
def test_a_micropython_too_old_for_machine_code_is_told(mpy, architecture, told):
    lines = older(BoardFacts(version=(1, 22, 0), mpy=mpy, architecture=architecture))
    assert bool(lines) == told
    cycles = needs()["cycles"]
    slower = cycles["bytecode"] / cycles["median"]
    for line in lines:
        assert re.findall(r"\d+\.\d+", line) == ["{}.{}".format(*compiling.mpy_version()), "1.23"]
        assert float(re.search(r"(\d+) times", line)[1]) == pytest.approx(slower, abs=5)


class TestFlash:
    @pytest.fixture
    def flashed(self, blank_board):
        """Flash the blank board; what was said, and what came of it."""

        def run(**options):
            said = []
            return said, flash(blank_board.port, say=said.append, **options)

        return run

    def test_a_dry_run_without_a_board_lists_what_any_board_would_get(self):
        said = []
        flashed = flash("/dev/no-such-port", dry_run=True, say=said.append)
        assert "/dev/no-such-port: is not there" in said[0]
        assert PurePosixPath("lib/zerorate_i2c/mpu6050.mpy") in flashed.files
        assert f"{flashed.total:8d}  bytes" in said[-2]
        assert "heap needed" in said[-1]

    def test_a_dry_run_writes_nothing_and_says_what_the_board_has(self, flashed, blank_board):
        said, _ = flashed(dry_run=True)
        assert "MicroPython 1." in said[0]
        assert any(re.search(r"heap needed: [\d,]+ bytes; it has [\d,]+ free", s) for s in said)
        assert list(blank_board.folder.iterdir()) == []

    def test_the_board_imports_what_was_compiled_for_it(self, flashed, blank_board):
        main = HERE / "live_chip.py"
        _, done = flashed(main=main)
        there = {str(p.relative_to(blank_board.folder)) for p in files_below(blank_board.folder)}
        assert there == {str(name) for name in done.files}
        assert (blank_board.folder / "main.py").read_bytes() == main.read_bytes()
        assert board_says(blank_board, "import zerorate, zerorate_i2c.mpu6050; print(2)") == "2"

    def test_a_part_that_is_asked_for_comes_and_the_others_do_not(self, flashed, blank_board):
        flashed(parts=["bursts"])
        assert board_says(blank_board, "import zerorate.bursts, zerorate_i2c.fifo; print(2)") == "2"
        assert not list(blank_board.folder.rglob("in_motion*"))

    def test_a_model_brings_what_it_needs(self, flashed, blank_board, tmp_path):
        model = tmp_path / "made" / "model.bin"
        slot = Slot(Term("temp", 20.0, 45.0, 30.0), (0.01, 0.0, 0.0))
        write_model(
            build_model([slot], Scales("MPU-6050", 100, 131, 16384, 340, 36.53)), model.parent
        )
        flashed(model=model)
        names = {path.name for path in (blank_board.folder / "lib/zerorate").rglob("*.mpy")}
        assert {"model.mpy", "effects.mpy", "model_file.mpy"} <= names

    def test_only_what_changed_is_sent_and_what_was_there_goes(self, flashed, blank_board):
        flashed()
        library = blank_board.folder / "lib"
        (library / "zerorate_i2c" / "parts.mpy").write_text("old")
        (library / "zerorate_i2c" / "parts.py").write_text("shadows it")
        (library / "others.py").write_text("not of this project")
        _, again = flashed()
        assert [name.name for name in again.sent] == ["parts.mpy"]
        assert not (library / "zerorate_i2c" / "parts.py").exists()
        assert (library / "others.py").exists()

    def test_a_package_that_arrives_damaged_replaces_nothing(
        self, flashed, blank_board, monkeypatch
    ):
        flashed()
        before = contents(blank_board.folder / "lib")
        monkeypatch.setattr("zerorate_tools.boards.flashing.b64encode", lambda data: b"AAAA")
        with pytest.raises(BoardError, match="did not arrive whole and nothing was replaced"):
            flashed(parts=["motion"])
        assert contents(blank_board.folder / "lib") == before
        monkeypatch.undo()
        flashed(parts=["motion"])
        assert list(blank_board.folder.rglob("in_motion.mpy"))

    def test_a_flash_that_was_cut_short_goes_on_where_it_was(self, flashed, monkeypatch):
        from zerorate_tools.boards.flashing import Installer

        sent, send = [], Installer._send

        def send_ten(self, path, data):
            if len(sent) == 10:
                raise BoardError("unplugged")
            sent.append(len(data))
            send(self, path, data)

        monkeypatch.setattr(Installer, "_send", send_ten)
        with pytest.raises(BoardError, match="unplugged"):
            flashed()
        monkeypatch.undo()
        said, again = flashed()
        assert 7 <= sum("sent before" in line for line in said) <= 10
        assert again.sent_bytes < again.total

    def test_a_board_of_another_mpy_version_gets_the_source(self, flashed, monkeypatch):
        monkeypatch.setattr("zerorate_tools.boards.compiling.mpy_version", lambda: (7, 0))
        _, done = flashed()
        assert {name.suffix for name in done.files} == {".py"}

    def test_the_readable_twin_of_a_model_goes_to_the_board_as_model_bin(
        self, flashed, blank_board, tmp_path_factory
    ):
        slot = Slot(Term("temp", 20, 45, 32.5, power=2), (0.001, -0.002, 0.0003))
        scales = Scales("MPU-6050", 100.0, 131.0, 16384.0, 340.0, 36.53)
        readable, binary = write_model(
            build_model([slot], scales), tmp_path_factory.mktemp("models")
        )
        flashed(model=readable)
        assert (blank_board.folder / "model.bin").read_bytes() == binary.read_bytes()

    @pytest.mark.parametrize("option", ["main", "model"])
    def test_a_file_that_is_not_there_is_one_line_before_anything_is_written(self, option):
        with pytest.raises(ZerorateError, match="nowhere.*: (no such file|cannot be read)"):
            flash("/dev/no-such-port", **{option: Path("nowhere")})


def files_below(folder):
    return [path for path in folder.rglob("*") if path.is_file()]


def contents(folder):
    return {path.relative_to(folder): path.read_bytes() for path in files_below(folder)}


class TestRecord:
    def test_every_sample_of_the_board_is_in_the_recording(self, board, tmp_path):
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

    def test_bytes_lost_on_the_port_are_counted_and_give_no_false_row(self, board, tmp_path):
        out = tmp_path / "run.csv"
        threading.Timer(2.0, board.drop, [40]).start()
        result = record(board.port, out, seconds=4, setup=SETUP)
        numbers = read_recording(out).columns["gz"]
        assert result.dropped >= 1
        assert result.bytes_skipped > 0
        assert (numbers[1:] > numbers[:-1]).all()

    def test_the_board_is_free_again_afterwards(self, board, tmp_path):
        record(board.port, tmp_path / "run.csv", seconds=1, setup=SETUP)
        assert board_says(board, "print('here')") == "here"

    def test_a_board_without_the_driver_says_what_it_lacks(self, blank_board, tmp_path):
        with pytest.raises(BoardError, match="no module named 'zerorate_i2c|ImportError"):
            record(blank_board.port, tmp_path / "run.csv", seconds=1)
        assert not (tmp_path / "run.csv").exists()

    def test_a_board_unplugged_ends_with_what_had_come(self, board, tmp_path):
        out = tmp_path / "run.csv"
        threading.Timer(2.5, board.close).start()
        with pytest.raises(BoardError):
            record(board.port, out, seconds=60, setup=SETUP)
        assert len(read_recording(out).columns["gz"]) > 0


class TestWatch:
    def test_a_board_is_watched_on_a_port_of_any_name_and_free_again(self, board, tmp_path, capsys):
        setup, link = tmp_path / "setup.py", tmp_path / "tty-a"
        setup.write_text(SETUP)
        link.symlink_to(board.port)
        options = ["--for", "3", "--every", "0.5", "--setup", str(setup)]
        assert main(["watch", str(link), *options]) == 0
        lines = capsys.readouterr().out.splitlines()
        assert len(lines) >= 2 and all("bias dps" in line for line in lines)
        assert board_says(board, "print('here')") == "here"

    def test_no_board_is_one_line(self, capsys):
        assert main(["watch", "/dev/ttyACM99"]) == 2
        assert capsys.readouterr().err.count("\n") == 1


def board_says(board, source):
    from zerorate_tools.boards.connection import connected

    with connected(board.port) as transport:
        return transport.exec(source).decode().strip()


class TestLinuxBus:
    @pytest.fixture
    def bus(self, monkeypatch):
        smbus2 = pytest.importorskip("smbus2")
        bus = SMBus(FakeI2C(FakeMPU6050()))
        monkeypatch.setattr(smbus2, "SMBus", lambda number: bus)

    def test_a_setting_no_part_can_take_is_one_line(self, bus, tmp_path):
        with pytest.raises(ZerorateError, match="/dev/i2c-1: full_scale_dps is one of"):
            record("/dev/i2c-1", tmp_path / "run.csv", full_scale_dps=300)

    @pytest.mark.parametrize(
        ("name", "bus"),
        [
            ("/dev/i2c-1", "/dev/i2c-1"),
            ("12", 12),
            ("/dev/ttyACM0", 0),
            ("/dev/i2c-", 0),
            ("x1", 0),
        ],
    )
    def test_a_number_is_a_bus_and_what_is_none_a_port(self, monkeypatch, name, bus):
        asked, refuse = [], mock.Mock(side_effect=OSError)
        monkeypatch.setattr("zerorate_i2c.linux.LinuxI2C", lambda of: asked.append(of) or refuse())
        for verb in ("record_port", "stream_port"):
            monkeypatch.setattr(f"zerorate_tools.boards.port.{verb}", refuse)
        for how in (record, stream):
            with pytest.raises(OSError):
                how(name, Path("run.csv"), seconds=3.0)
        assert asked == [bus] * 2 * bool(bus)
        assert all(bus or c.args[0] == name and c.kwargs["seconds"] == 3 for c in refuse.mock_calls)

    def test_no_such_bus_is_an_os_error(self, tmp_path):
        with pytest.raises(OSError):
            record("/dev/i2c-99999", tmp_path / "run.csv")


class TestFrames:
    def test_frames_come_out_of_pieces_of_any_length(self):
        stream = b"".join(encode(SAMPLE, bytes([n] * 21)) for n in range(50))
        for size in (1, 2, 7, 29, 1000):
            reader = FrameReader()
            pieces = [stream[at : at + size] for at in range(0, len(stream), size)]
            frames = [frame for piece in pieces for frame in reader.feed(piece)]
            assert [payload[0] for _, payload in frames] == list(range(50))
            assert reader.skipped == 0

    def test_noise_before_and_between_is_skipped_and_counted(self):
        reader = FrameReader()
        frame = encode(MESSAGE, b"restarted")
        noise = b"\xa5hello\xa5\x5a"
        assert len(list(reader.feed(noise + frame + b"xyz" + frame))) == 2
        assert reader.skipped == len(noise) + 3

    @pytest.mark.parametrize("length", [0, 20, 22, 255])
    def test_a_sample_of_another_length_holds_no_later_one_back(self, length):
        good = encode(SAMPLE, bytes(range(21)))
        damaged = good[:3] + bytes([length]) + good[4:]
        assert len(list(FrameReader().feed(damaged + good + good))) == 2

    def test_no_single_changed_byte_gives_a_false_frame(self):
        good = encode(SAMPLE, bytes(range(21)))
        for at in range(len(good)):
            damaged = bytearray(good)
            damaged[at] ^= 0x10
            frames = list(FrameReader().feed(bytes(damaged) + good * 10))
            assert all(payload == bytes(range(21)) for _, payload in frames)
