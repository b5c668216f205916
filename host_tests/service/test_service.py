"""`zerorate run` lives through what a Linux board does to it, and publishes to who asks."""

import json
import os
import resource
import signal
import socket
import sys
import time
import urllib.request

import numpy as np
import pytest
from zerorate.storage.places import FileStorage
from zerorate_fakes import FakeClock, FakeI2C, FakeMPU6050, Physical
from zerorate_i2c.clock import ticks_us
from zerorate_i2c.fifo import EMPTY, Fifo
from zerorate_i2c.mpu6050 import MPU6050
from zerorate_tools.errors import MissingLibrary, ZerorateError
from zerorate_tools.importers import read_foreign
from zerorate_tools.layout import AXIS, axis_at
from zerorate_tools.service import Datagrams, Lines, Metrics, Service, System, UnixSocket
from zerorate_tools.service.serve import notify

from host_tests.service.faulty_day import run

BIAS_DPS = (0.31, -0.19, 0.08)


class CountedFile(FileStorage):
    """A file that notes when it was written, by a board's clock."""

    def __init__(self, path, clock):
        super().__init__(path)
        self.clock, self.writes_us = clock, []

    def write_pieces(self, offset, pieces):
        super().write_pieces(offset, pieces)
        self.writes_us.append(self.clock.now_us)

    def ago_s(self):
        return (self.clock.now_us - self.writes_us[-1]) / 1e6


class Kept:
    """A sink that keeps its lines."""

    lost = 0

    def __init__(self):
        self.lines = []

    def put(self, line):
        self.lines.append(json.loads(line))

    def close(self):
        self.lines.append("closed")


class Board:
    """A chip at rest, its bus, a file, and a service on them."""

    def __init__(self, folder, gyro_dps=BIAS_DPS):
        folder.mkdir(exist_ok=True)
        self.chip = FakeMPU6050(Physical(gyro_dps=gyro_dps))
        self.clock = FakeClock(self.chip)
        self.bus = FakeI2C(self.chip, self.clock)
        self.said, self.told = [], []
        self.file = CountedFile(str(folder / "learned.bin"), self.clock)
        self.system = System(
            *(self.open, self.file, self.clock, self.said.append, self.told.append),
            stored_ago_s=self.file.ago_s,
        )
        self.restart()

    def open(self):
        return MPU6050(self.bus, odr_hz=25, clock=self.clock)

    def restart(self):
        self.kept = Kept()
        self.service = Service(self.system, [self.kept])

    def live(self, seconds):
        end_us = self.clock.now_us + seconds * 1e6
        while self.clock.now_us < end_us:
            self.service.step()


@pytest.fixture(autouse=True)
def everything_in_time():
    """A test that waits for what never comes fails after a minute."""

    def late(*_):
        pytest.fail("it waits for ever")

    before, left_s = signal.signal(signal.SIGALRM, late), signal.alarm(60)
    yield
    signal.alarm(left_s)
    signal.signal(signal.SIGALRM, before)


@pytest.fixture
def board(tmp_path):
    return Board(tmp_path)


def test_a_day_in_small_teaches_nothing_wrong_and_loses_nothing(monkeypatch):
    monkeypatch.setattr("time.time", lambda: 1 / 0)  # a clock set back cannot matter: nobody looks
    found = run(hours=0.4, faults=30, seed=3)
    assert found["worst_mdps"] < 15 and found["rms_mdps"] < 5
    assert found["first_line_after_kill_mdps"] < 30
    assert found["kills"] > found["faults"]["kill"] and found["refused_writes"] > 0
    assert found["downs"] > 10 and found["unexplained_downs"] == 0
    assert found["samples"] > 0.99 * found["samples_due"]


def test_killed_at_a_chip_that_kept_its_power_it_takes_back_all_of_the_offset(board):
    def offsets():
        """The corrector's state, and where in it is what each axis adds to its curve."""
        learner = board.service._corrector.corrector
        places = [axis_at(learner.settings, axis) + AXIS.OFFSET_Q8 for axis in range(3)]
        return learner.state, places

    def restarted():
        board.restart()
        board.service.step()
        state, places = offsets()
        return [state[at] for at in places]

    board.live(20)
    for at, offset_q8 in zip(offsets()[1], (8000, -4000, 2000)):
        offsets()[0][at] = offset_q8
    assert board.service._store.save()
    assert restarted() == [8000, -4000, 2000]
    board.chip.power_up()
    assert restarted() == [4000, -2000, 1000]


def test_restarts_write_once_an_hour_at_most_whatever_ends_them(tmp_path):
    board = Board(tmp_path, lambda _: [bias + board.clock.now_us / 36e9 for bias in BIAS_DPS])
    open_files = len(os.listdir("/proc/self/fd"))
    for number in range(30):
        board.restart()
        board.live(4)
        if number % 2:
            board.service._keep_at_the_end()
        board.clock.now_us += 500_000_000  # switched off
    hours = board.clock.now_us / 3.6e9
    writes_us = board.file.writes_us
    assert hours - 1 <= len(writes_us) <= hours + 1
    assert min(b - a for a, b in zip(writes_us, writes_us[1:])) >= 3.6e9 - 2e6
    assert len(os.listdir("/proc/self/fd")) == open_files


