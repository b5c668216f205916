"""ROS 1 bags (.bag), ROS 2 bags (folders with metadata.yaml, or their .db3 alone), and MCAP.

A ROS 1 bag without its index, as one whose recorder was killed, is read record by record as far as
it goes (http://wiki.ros.org/Bags/Format/2.0).
"""

from __future__ import annotations

import bz2
import io
import json
import sqlite3
import struct
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any, BinaryIO

from ...errors import BadRecording
from ..tables.table import Table
from .messages import Logged, as_far_as_it_goes, is_wanted, table_of_messages

_IMU = "sensor_msgs/msg/Imu"
_FIRST_LINE = b"#ROSBAG V2.0\n"
_MESSAGE, _CHUNK, _CONNECTION = 2, 5, 7
_LENGTH = struct.Struct("<I")
_ENDS = "the file ends within a record"
_TIME = struct.Struct("<II")


def read(path: Path) -> Table:
    """Raises BadRecording, ModuleNotFoundError."""
    return _database(path) if path.suffix == ".db3" else _bag(path)


def _bag(path: Path) -> Table:
    from rosbags.highlevel import AnyReader, AnyReaderError
    from rosbags.typesys import Stores, get_typestore

    bag = AnyReader([path], default_typestore=get_typestore(Stores.LATEST))
    try:
        bag.open()
    except AnyReaderError:
        if path.suffix != ".bag":
            raise
        return _unindexed(UnindexedBag(path, get_typestore(Stores.EMPTY)), path)
    kinds = {one.topic: one.msgtype for one in bag.connections}
    within = {topic: _field_of_imu(bag.typestore, kind) for topic, kind in kinds.items()}
    connections = [one for one in bag.connections if is_wanted(one.msgtype) or within[one.topic]]

    def messages() -> Iterator[Logged]:
        for one, at_ns, raw in bag.messages(connections=connections):
            decode = partial(bag.deserialize, raw, one.msgtype)
            yield one.topic, at_ns, partial(_inner, decode, within[one.topic])

    return table_of_messages(path, {t: _IMU if within[t] else kinds[t] for t in kinds}, messages)


def _unindexed(bag: UnindexedBag, path: Path) -> Table:
    within = {topic: _field_of_imu(bag.store, kind) for topic, kind in bag.kinds.items()}
    within = {topic: field for topic, field in within.items() if field}
    kinds = {topic: _IMU if topic in within else kind for topic, kind in bag.kinds.items()}
    return table_of_messages(path, kinds, lambda: bag.messages(within))


def _inner(decode: Callable[[], Any], field: str | None) -> Any:
    """A message, or the one in that field of it."""
    return getattr(decode(), field) if field else decode()


def _field_of_imu(store: Any, kind: str) -> str | None:
    """The field in which a message of a driver's own holds an Imu, as bags of ROS 1 say it."""
    fields = store.fielddefs.get(kind, ([], []))[1]
    return next((name for name, (_, of) in fields if of == _IMU), None)


def _database(path: Path) -> Table:
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.LATEST)
    bag = sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro", uri=True)
    try:
        bag.execute("PRAGMA writable_schema=ON")  # or no page of one that was cut off is read
        rows = bag.execute("SELECT id, name, type FROM topics").fetchall()
    except sqlite3.DatabaseError as error:
        do = "copy the bag's whole folder again"
        raise BadRecording(path, f"no bag of ROS 2 ({error})", do=do) from error
    kinds = {number: (topic, kind) for number, topic, kind in rows if is_wanted(kind)}

    def messages() -> Iterator[Logged]:
        query = "SELECT topic_id, timestamp, data FROM messages ORDER BY id"
        for number, at_ns, raw in bag.execute(query):
            if number in kinds:
                topic, kind = kinds[number]
                yield topic, at_ns, partial(store.deserialize_cdr, raw, kind)

    return table_of_messages(path, {topic: kind for _, topic, kind in rows}, messages)


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
                decode = partial(self.store.deserialize_ros1, raw, kind)
                yield topic, at_ns, partial(_inner, decode, within.get(topic))

    def _messages(self) -> Iterator[tuple[int, int, bytes]]:
        """(connection, ns, bytes) of each message."""
        with open(self._path, "rb") as file:
            file.seek(len(_FIRST_LINE))
            for fields, data in _records(file, whole=False):
                if fields.get(b"op") == bytes([_CHUNK]):
                    yield from self._in_chunk(_UNPACKED[fields[b"compression"]](data))

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


def _lz4(data: bytes) -> bytes:
    import lz4.frame

    return lz4.frame.LZ4FrameDecompressor().decompress(data)


_UNPACKED: dict[bytes, Callable[[bytes], bytes]] = {
    b"none": bytes,
    b"bz2": lambda data: bz2.BZ2Decompressor().decompress(data),
    b"lz4": _lz4,
}
_CODINGS = ("cdr", "ros1", "json")


def mcap(path: Path) -> Table:
    """MCAP, its messages of ROS or as JSON. Raises BadRecording, ModuleNotFoundError."""
    from mcap.exceptions import McapError
    from mcap.reader import NonSeekingReader, make_reader

    file = open(path, "rb")
    try:
        summary = make_reader(file).get_summary()
    except McapError:
        summary = None
    if summary is None:
        channels, schemas = _of_records(path)
    else:
        channels, schemas = summary.channels, summary.schemas
    kinds, decoders = {}, {}
    for channel in channels.values():
        schema = schemas.get(channel.schema_id)
        kinds[channel.topic] = schema.name if schema else ""
        if channel.message_encoding not in _CODINGS:
            kinds[channel.topic] = f"in {channel.message_encoding}, which is not read"
        elif schema is not None and is_wanted(schema.name):
            decoders[channel.topic] = _decoder(channel.message_encoding, schema)

    def messages() -> Iterator[Logged]:
        file.seek(0)
        # by what follows what in the file, which needs no summary
        found = NonSeekingReader(file).iter_messages(topics=list(decoders), log_time_order=False)
        for _, channel, message in found:
            yield channel.topic, message.log_time, partial(decoders[channel.topic], message.data)

    return table_of_messages(path, kinds, messages)


def _of_records(path: Path) -> tuple[dict[int, Any], dict[int, Any]]:
    """Channels and schemas by number, of a file that has no summary."""
    from mcap.records import Channel, Schema
    from mcap.stream_reader import StreamReader

    found: dict[type, dict[int, Any]] = {Channel: {}, Schema: {}}
    with open(path, "rb") as file:
        try:
            for record in StreamReader(file).records:
                if isinstance(record, (Channel, Schema)):
                    found[type(record)][record.id] = record
        except Exception:  # where it is cut off
            if not found[Channel]:
                raise
    return found[Channel], found[Schema]


def _decoder(coding: str, schema: Any) -> Callable[[bytes], Any]:
    if coding == "json":
        return json.loads
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    described = schema.encoding in ("ros1msg", "ros2msg")
    store = get_typestore(Stores.EMPTY if described else Stores.LATEST)
    kind = schema.name if "/msg/" in schema.name else schema.name.replace("/", "/msg/")
    if described:
        store.register(get_types_from_msg(schema.data.decode(), kind))
    decode = store.deserialize_ros1 if coding == "ros1" else store.deserialize_cdr
    return lambda data: decode(data, kind)
