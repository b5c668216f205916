"""ROS 1 bags (.bag) and ROS 2 bags: folders with metadata.yaml, or their .db3 alone."""

import sqlite3
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

from ...errors import BadRecording
from ..tables.table import Table
from .messages import Logged, is_wanted, table_of_messages
from .unindexed_bag import UnindexedBag

KIND = "ROS bag"
_IMU = "sensor_msgs/msg/Imu"


def read(path: Path, instance: int = 0) -> Table:
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
        for connection, at_ns, raw in bag.messages(connections=connections):
            field = within[connection.topic]
            yield connection.topic, at_ns, partial(decoded, raw, connection.msgtype, field)

    def decoded(raw: bytes, kind: str, field: str | None) -> Any:
        message = bag.deserialize(raw, kind)
        return getattr(message, field) if field else message

    return table_of_messages(path, {t: _IMU if within[t] else kinds[t] for t in kinds}, messages)


def _unindexed(bag: UnindexedBag, path: Path) -> Table:
    within = {topic: _field_of_imu(bag.store, kind) for topic, kind in bag.kinds.items()}
    within = {topic: field for topic, field in within.items() if field}
    kinds = {topic: _IMU if topic in within else kind for topic, kind in bag.kinds.items()}
    return table_of_messages(path, kinds, lambda: bag.messages(within))


def _field_of_imu(store, kind: str) -> str | None:
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
