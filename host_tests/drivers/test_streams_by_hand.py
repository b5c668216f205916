"""What a board sends and what becomes of it, without a board: every row, time and count."""

import json
from contextlib import nullcontext
from functools import partial

import numpy as np
import pytest
from zerorate_fakes import FakeClock, FakeI2C, FakeMPU6050
from zerorate_i2c.mpu6050 import MPU6050
from zerorate_tools.boards import port, recorder
from zerorate_tools.boards.connection import BoardError
from zerorate_tools.boards.on_board.stream import Streamer, every
from zerorate_tools.boards.port import (
    MESSAGE,
    SAMPLE,
    SAMPLE_BYTES,
    SCALES,
    BoardStream,
    FrameReader,
    encode,
    sample_of,
)
from zerorate_tools.boards.recorder import COLUMNS, Recorder, scales_of
from zerorate_tools.errors import ZerorateError
from zerorate_tools.model.model import NAMES
from zerorate_tools.recordings import read_recording

FRESH, VERIFIED, SUSPECT, SEEN = 0, 1, 3, 0x80
WORDS = [-32768, 32767, -1, 1, 256, -256]


class Sent:
    """A serial port on which these bytes come."""

    def __init__(self, data):
        self.data = data

    @property
    def in_waiting(self):
        return min(len(self.data), 97)

    def read(self, count):
        assert count == max(1, self.in_waiting)
        data, self.data = self.data[:count], self.data[count:]
        return data


def recorded(data, seconds=None):
    """The rows that are believed, and the counts, of bytes from a board."""
    rows, serial = [], Sent(data)

    def append(columns):
        assert [of.dtype for of in columns.values()] == [np.int64] + [np.int32] * 7
        rows.extend(zip(*(columns[name] for name in COLUMNS)))

    recorder = Recorder([append], 10000.0)
    assert BoardStream(serial, "port").record(recorder, None, lambda s: not serial.data) is None
    return [tuple(map(int, row)) for row in rows], recorder.result


def sample(sequence, t_us, status, last=0):
    words = b"".join(word.to_bytes(2, "big", signed=True) for word in [*WORDS, last])
    head = sequence.to_bytes(2, "little") + t_us.to_bytes(4, "little") + bytes([status])
    assert len(head + words) == SAMPLE_BYTES
    return encode(SAMPLE, head + words)


def frames(*statuses, first=0, t_us=0):
    """Samples 10 ms apart with these statuses, numbered in gz."""
    return b"".join(
        sample((first + i) % 65536, (t_us + 10000 * i) % (1 << 30), status, i)
        for i, status in enumerate(statuses)
    )


def numbers(rows):
    return [row[-1] for row in rows]


def test_what_was_verified_is_believed_and_what_came_after_it_waits():
    rows, result = recorded(frames(FRESH, FRESH, VERIFIED, FRESH))
    assert rows == [(0, *WORDS, 0), (10000, *WORDS, 1)]
    assert (result.samples, result.seconds, result.doubtful) == (2, 0.01, 0)


def test_counter_and_clock_run_round():
    rows, result = recorded(frames(*[FRESH] * 4, VERIFIED, first=65534, t_us=(1 << 30) - 15000))
    assert [row[0] for row in rows] == [0, 10000, 20000, 30000]
    assert (result.dropped, result.lost) == (0, 0)


@pytest.mark.parametrize("first", [100, 65534])
def test_frames_that_never_came_are_counted_by_their_numbers_and_by_time(first):
    data = frames(*[FRESH] * 9, VERIFIED, first=first)
    size = len(data) // 10
    rows, result = recorded(data[: 3 * size] + data[6 * size :])
    assert numbers(rows) == [0, 1, 2, 6, 7, 8]
    assert (result.dropped, result.lost) == (3, 3)


def test_a_sample_in_doubt_is_counted_and_one_seen_before_is_no_row():
    rows, result = recorded(frames(FRESH, SUSPECT, SEEN, FRESH, SEEN | SUSPECT, SEEN | VERIFIED))
    assert numbers(rows) == [0, 3]
    assert result.doubtful == 2


