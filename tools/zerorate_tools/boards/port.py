"""A recording from a board: its frames over the serial port, with every drop counted."""

from __future__ import annotations

import json
import struct
import sys
import time
from binascii import crc32
from collections.abc import Callable
from importlib.resources import files
from typing import TYPE_CHECKING, Any

from ..ending import noted_signals
from ..errors import ZerorateError
from ..recordings import Scales
from ..recordings.scales import scales_from_text
from .connection import BoardError, connected, said
from .recorder import COLUMNS, Recorder, Take, scales_of

if TYPE_CHECKING:
    from serial import Serial

_TICKS = 1 << 30
_SILENCE_S = 10.0
_VERIFIED, _SUSPECT, _SEEN_BEFORE = 1, 3, 0x80
SAMPLE, SCALES, MESSAGE = 1, 2, 3
#: On the pins that the board's port calls I2C 0.
_DEFAULT = """from machine import I2C
from zerorate_i2c.mpu6050 import MPU6050
imu = MPU6050(I2C(0, freq=400000), **{!r})"""
_SYNC = b"\xa5\x5a"
_HEAD = 4  # the two bytes of _SYNC, kind, length of the payload
_KIND = 2
_CRC = 4
_SAMPLE = struct.Struct("<HIB")
_WORDS = struct.Struct(">7h")
SAMPLE_BYTES = _SAMPLE.size + _WORDS.size


def stream_port(
    port: str,
    take: Take,
    *,
    seconds: float | None = None,
    setup: str = "",
    done: Callable[[float], object] = lambda seconds: None,
    **chip: Any,
) -> None:
    """Start the streamer on the board at port; hand what it sends to what take(scales) makes.

    setup: MicroPython source that makes `imu`, an MPU6050 (default: on I2C(0), with chip, options
    of MPU6050).
    seconds None streams until a signal that ends programs, or until done returns what is true.
    Raises ZerorateError for setup and chip together, and BoardError for a board that is silent for
    10 s, unplugged, or cannot run the streamer.
    """
    if setup and chip:
        raise ZerorateError("--setup makes the chip; set its address, rate and ranges there")
    with connected(port) as board:
        board.exec_raw_no_follow(program(setup or _DEFAULT.format(chip)))
        stream = BoardStream(board.serial, port)
        taker = take(stream.scales())
        failure = stream.record(taker, seconds, done)
        taker.discard() if failure else taker.confirm()
    if failure:
        raise failure


def program(setup: str) -> str:
    """What the board runs: the streamer's own text, then setup, then the stream."""
    return f"{_text('stream.py')}\n{setup}\nstream(imu)\n"


def _text(name: str) -> str:
    return files(__package__).joinpath(f"on_board/{name}").read_text(encoding="utf-8")


