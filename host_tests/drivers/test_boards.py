"""Boards on a serial port: flashed and recorded from, the unix port standing in for one."""

import sys
import threading
from pathlib import Path

import pytest
from zerorate_fakes import FakeI2C, FakeMPU6050
from zerorate_fakes.smbus import SMBus
from zerorate_tools.boards import flash, record
from zerorate_tools.boards.connection import BoardError
from zerorate_tools.boards.flashing import package_files
from zerorate_tools.boards.frames import MESSAGE, SAMPLE, FrameReader, encode
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


@pytest.fixture
def board(find_runtime, tmp_path):
    modules = [ROOT / "drivers", ROOT / "host_tests" / "fakes", HERE]
    board = UnixBoard(find_runtime("x86"), tmp_path, modules)
    yield board
    board.close()


@pytest.fixture
def blank_board(find_runtime, tmp_path):
    board = UnixBoard(find_runtime("x86"), tmp_path)
    yield board
    board.close()


class TestFlash:
    def test_a_dry_run_lists_every_file_with_its_size_and_touches_no_port(self):
        said = []
        total = flash("/dev/no-such-port", dry_run=True, say=said.append)
        listed = {line.split()[1]: int(line.split()[0]) for line in said[:-1]}
        assert listed["lib/zerorate_i2c/mpu6050.py"] > 1000
        assert sum(listed.values()) == total
        assert "lib/zerorate_i2c/linux.py" not in listed

    def test_the_board_holds_the_same_files_afterwards_and_they_import(self, blank_board):
        main = HERE / "live_chip.py"
        flash(blank_board.port, main=main, say=lambda line: None)
        for package in ("zerorate", "zerorate_i2c"):
            for name, path in package_files(package).items():
                assert (blank_board.folder / "lib" / name).read_bytes() == path.read_bytes()
        assert (blank_board.folder / "main.py").read_bytes() == main.read_bytes()
        assert board_says(blank_board, "import zerorate_i2c.mpu6050; print(1 + 1)") == "2"

    def test_flashing_again_writes_only_what_changed(self, blank_board, monkeypatch):
        monkeypatch.setattr("zerorate_tools.boards.flashing.PACKAGES", ("zerorate_i2c",))
        flash(blank_board.port, say=lambda line: None)
        changed = blank_board.folder / "lib" / "zerorate_i2c" / "parts.py"
        changed.write_text("old")
        said = []
        flash(blank_board.port, say=said.append)
        written = [line for line in said if line.endswith("  written")]
        assert len(written) == 1 and "parts.py" in written[0]

    def test_the_readable_twin_of_a_model_goes_to_the_board_as_model_bin(
        self, blank_board, tmp_path, monkeypatch
    ):
        monkeypatch.setattr("zerorate_tools.boards.flashing.PACKAGES", ("zerorate",))
        slot = Slot(Term("temp", 20, 45, 32.5, power=2), (0.001, -0.002, 0.0003))
        scales = Scales("MPU-6050", 100.0, 131.0, 16384.0, 340.0, 36.53)
        readable, binary = write_model(build_model([slot], scales), tmp_path)
        flash(blank_board.port, model=readable, say=lambda line: None)
        assert (blank_board.folder / "model.bin").read_bytes() == binary.read_bytes()

    @pytest.mark.parametrize("option", ["main", "model"])
    def test_a_file_that_is_not_there_is_one_line_before_anything_is_written(self, option):
        with pytest.raises(ZerorateError, match="nowhere.*: (no such file|cannot be read)"):
            flash("/dev/no-such-port", **{option: Path("nowhere")})

    def test_no_board_is_one_line(self):
        with pytest.raises(BoardError, match="/dev/no-such-port: cannot be opened"):
            flash("/dev/no-such-port")


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
    def test_a_board_is_watched_and_free_again_afterwards(self, board, tmp_path, capsys):
        setup = tmp_path / "setup.py"
        setup.write_text(SETUP)
        options = ["--for", "3", "--every", "0.5", "--setup", str(setup)]
        assert main(["watch", board.port, *options]) == 0
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

    def test_no_single_changed_byte_gives_a_false_frame(self):
        good = encode(SAMPLE, bytes(range(21)))
        for at in range(len(good)):
            damaged = bytearray(good)
            damaged[at] ^= 0x10
            frames = list(FrameReader().feed(bytes(damaged) + good * 10))
            assert all(payload == bytes(range(21)) for _, payload in frames)
