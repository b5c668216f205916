"""Linux: the bus through smbus2, and a recording from it: every verified sample, once."""

import errno
import os
import signal
import subprocess
import sys
from array import array
from functools import partial
from io import FileIO
from pathlib import Path
from unittest import mock

import numpy as np
import pytest
from numpy.lib.stride_tricks import sliding_window_view
from zerorate_fakes import FakeClock, FakeI2C, FakeMPU6050
from zerorate_fakes.smbus import SMBus
from zerorate_i2c.fifo import Fifo
from zerorate_i2c.linux import LinuxI2C
from zerorate_i2c.mpu6050 import MPU6050
from zerorate_tools import cli
from zerorate_tools.boards import bus, fake_chip
from zerorate_tools.boards.bus import stream_bus
from zerorate_tools.boards.fake_chip import FakeBus
from zerorate_tools.boards.recorder import Recorder, recorded
from zerorate_tools.boards.recording import record, stream
from zerorate_tools.cli import main
from zerorate_tools.errors import InFile, ZerorateError
from zerorate_tools.recordings import Recording, Scales, growing, read_recording
from zerorate_tools.recordings.recording import GYRO
from zerorate_tools.simulate import simulate

from host_tests.drivers.linux_bus.machine import fetch, run_guest

SCALES = Scales("MPU-6050", 10.0, 131.0)


def counting():
    number = 0
    while True:
        yield (number % 7, 3, 16384, -3000 + number % 5, 40, -20 - number % 3, number)
        number += 1


class Machine:
    """A bus with a chip, and the file recorded from it."""

    def __init__(self, folder, kind=FakeI2C):
        self.chip = FakeMPU6050(counting())
        self.clock = FakeClock(self.chip)
        self.bus = kind(self.chip, clock=self.clock)
        self.out = folder / "run.parquet"

    def record(self, seconds=10, **options):
        options |= {"seconds": seconds, "time_source": self.clock}
        return recorded(self.out, None, partial(stream_bus, self.bus, **options))

    def columns(self):
        return read_recording(self.out).columns

    def at(self, seconds, what):
        """Do something when so many seconds have passed."""
        passed_us = self.clock.advance_us
        due = [(self.clock.now_us + seconds * 1e6, what)]

        def advance_us(us):
            passed_us(us)
            while due and self.clock.now_us >= due[0][0]:
                due.pop()[1]()

        self.clock.advance_us = advance_us


class NoFifo(FakeI2C):
    """A bus as i2c-stub makes it: registers, but no FIFO."""

    def readfrom_mem_into(self, addr, memaddr, buf):
        super().readfrom_mem_into(addr, memaddr, buf)
        if memaddr == 0x72:
            buf[:] = bytes(len(buf))


@pytest.fixture
def machine(tmp_path):
    return Machine(tmp_path)


@pytest.fixture(params=[FakeI2C, NoFifo], ids=["fifo", "polled"])
def any_machine(request, tmp_path):
    return Machine(tmp_path, request.param)


def test_every_sample_is_recorded_once_with_its_time_and_the_chips_scales(any_machine):
    machine = any_machine
    result = machine.record(odr_hz=100, full_scale_dps=2000, full_scale_g=16)
    scales = read_recording(machine.out).scales
    assert (scales.gyro_lsb_per_dps, scales.accel_lsb_per_g, scales.odr_hz) == (16.4, 2048, 100)
    columns = machine.columns()
    assert result.samples == len(columns["gz"]) == pytest.approx(1000, abs=60)
    assert (np.diff(columns["gz"]) == 1).all()
    assert result.lost == result.doubtful == 0
    assert np.diff(columns["t_us"]).mean() == pytest.approx(10000, rel=0.01)
    assert result.rate_hz == pytest.approx(100, rel=0.01)


@pytest.mark.parametrize(("hz", "every"), [(10, 5), (None, 50), (200, 100), (1000, 100)])
def test_a_chip_is_verified_twice_a_second_or_every_hundred_samples(
    machine, monkeypatch, hz, every
):
    asked = mock.Mock(side_effect=OSError)
    monkeypatch.setattr(bus, "MPU6050", asked)
    with pytest.raises(OSError):
        machine.record(**({"odr_hz": hz} if hz else {}))
    assert asked.call_args.kwargs["check_every"] == every


