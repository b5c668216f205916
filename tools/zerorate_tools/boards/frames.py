"""The frames that a board streams: found again after any loss, each with its own checksum.

    A5 5A kind length payload crc32     kind, length: a byte; CRC-32 little-endian of all before

kind 1, a sample: sequence u16, ticks_us u32 (modulo 2^30), status u8, 14 bytes of the chip's data
registers; status is that of MPU6050.read, bit 7 set when the sample was sent before. kind 2, the
scales: JSON. kind 3, a message: text. on_board/stream.py sends them.
"""

import struct
from binascii import crc32
from collections.abc import Iterator

SAMPLE, SCALES, MESSAGE = 1, 2, 3
_SYNC = b"\xa5\x5a"
_HEAD = 4
_CRC = 4
_SAMPLE = struct.Struct("<HIB")
_WORDS = struct.Struct(">7h")
SAMPLE_BYTES = _SAMPLE.size + _WORDS.size


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
        self._bytes = bytearray()

    def feed(self, data: bytes) -> Iterator[tuple[int, bytes]]:
        """Take data; yield (kind, payload) of every frame that is complete and right."""
        self._bytes += data
        while (frame := self._next()) is not None:
            yield frame

    def _next(self) -> tuple[int, bytes] | None:
        while True:
            self._skip_to_sync()
            if len(self._bytes) >= _HEAD and not self._is_plausible():
                self._drop(1)
                continue
            if len(self._bytes) < _HEAD or len(self._bytes) < self._frame_bytes():
                return None
            end = self._frame_bytes()
            body, check = self._bytes[: end - _CRC], self._bytes[end - _CRC : end]
            if crc32(body).to_bytes(_CRC, "little") == check:
                del self._bytes[:end]
                return body[2], bytes(body[_HEAD:])
            self._drop(1)

    def _is_plausible(self) -> bool:
        kind, length = self._bytes[2], self._bytes[3]
        return kind in (SCALES, MESSAGE) or (kind == SAMPLE and length == SAMPLE_BYTES)

    def _frame_bytes(self) -> int:
        return _HEAD + self._bytes[3] + _CRC

    def _skip_to_sync(self) -> None:
        start = self._bytes.find(_SYNC)
        if start < 0:
            start = len(self._bytes) - (1 if self._bytes.endswith(_SYNC[:1]) else 0)
        self._drop(start)

    def _drop(self, count: int) -> None:
        self.skipped += count
        del self._bytes[:count]
