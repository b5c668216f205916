"""A ROS 1 bag without its index, as one whose recorder was killed: record by record, as far as it
goes. The format is http://wiki.ros.org/Bags/Format/2.0."""

import bz2
import io
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any, BinaryIO

from .messages import Logged, as_far_as_it_goes, is_wanted

_FIRST_LINE = b"#ROSBAG V2.0\n"
_MESSAGE, _CHUNK, _CONNECTION = 2, 5, 7
_LENGTH = struct.Struct("<I")
_ENDS = "the file ends within a record"
_TIME = struct.Struct("<II")


class UnindexedBag:
    """kinds: topic -> type, of all connections that can be reached; store: with their types."""

    def __init__(self, path: Path, store: Any) -> None:
        self._path, self.store = path, store
        self._connections: dict[int, tuple[str, str]] = {}
        for _ in as_far_as_it_goes(self._messages(), []):
            pass
        self.kinds = dict(self._connections.values())

    def messages(self, within: dict[str, str | None]) -> Iterator[Logged]:
        """Those of the topics of `within`, which says in which field an Imu is, if in one."""
        for number, at_ns, raw in self._messages():
            topic, kind = self._connections[number]
            if topic in within or is_wanted(kind):
                yield topic, at_ns, self._decoder(raw, kind, within.get(topic))

    def _decoder(self, raw: bytes, kind: str, field: str | None):
        def decoded() -> Any:
            message = self.store.deserialize_ros1(raw, kind)
            return getattr(message, field) if field else message

        return decoded

    def _messages(self) -> Iterator[tuple[int, int, bytes]]:
        """(connection, ns, bytes) of each message."""
        with open(self._path, "rb") as file:
            file.seek(len(_FIRST_LINE))
            for fields, data in _records(file, whole=False):
                if fields.get(b"op") == bytes([_CHUNK]):
                    unpacked: dict[bytes, Any] = {b"none": bytes, b"bz2": _bz2, b"lz4": _lz4}
                    yield from self._in_chunk(unpacked[fields[b"compression"]](data))

    def _in_chunk(self, chunk: bytes) -> Iterator[tuple[int, int, bytes]]:
        for fields, data in _records(io.BytesIO(chunk), whole=True):
            op = fields[b"op"][0]
            if op == _CONNECTION:
                self._connect(fields, data)
            elif op == _MESSAGE:
                sec, nsec = _TIME.unpack(fields[b"time"])
                yield _LENGTH.unpack(fields[b"conn"])[0], sec * 10**9 + nsec, data

    def _connect(self, fields: dict[bytes, bytes], data: bytes) -> None:
        from rosbags.typesys import get_types_from_msg

        number = _LENGTH.unpack(fields[b"conn"])[0]
        if number in self._connections:
            return
        about = _fields(data)
        kind = about[b"type"].decode().replace("/", "/msg/")
        self.store.register(get_types_from_msg(about[b"message_definition"].decode(), kind))
        self._connections[number] = fields[b"topic"].decode(), kind


def _records(file: BinaryIO, whole: bool) -> Iterator[tuple[dict[bytes, bytes], bytes]]:
    """Header and data of each; of one that is cut off, what there is, where not only whole ones
    will do. Raises EOFError behind it."""
    while head := file.read(_LENGTH.size):
        fields = _fields(_read(file, _LENGTH.unpack(head)[0]))
        size = _LENGTH.unpack(_read(file, _LENGTH.size))[0]
        data = file.read(size)
        if len(data) == size or not whole:
            yield fields, data
        if len(data) < size:
            raise EOFError(_ENDS)


def _read(file: BinaryIO, size: int) -> bytes:
    data = file.read(size)
    if len(data) < size:
        raise EOFError(_ENDS)
    return data


def _fields(data: bytes) -> dict[bytes, bytes]:
    out, at = {}, 0
    while at < len(data):
        size = _LENGTH.unpack_from(data, at)[0]
        at += _LENGTH.size
        name, _, value = data[at : at + size].partition(b"=")
        out[name] = value
        at += size
    return out


def _bz2(data: bytes) -> bytes:
    return bz2.BZ2Decompressor().decompress(data)


def _lz4(data: bytes) -> bytes:
    import lz4.frame

    return lz4.frame.LZ4FrameDecompressor().decompress(data)