def test_a_brown_out_costs_samples_but_gives_no_false_one(any_machine):
    machine = any_machine
    machine.at(3.3, machine.chip.power_up)
    result = machine.record()
    columns = machine.columns()
    assert result.restarts == 1
    assert (columns["ax"] == columns["gz"] % 7).all()
    assert (np.diff(columns["gz"]) > 0).all()


def test_a_bus_that_fails_for_a_while_is_waited_for(any_machine):
    machine = any_machine
    machine.at(3, lambda: machine.bus.fault("nack", times=30))
    result = machine.record()
    assert result.bus_errors >= 30
    assert result.samples > 800
    assert result.lost > 0


@pytest.mark.parametrize(("hz", "slept_ms"), [(1000, {5, 18, 100}), (100, {50, 100})])
def test_it_waits_for_five_samples_a_quarter_of_the_fifo_and_a_bus(machine, hz, slept_ms):
    wait = machine.clock.sleep_ms = mock.Mock(wraps=machine.clock.sleep_ms)
    machine.at(1, lambda: machine.bus.fault("nack", times=9))
    machine.record(seconds=2, odr_hz=hz)
    assert {call.args[0] for call in wait.mock_calls} == slept_ms | {60}  # the driver's own


def test_another_chip_ends_the_recording_with_an_error_that_names_it(machine):
    other = FakeMPU6050(counting(), "MPU-6500")
    machine.at(5, lambda: machine.bus.devices.update({0x68: other}))
    with pytest.raises(ZerorateError, match="MPU-6500"):
        machine.record(seconds=60)


def test_no_chip_writes_no_file(machine):
    machine.bus.devices.clear()
    with pytest.raises(OSError, match="nothing answers"):
        machine.record()
    assert not machine.out.exists()


def test_a_bus_that_fails_for_good_keeps_what_was_verified_and_says_so(machine):
    machine.at(5, lambda: machine.bus.fault("nack", times=None))
    with pytest.raises(ZerorateError, match=r"; 4\d\d samples, .* are in .*run.parquet"):
        machine.record(seconds=60)
    assert len(machine.columns()["gz"]) == pytest.approx(475, abs=25)
    assert machine.clock.now_us / 1e6 == pytest.approx(10.2, abs=0.3)  # 5 s of patience


def test_what_is_streamed_is_what_is_recorded(any_machine):
    rows = []

    def take(scales):
        assert (scales.odr_hz, scales.more["source"]) == (100.0, "I2C")
        append = lambda columns: rows.extend(columns["gz"])  # noqa: E731
        return Recorder([append], 1e6 / scales.odr_hz)

    machine = any_machine
    machine.at(3, lambda: machine.bus.fault("nack", times=5))
    stream_bus(machine.bus, take, seconds=6, time_source=machine.clock)
    assert 450 < len(rows) < 600 and (np.diff(rows) > 0).all()
    least = 600 * (3 if isinstance(machine.bus, NoFifo) else 1)
    assert least < machine.bus.transfers < 1.25 * least
    machine.bus.fault("nack", times=None)
    with pytest.raises(OSError):
        stream_bus(machine.bus, take, seconds=60, time_source=machine.clock)


def test_a_signal_ends_a_recording_that_is_then_whole(machine):
    machine.at(4, lambda: signal.raise_signal(signal.SIGTERM))
    result = machine.record(seconds=None)
    assert result.samples == len(machine.columns()["gz"]) > 380
    assert [p.name for p in machine.out.parent.iterdir()] == ["run.parquet"]


def test_progress_is_told_each_second_and_may_end_a_recording(machine):
    told = []
    result = machine.record(seconds=8.5, done=told.append)
    assert len(told) == 8 and sum(told) == pytest.approx(8, abs=0.5)
    assert machine.record(seconds=60, done=lambda seconds: True).seconds < 1.5 < result.seconds


def test_what_was_not_verified_at_the_end_is_not_believed(machine):
    result = machine.record(done=lambda seconds: machine.bus.fault("nack", times=None) or True)
    assert len(machine.columns()["gz"]) == result.samples < 99
    assert result.samples + result.doubtful == pytest.approx(100, abs=9)