def test_what_it_publishes_is_imported_as_the_chip_gave_it(board, tmp_path):
    given = []
    read = Fifo.read

    def noted(fifo, sample):
        status = read(fifo, sample)
        given.extend([sample[4:7].tolist()] if status != EMPTY else [])
        return status

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Fifo, "read", noted)
        board.live(5)
    lines = board.kept.lines
    (tmp_path / "service.jsonl").write_text("\n".join(map(json.dumps, lines)))
    recording, _ = read_foreign(tmp_path / "service.jsonl")
    rates = np.column_stack([recording.columns[axis] for axis in ("gx", "gy", "gz")])
    assert rates.tolist() == given[-len(lines) :] and board.service.samples == len(lines) > 100
    assert (
        np.diff(recording.columns["t_us"]).tolist() == np.diff([x["t_us"] for x in lines]).tolist()
    )


def asked(port):
    with urllib.request.urlopen(f"http://127.0.0.1:{port}/metrics", timeout=5) as answer:
        return dict(line.rsplit(" ", 1) for line in answer.read().decode().splitlines())


def test_prometheus_has_the_newest_line_and_a_port_in_use_is_one_line(board, monkeypatch):
    pytest.importorskip("prometheus_client")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    metrics = Metrics(f"127.0.0.1:{port}")
    try:
        assert float(asked(port)["zerorate_samples_total"]) == 0
        board.service.sinks = [board.kept, metrics]
        board.live(5)
        found, newest = asked(port), board.kept.lines[-1]
        assert float(found["zerorate_samples_total"]) == len(board.kept.lines)
        assert float(found["zerorate_temperature_degc"]) == newest["temp_degc"]
        parts = {"rate_dps": "rate_dps", "bias_dps": "bias_dps", "accel_g": "acceleration_g"}
        for entry, name in parts.items():
            told = [float(found[f'zerorate_{name}{{axis="{axis}"}}']) for axis in "xyz"]
            assert told == newest[entry] and any(told) and metrics.lost == 0
        with pytest.raises(ZerorateError, match=f"--metrics 127.0.0.1:{port}: .*another port"):
            Metrics(f"127.0.0.1:{port}")
    finally:
        metrics.close()
    with pytest.raises(ZerorateError, match="--remote"):
        Metrics("192.0.2.1:9751")
    monkeypatch.setitem(sys.modules, "prometheus_client", None)
    with pytest.raises(MissingLibrary):
        Metrics(f"127.0.0.1:{port}")


def reader_of(path):
    reader = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    reader.connect(str(path))
    return reader


def test_a_thousand_readers_end_nobody(tmp_path):
    path = tmp_path / "imu.sock"
    sink, readers = UnixSocket(path), []
    for _ in range(1000):
        readers.append(reader_of(path))
        if len(readers) % 2:  # they come in twos
            sink.put(b"{}\n")
    sink.put(b"{}\n")
    assert sink.refused == 900
    for reader in readers:
        reader.close()
    sink.put(b"{}\n")
    sink.put(b"{}\n")
    again = reader_of(path)
    sink.put(b"last\n")
    assert again.recv(100) == b"last\n"
    again.close()
    sink.close()


def test_without_a_descriptor_left_a_reader_waits_and_the_service_lives(tmp_path):
    soft = resource.getrlimit(resource.RLIMIT_NOFILE)
    sink = UnixSocket(tmp_path / "imu.sock")
    reader = reader_of(tmp_path / "imu.sock")
    try:
        resource.setrlimit(resource.RLIMIT_NOFILE, (reader.fileno() + 1, soft[1]))
        sink.put(b"{}\n")
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, soft)
    assert sink.refused == 1
    sink.put(b"later\n")
    assert reader.recv(100) == b"later\n"
    reader.close()
    sink.close()


def test_a_living_socket_is_not_taken_over_and_a_dead_one_is(tmp_path):
    path = tmp_path / "imu.sock"
    sink = UnixSocket(path)
    sink._server.listen(0)
    waiting = reader_of(path)  # and no more can
    with pytest.raises(ZerorateError, match="imu.sock: a service answers there; end it"):
        UnixSocket(path)
    waiting.close()
    sink._server.close()  # killed: the file stays
    taken_over = UnixSocket(path)
    path.unlink()  # by somebody
    taken_over.close()
    path.touch()
    with pytest.raises(ZerorateError, match="imu.sock: is no socket; name another"):
        UnixSocket(path)
    with pytest.raises(ZerorateError, match="none: no such folder; make it"):
        UnixSocket(tmp_path / "none" / "imu.sock")