class BoardStream:
    """What comes from a board that streams: scales, samples and messages."""

    def __init__(self, serial: Serial, port: str) -> None:
        self._serial = serial
        self._port = port
        self._reader = FrameReader()
        self._ticks_us: int | None = None
        self._t_us = 0
        self._sequence: int | None = None
        self._heard = time.monotonic()
        self._tail = b""

    def scales(self) -> Scales:
        """The first scales that come. Raises BoardError with what the board said instead."""
        while True:
            for kind, payload in self._frames():
                if kind == SCALES:
                    return self._checked_scales(payload)

    def _checked_scales(self, payload: bytes) -> Scales:
        try:
            scales = scales_of({**json.loads(payload), "source": self._port})
            return scales_from_text(json.dumps(scales.to_json()), self._port, COLUMNS)
        except (ValueError, TypeError, KeyError, ArithmeticError) as error:
            what = "what the board says of its scales cannot be read"
            raise BoardError(f"{self._port}: {what}; is its `imu` an MPU6050?") from error

    def record(
        self, recorder: Recorder, seconds: float | None, done: Callable[[float], object]
    ) -> BoardError | None:
        """Hand samples to recorder until time is up or a signal came; the error that ended it."""
        begun = time.monotonic()
        reported = begun
        with noted_signals() as came:
            while not came and (seconds is None or time.monotonic() - begun < seconds):
                try:
                    frames = self._frames()
                except BoardError as error:
                    return error
                for kind, payload in frames:
                    self._take(recorder, kind, payload)
                recorder.result.bytes_skipped = self._reader.skipped
                if done(time.monotonic() - reported):
                    return None
                reported = time.monotonic()
        return None

    def _take(self, recorder: Recorder, kind: int, payload: bytes) -> None:
        if kind == SAMPLE:
            self._take_sample(recorder, payload)
        elif kind == MESSAGE:
            if payload.startswith(b"restarted"):
                recorder.result.restarts += 1
                recorder.discard()
            else:
                recorder.result.bus_errors += 1

    def _take_sample(self, recorder: Recorder, payload: bytes) -> None:
        sequence, ticks_us, status, words = sample_of(payload)
        if self._ticks_us is not None:
            self._t_us += (ticks_us - self._ticks_us) % _TICKS
        self._ticks_us = ticks_us
        if self._sequence is not None:
            recorder.result.dropped += (sequence - self._sequence - 1) % 65536
        self._sequence = sequence
        was_seen, status = divmod(status, _SEEN_BEFORE)
        if status == _VERIFIED:
            recorder.confirm()
        if status == _SUSPECT:
            recorder.result.doubtful += 1
        elif not was_seen:
            recorder.add(self._t_us, words)

    def _frames(self) -> list[tuple[int, bytes]]:
        try:
            data = self._serial.read(max(1, self._serial.in_waiting))
        except OSError as error:
            raise BoardError(f"{self._port}: unplugged, or taken by another program") from error
        if data:
            self._heard = time.monotonic()
            self._tail = (self._tail + data)[-4096:]
        elif b"Traceback" in self._tail:
            # only when no more of it comes is its last line the one that says what is wrong
            raise BoardError(f"{self._port}: {said(self._tail.decode(errors='replace'))}")
        elif time.monotonic() - self._heard > _SILENCE_S:
            raise BoardError(
                f"{self._port}: silent for {_SILENCE_S:.0f} s; press the board's reset, "
                "check the chip's wires and the pins of --setup"
            )
        return self._reader.feed(data)


def encode(kind: int, payload: bytes) -> bytes:
    """One frame. Raises ValueError for more than 255 bytes."""
    body = _SYNC + bytes([kind, len(payload)]) + payload
    return body + crc32(body).to_bytes(_CRC, "little")


def sample_of(payload: bytes) -> tuple[int, int, int, tuple[int, ...]]:
    """(sequence, ticks_us, status, seven words) of a sample's payload."""
    sequence, ticks_us, status = _SAMPLE.unpack_from(payload)
    return sequence, ticks_us, status, _WORDS.unpack_from(payload, _SAMPLE.size)


class FrameReader:
    """Frames out of a stream of bytes in pieces of any length; skipped counts what was no frame."""

    def __init__(self) -> None:
        self.skipped = 0
        self._held = b""

    def feed(self, data: bytes) -> list[tuple[int, bytes]]:
        """Take data; (kind, payload) of every frame that is complete and right."""
        held, at, frames = self._held + data, 0, []
        while (end := _end(held, at)) <= len(held):
            body, check = held[at : end - _CRC], held[end - _CRC : end]
            if end > at and crc32(body).to_bytes(_CRC, "little") == check:
                frames.append((body[_KIND], body[_HEAD:]))
                at = end
            else:
                self.skipped += 1
                at += 1
        self._held = held[at:]
        return frames


def _end(held: bytes, at: int) -> int:
    """Where the frame that begins at a place ends, be it beyond what came; the place for none."""
    head = held[at : at + _HEAD]
    if not _SYNC.startswith(head[: len(_SYNC)]):
        return at
    if len(head) < _HEAD:
        return sys.maxsize
    kind, length = head[_KIND:]
    if kind in (SCALES, MESSAGE) or (kind, length) == (SAMPLE, SAMPLE_BYTES):
        return at + _HEAD + length + _CRC
    return at