def test_a_full_disk_is_no_bus_error_and_all_before_it_is_kept(machine, monkeypatch):
    class FullFile(FileIO):
        def write(self, data):
            if self.tell() > 10_000:
                super().write(data[:100])  # torn, as full disks do
                raise OSError(errno.ENOSPC, "said by the system")
            return super().write(data)

    monkeypatch.setattr(growing, "FileIO", FullFile)
    with pytest.raises(InFile, match=r"run.parquet: no more can be written: .*; the \d+ samples"):
        machine.record(seconds=60)
    assert len(machine.columns()["gz"]) > 200
    assert [p.name for p in machine.out.parent.iterdir()] == ["run.parquet"]


def test_the_command_ends_with_1_where_every_sample_is_in_doubt(machine, monkeypatch, capsys):
    machine.at(0.28, machine.chip.power_up)
    monkeypatch.setattr(fake_chip, "in_hand", lambda: (machine.bus, machine.clock, 60.0))
    words = ["record", "fake:", "--out", str(machine.out), "--seconds", "0.3"]
    assert cli.main(words) == 1
    assert " 5 dropped" in capsys.readouterr().out
    assert list(machine.out.parent.iterdir()) == []


def test_an_emulated_chip_is_recorded_as_the_hand_moves_and_no_longer(tmp_path, monkeypatch):
    bus, clock, seconds = fake_chip.in_hand()
    monkeypatch.setattr(fake_chip, "in_hand", lambda: (bus, clock, 2.0))
    out, hand = tmp_path / "run.csv", simulate("in-hand")[0]
    assert seconds == pytest.approx((len(hand) - 1) / hand.scales.odr_hz)
    moved = hand.columns["gx"][:900]
    for words in ([], ["--seconds", "3"]):
        assert cli.main(["record", "fake:", "--out", str(out), *words]) == 0
        felt = read_recording(out).columns["gx"]
        assert len(felt) in range(190, 210)
        assert (sliding_window_view(moved, len(felt)) == felt).all(axis=1).sum() == 1


def test_an_older_recording_stays_where_no_sample_comes(machine):
    machine.out.write_bytes(b"older")
    machine.at(0.4, lambda: machine.bus.fault("nack", times=None))
    with pytest.raises(ZerorateError, match="no sample had come"):
        machine.record(seconds=60)
    assert machine.out.read_bytes() == b"older"
    assert [p.name for p in machine.out.parent.iterdir()] == ["run.parquet"]


@pytest.mark.parametrize(
    ("words", "part", "hz"),
    [
        ("--hz 1000", "MPU-6050", 1000),
        ("--part mpu6500 --address 0x69", "MPU-6500", 100),
    ],
)
def test_the_emulated_chip_is_of_the_part_and_the_rate_asked_for(tmp_path, words, part, hz):
    out = tmp_path / "x.csv"
    line = ["record", "fake:", "--out", str(out), "--seconds", "2", *words.split()]
    assert cli.main(line) == 0 and cli.main([*line, "--part", "nosuch"]) == 2
    recording = read_recording(out)
    assert recording.scales.sensor == part and len(recording) > 1.9 * hz


def test_an_emulated_chip_that_rests_is_streamed_in_real_time():
    made = []
    stream("fake:", lambda scales: made.append(Recorder([], 1e4)) or made[0], seconds=0.3)
    assert made[0].result.samples > 9


def test_an_emulated_chip_that_rests_has_a_bias():
    imu, rates = MPU6050(FakeBus()), array("i", [0] * 7)
    imu.clock.sleep_ms(20)
    imu.read(rates)
    assert list(rates[4:]) == pytest.approx([0.31 * 131, -0.19 * 131, 0.08 * 131], abs=20)


def test_a_simulated_hand_feels_nothing_new_after_its_recording():
    felt = fake_chip._over_time(Recording({n: np.arange(9) for n in GYRO}, SCALES, "run"), GYRO, 2)
    assert [felt(s)[0] for s in (0.0, 0.26, 0.8, 99.0)] == pytest.approx([0, 1.3, 4, 4])


pytest.importorskip("smbus2")


def test_a_setting_no_part_can_take_is_one_line(tmp_path, monkeypatch):
    bus = SMBus(FakeI2C(FakeMPU6050()))
    monkeypatch.setattr(pytest.importorskip("smbus2"), "SMBus", lambda number: bus)
    with pytest.raises(ZerorateError, match="/dev/i2c-1: full_scale_dps is one of"):
        record("/dev/i2c-1", tmp_path / "run.csv", full_scale_dps=300)