def test_after_a_restart_what_waited_is_in_doubt_and_a_bus_error_leaves_it():
    restart, bus = encode(MESSAGE, b"restarted"), encode(MESSAGE, b"bus: 5")
    data = frames(FRESH, VERIFIED) + frames(FRESH, FRESH, first=2) + restart
    rows, result = recorded(data + bus + bus + frames(FRESH, VERIFIED, first=4))
    assert numbers(rows) == [0, 0]
    assert (result.restarts, result.doubtful, result.bus_errors, result.dropped) == (1, 3, 2, 0)


class Ended(Exception):
    """Enough was streamed."""


@pytest.fixture
def board():
    """A board that streams a chip whose samples count in gz; faults: what happens at which one."""

    def streamed(count, faults):
        chip = FakeMPU6050([[*WORDS, n] for n in range(2 * count)])
        clock = FakeClock(chip)
        bus, sent, waited = FakeI2C(chip, clock=clock), bytearray(), []
        imu = MPU6050(bus, clock=clock, check_every=50)

        def wait():
            waited.append(None)
            if len(waited) == 2 * count:
                raise Ended
            clock.advance_us(imu.period_us // 2)
            faults.get(len(waited) // 2, lambda chip, bus: None)(chip, bus)

        with pytest.raises(Ended):
            Streamer(imu, sent.extend).run(wait)
        return bytes(sent)

    return streamed


def test_what_a_board_streams_is_recorded_sample_by_sample(board):
    data = board(450, {})
    scales = BoardStream(Sent(data), "port").scales()
    assert (scales.sensor, scales.odr_hz, scales.temp_offset_degc) == ("MPU-6050", 100.0, 36.53)
    kinds = [kind for kind, _ in FrameReader().feed(data)]
    before = {kinds[:at].count(SAMPLE) for at, kind in enumerate(kinds) if kind == SCALES}
    assert before == {0, 199, 399}  # for who listens later
    rows, result = recorded(data)
    assert numbers(rows) == list(range(rows[0][-1], rows[0][-1] + len(rows)))
    assert len(rows) == result.samples >= 399 and {row[1:-1] for row in rows} == {tuple(WORDS)}
    assert rows[-1][0] / (len(rows) - 1) == pytest.approx(10000, rel=0.01)
    assert (result.dropped, result.lost, result.bytes_skipped, result.restarts) == (0, 0, 0, 0)


def test_a_sample_of_a_board_is_a_frame_of_its_numbers(monkeypatch):
    sent, slept = [], []
    streamer = Streamer(None, lambda frame: sent.append(bytes(frame)))
    streamer.sequence, streamer.sample = 65535, [*WORDS, 5]
    streamer.send_sample(SUSPECT, (1 << 31) - 1)
    streamer.send_sample(FRESH, 1 << 30)
    streamer.send_text(MESSAGE, "x" * 300)
    *samples, (_, text) = FrameReader().feed(b"".join(sent))
    expected = [(65535, (1 << 30) - 1, SUSPECT), (0, 0, FRESH)]
    assert [sample_of(of) for _, of in samples] == [(*e, (*WORDS, 5)) for e in expected]
    assert text == b"x" * 255
    monkeypatch.setattr("time.sleep", slept.append)
    every(10_000)()
    assert slept == [0.005]


def test_a_brown_out_and_a_dead_bus_of_a_board_are_told(board):
    faults = {
        120: lambda chip, bus: chip.power_up(),
        300: lambda chip, bus: bus.fault("nack", times=30),
    }
    rows, result = recorded(board(450, faults))
    assert result.restarts == 1 and result.bus_errors >= 1
    assert {row[1:-1] for row in rows} == {tuple(WORDS)}
    assert all(a < b for a, b in zip(numbers(rows), numbers(rows)[1:]))


@pytest.mark.parametrize("ends", [False, True])
def test_a_port_is_recorded_and_streamed_as_its_frames_say(board, monkeypatch, tmp_path, ends):
    data, programs = board(300, {}), []

    class Board(Sent):
        exec_raw_no_follow, serial = programs.append, property(lambda self: self)

        def read(self, count):
            if ends and not self.data:
                raise OSError
            return super().read(count)

    there = [Board(data), Board(data)]
    monkeypatch.setattr(port, "connected", lambda name: nullcontext(there[len(programs)]))
    rows, out, alone = [], tmp_path / "run.csv", recorded(data)[0]

    def done(seconds):
        return not ends and not there[len(programs) - 1].data

    def take(scales):
        append = lambda c: rows.extend(zip(*(c[n].tolist() for n in COLUMNS)))  # noqa: E731
        return Recorder([append], 1e6 / scales.odr_hz)

    with pytest.raises(BoardError, match="are in .*run.csv") if ends else nullcontext():
        found = recorder.recorded(
            out, None, partial(port.stream_port, "port", setup="imu = 1", done=done)
        )
        assert (found.samples, found.lost, found.part) == (len(read_recording(out)), 0, "MPU-6050")
    with pytest.raises(BoardError) if ends else nullcontext():
        port.stream_port("port", take, done=done, odr_hz=50.0)
    columns = read_recording(out).columns
    assert rows == [*zip(*(columns[name].tolist() for name in COLUMNS))]
    assert rows[: len(alone)] == alone and (len(rows) == len(alone)) is ends
    assert "imu = 1" in programs[0]
    assert "MPU6050(I2C(0, freq=400000), **{'odr_hz': 50.0})" in programs[1]


def test_a_set_up_of_its_own_says_what_the_chip_is_set_to():
    with pytest.raises(ZerorateError, match="--setup"):
        port.stream_port("port", print, setup="imu = 1", odr_hz=50.0)


HEADER = {"odr_hz": 50, "gyro_lsb_per_dps": 16.4, "accel_lsb_per_g": 2048, "part": "X"}
HEADER |= {"temp_lsb_per_degc": 340, "temp_offset_degc": 36.53, "source": "a board"}


def test_the_scales_come_behind_what_else_a_board_says():
    said = {**HEADER, "binding": [*range(3, 3 + len(NAMES))]}
    data = b"MPY: soft reboot\r\n" + frames(FRESH) + encode(MESSAGE, b"restarted")
    data += encode(SCALES, json.dumps(said).encode())
    scales = BoardStream(Sent(data), "port").scales()
    assert (scales.odr_hz, scales.gyro_lsb_per_dps, scales.accel_lsb_per_g) == (50, 16.4, 2048)
    assert scales.more["source"] == "port"
    (kept,) = [value for value in scales.more.values() if isinstance(value, dict)]
    assert [*kept.values()] == said["binding"]
    assert not any(isinstance(value, dict) for value in scales_of(HEADER).more.values())


@pytest.mark.parametrize(
    "wrong",
    [
        {"binding": [0] * (len(NAMES) - 1)},
        {"binding": [0] * (len(NAMES) + 1)},
        {"odr_hz": None},
        {"odr_hz": "fast"},
        {"binding": [float("inf")] + [0] * (len(NAMES) - 1)},
    ],
)
def test_a_board_whose_scales_cannot_be_read_is_refused(wrong):
    head = {**HEADER, **wrong}
    with pytest.raises(BoardError, match="cannot be read"):
        BoardStream(Sent(encode(SCALES, json.dumps(head).encode())), "port").scales()


class Says:
    """A serial port that gives these answers, each a second after the one before."""

    def __init__(self, monkeypatch, *answers):
        self.answers, self.seconds, self.in_waiting = [*answers], 0.0, 0
        monkeypatch.setattr(port.time, "monotonic", lambda: self.seconds)

    def read(self, count):
        assert count == 1
        self.seconds += 1
        answer = self.answers.pop(0) if self.answers else b""
        if isinstance(answer, Exception):
            raise answer
        return answer


@pytest.mark.parametrize(
    ("answers", "after_s", "told"),
    [
        ([], 11, "10 s"),
        ([b"."] * 7, 18, "10 s"),
        ([b"Traceback (most", b" recent call last):\n", b"OSError: 5\r\n\x04>"], 4, "OSError: 5"),
        ([b".", OSError(5)], 2, "port: "),
    ],
)
def test_a_board_that_ends_or_falls_silent_is_told_in_time(monkeypatch, answers, after_s, told):
    serial = Says(monkeypatch, *answers)
    with pytest.raises(BoardError, match=told):
        BoardStream(serial, "port").scales()
    assert serial.seconds == after_s


def test_a_stream_ends_when_its_time_is_up(monkeypatch):
    serial = Says(monkeypatch, *[frames(VERIFIED)] * 99)
    told = []
    recorder = Recorder([], 10000.0)
    assert BoardStream(serial, "port").record(recorder, 8.0, told.append) is None
    assert serial.seconds == 8 and told == [1.0] * 8


STEADY_US = np.arange(1000) * 10000
JITTER_US = np.random.default_rng(1).uniform(-4500, 4500, 1000)


@pytest.mark.parametrize(
    ("times_us", "lost"),
    [
        pytest.param(STEADY_US, 0, id="steady"),
        pytest.param(STEADY_US * 0.97, 0, id="a clock 3 % slow"),
        pytest.param(STEADY_US * 1.03, 0, id="a clock 3 % fast"),
        pytest.param(STEADY_US * 1.0615, 0, id="late by half a period less an eighth's pull"),
        pytest.param(STEADY_US[:99] * 1.064, 2, id="and by more"),
        pytest.param(STEADY_US + JITTER_US, 0, id="jitter"),
        pytest.param(np.delete(STEADY_US, 300), 1, id="one is missing"),
        pytest.param(np.delete(STEADY_US, range(300, 317)), 17, id="17 are missing"),
        pytest.param(np.delete(STEADY_US, range(300, 800)), 500, id="500 are missing"),
        pytest.param(np.delete(STEADY_US[:308], 300), 0, id="one, perhaps"),
        pytest.param(np.delete(STEADY_US[:309], 300), 1, id="one, for the next stay late"),
        pytest.param(STEADY_US + 16_900 * (STEADY_US == 2_000_000), 0, id="a late one"),
        pytest.param(STEADY_US + 17_100 * (STEADY_US == 2_000_000), 2, id="far too late"),
    ],
)
def test_a_gap_in_time_counts_what_is_missing(times_us, lost):
    recorder = Recorder([], 10000)
    for t_us in times_us:
        recorder.add(int(t_us), [0] * 7)
    assert recorder.result.lost == lost


def test_frames_come_out_of_pieces_of_any_length():
    stream = b"".join(encode(SAMPLE, bytes([n] * 21)) for n in range(50))
    for size in (1, 2, 7, 29, 1000):
        reader = FrameReader()
        pieces = [stream[at : at + size] for at in range(0, len(stream), size)]
        frames = [frame for piece in pieces for frame in reader.feed(piece)]
        assert [payload[0] for _, payload in frames] == list(range(50))
        assert reader.skipped == 0


def test_noise_before_and_between_is_skipped_and_counted():
    reader = FrameReader()
    frame = encode(MESSAGE, b"restarted")
    noise = b"\xa5hello\0\0\0\0\0\xa5\x5a"
    assert len(list(reader.feed(noise + frame + b"xyz" + frame))) == 2
    assert reader.skipped == len(noise) + 3


@pytest.mark.parametrize("length", [0, 20, 22, 255])
def test_a_sample_of_another_length_holds_no_later_one_back(length):
    good = encode(SAMPLE, bytes(range(21)))
    damaged = good[:3] + bytes([length]) + good[4:]
    assert len(list(FrameReader().feed(damaged + good + good))) == 2
    of_no_kind = [encode(SAMPLE, bytes(length)), encode(0, bytes(21)), encode(4, bytes(21))]
    assert FrameReader().feed(b"".join(of_no_kind)) == []


def test_no_single_changed_byte_gives_a_false_frame():
    good = encode(SAMPLE, bytes(range(21)))
    for at in range(len(good)):
        damaged = bytearray(good)
        damaged[at] ^= 0x10
        frames = list(FrameReader().feed(bytes(damaged) + good * 10))
        assert all(payload == bytes(range(21)) for _, payload in frames)