def test_a_full_stdout_loses_lines_and_nothing_else():
    with open("/dev/full", "w") as full:
        sink = Lines(full)
        for _ in range(1000):
            sink.put(b"{}\n")
    assert sink.lost == 1000


def test_a_pipe_whose_reader_sleeps_holds_nobody_up_and_gets_whole_lines():
    reader, writer = os.pipe()
    with open(writer, "w") as stream:
        sink = Lines(stream)
        for number in range(5000):
            sink.put(json.dumps({"number": number, "more": "x" * 100}).encode() + b"\n")
            if number == 3000:
                taken = os.read(reader, 30000)
        *lines, begun = (taken + os.read(reader, 1 << 20)).split(b"\n")
        os.close(reader)
        with pytest.raises(BrokenPipeError):
            sink.put(b"{}\n")
    assert sink.lost == 5000 - len(lines) - bool(begun) > 1000
    assert json.loads(lines[-1])["number"] > 3000


@pytest.mark.parametrize("address", [":99999", "127.0.0.1:65536", "127.0.0.1:0", "127.0.0.1"])
def test_an_address_that_cannot_be_is_one_line(address):
    with pytest.raises(ZerorateError, match=f"--udp {address}: write ADDRESS:PORT"):
        Datagrams(address)
    for family, whole in ((socket.AF_INET, "127.0.0.1:65535"), (socket.AF_INET6, "[::1]:1")):
        sink = Datagrams(whole)
        assert sink._socket.family == family
        sink.close()


@pytest.mark.parametrize("place", ["@zerorate-{}", "{}"])
def test_systemd_is_told_by_its_socket_with_a_file_or_without(tmp_path, monkeypatch, place):
    place = place.format(tmp_path / "notify")
    monkeypatch.setenv("NOTIFY_SOCKET", place)
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as systemd:
        systemd.bind(place.replace("@", "\0"))
        notify("READY=1")
        assert systemd.recv(100) == b"READY=1"
    monkeypatch.delenv("NOTIFY_SOCKET")
    notify("READY=1")


@pytest.mark.parametrize("register, stuck", [(0x3A, 0x10), (0x72, 0x00)])
def test_a_chip_whose_fifo_is_broken_is_said_and_opened_anew(board, monkeypatch, register, stuck):
    board.live(5)
    samples, read = board.service.samples, board.chip.read
    with monkeypatch.context() as patch:
        patch.setattr(board.chip, "read", lambda at: stuck if at == register else read(at))
        board.live(100)
    assert board.said[1:] == [
        "bus: the chip gave no good sample for a minute; trying again every second"
    ]
    assert board.service.samples == samples
    board.live(5)
    assert board.service.samples > samples + 100


def test_systemd_hears_every_two_seconds_that_the_service_lives(board):
    heard = []
    for wait_us in (0, 1_999_999, 1, 1, 2_500_000):
        board.clock.now_us += wait_us
        board.service._alive()
        heard.append(len(board.told))
    assert heard == [1, 1, 2, 2, 3]


def test_time_goes_on_while_the_machine_is_suspended(monkeypatch):
    monkeypatch.setattr("time.clock_gettime_ns", {time.CLOCK_BOOTTIME: 3_600_000_007_000}.get)
    assert ticks_us() == 3_600_000_007


def test_a_bus_that_opens_but_is_none_leaves_no_descriptor(tmp_path):
    from zerorate_i2c.linux import LinuxI2C

    (tmp_path / "i2c-7").touch()
    before = len(os.listdir("/proc/self/fd"))
    for _ in range(20):
        with pytest.raises(OSError):
            LinuxI2C(str(tmp_path / "i2c-7"))
    assert len(os.listdir("/proc/self/fd")) == before


def test_a_slow_reader_gets_whole_lines_and_holds_nobody_up(tmp_path):
    sink = UnixSocket(tmp_path / "imu.sock")
    reader = reader_of(tmp_path / "imu.sock")
    for number in range(20000):
        sink.put(json.dumps({"number": number, "more": "x" * 100}).encode() + b"\n")
    sink.close()
    text = b"".join(iter(lambda: reader.recv(1 << 16), b""))
    *lines, begun = text.split(b"\n")
    numbers = [json.loads(line)["number"] for line in lines]
    assert numbers == sorted(numbers) and 100 < len(numbers) < 20000
    assert sink.lost == 20000 - len(numbers) - bool(begun)


def test_datagrams_stay_on_this_machine_unless_told():
    with pytest.raises(ZerorateError, match="--remote"):
        Datagrams("192.0.2.1:9750")
    Datagrams("192.0.2.1:9750", remote=True).close()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as reader:
        reader.bind(("127.0.0.1", 0))
        reader.settimeout(5)
        sink = Datagrams(f"127.0.0.1:{reader.getsockname()[1]}")
        sink.put(b"{}\n")
        assert reader.recv(100) == b"{}\n"
        assert not sink._socket.getblocking()  # where the network is full, nobody waits
        sink.put(bytes(70_000))  # more than a datagram has
        assert sink.lost == 1
        sink.close()