def test_a_chip_that_does_not_answer_is_told_with_its_bus(tmp_path, imu_bus, smbus, capsys):
    imu_bus.devices.clear()
    assert main(["record", "1", "--out", str(tmp_path / "run.csv")]) == 2
    assert capsys.readouterr().err.startswith("zerorate: /dev/i2c-1: nothing answers")


@pytest.mark.parametrize(
    ("name", "bus"),
    [
        ("/dev/i2c-1", "/dev/i2c-1"),
        ("12", "/dev/i2c-12"),
        ("/dev/ttyACM0", 0),
        ("/dev/i2c-", 0),
        ("x1", 0),
    ],
)
def test_a_number_is_a_bus_and_what_is_none_a_port(monkeypatch, name, bus):
    asked, refuse = [], mock.Mock(side_effect=OSError)
    monkeypatch.setattr("zerorate_i2c.linux.LinuxI2C", lambda of: asked.append(of) or refuse())
    monkeypatch.setattr("zerorate_tools.boards.port.stream_port", refuse)
    for how in (record, stream):
        with pytest.raises(OSError):
            how(name, Path("run.csv"), seconds=3.0)
    assert asked == [bus] * 2 * bool(bus)
    assert all(bus or c.args[0] == name and c.kwargs["seconds"] == 3 for c in refuse.mock_calls)


@pytest.mark.parametrize("raw_i2c", [True, False], ids=["i2c_rdwr", "blocks"])
def test_samples_come_through_smbus2_in_batches_that_the_bus_can_carry(raw_i2c):
    chip = FakeMPU6050([[1, -2, 3, -4, 5, -6, row] for row in range(100)])
    clock = FakeClock(chip)
    imu = MPU6050(LinuxI2C(SMBus(FakeI2C(chip), raw_i2c)), clock=clock)
    fifo, sample = Fifo(imu), array("i", [0] * 7)
    clock.advance_us(80000)
    for _ in range(7):
        fifo.read(sample)
    assert list(sample[:6]) == [1, -2, 3, -4, 5, -6]
    assert fifo.frames == 7 and fifo.lost == 0


def test_a_read_too_long_for_blocks_and_a_missing_bus_are_refused():
    bus = LinuxI2C(SMBus(FakeI2C(FakeMPU6050()), raw_i2c=False))
    with pytest.raises(ValueError, match="32 bytes"):
        bus.readfrom_mem_into(0x68, 0x3B, bytearray(33))
    with pytest.raises(OSError):
        LinuxI2C("/dev/i2c-of-no-machine")


HOLDER = """
import fcntl, sys
file = open(sys.argv[1], "r+")
fcntl.lockf(file, fcntl.LOCK_EX, 1, 0x68)
input(print("held", flush=True))
"""


def test_the_chip_of_another_program_is_said_and_the_one_beside_it_is_had(tmp_path, monkeypatch):
    (tmp_path / "i2c-1").touch()
    command = [sys.executable, "-c", HOLDER, str(tmp_path / "i2c-1")]
    clock = FakeClock(chip := FakeMPU6050(), other := FakeMPU6050())
    bus = SMBus(FakeI2C({0x68: chip, 0x69: other}))
    monkeypatch.setattr("fcntl.ioctl", mock.Mock())
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
    with open(tmp_path / "i2c-1", "r+") as file, subprocess.Popen(command, **pipes) as holder:
        bus.fd = file.fileno()
        assert holder.stdout.readline() == "held\n"
        MPU6050(LinuxI2C(bus), 0x69, clock=clock)
        with pytest.raises(OSError, match="^.Errno 16. another program.* has the chip at 0x68$"):
            MPU6050(LinuxI2C(bus), clock=clock)
        holder.communicate("\n")
        MPU6050(LinuxI2C(bus), clock=clock)


@pytest.mark.skipif(
    not os.environ.get("ZERORATE_REQUIRE_LINUX_BUS"),
    reason="it boots a Linux for half a minute; ZERORATE_REQUIRE_LINUX_BUS=1 does so, as in CI",
)
def test_a_real_kernels_bus_is_recorded_from():
    fetch()
    found = run_guest()
    assert found["code"] == 0 and found["rows"] > 60
    assert found["false_rows"] == found["out_of_order"] == 0
    assert found["really_lost"] < found["rows"]
    assert found["said_lost"] == pytest.approx(found["really_lost"], abs=found["rows"] / 10)
