"""ROS 1 bags (.bag) and ROS 2 bags: folders with metadata.yaml, or their .db3 alone."""

import sqlite3
from collections.abc import Iterator
from pathlib import Path

from ...errors import BadRecording
from ..tables.table import Table
from .messages import Logged, is_wanted, table_of_messages

KIND = "ROS bag"
_IMU = "sensor_msgs/msg/Imu"


def read(path: Path, instance: int = 0) -> Table:
    """Raises BadRecording, ModuleNotFoundError."""
    return _database(path) if path.suffix == ".db3" else _bag(path)


def _bag(path: Path) -> Table:
    from rosbags.highlevel import AnyReader
    from rosbags.typesys import Stores, get_typestore

    bag = AnyReader([path], default_typestore=get_typestore(Stores.LATEST))
    bag.open()
    kinds = {one.topic: one.msgtype for one in bag.connections}
    within = {topic: _field_of_imu(bag.typestore, kind) for topic, kind in kinds.items()}
    connections = [one for one in bag.connections if is_wanted(one.msgtype) or within[one.topic]]

    def messages() -> Iterator[Logged]:
        for connection, at_ns, raw in bag.messages(connections=connections):
            message = bag.deserialize(raw, connection.msgtype)
            field = within[connection.topic]
            yield connection.topic, at_ns, getattr(message, field) if field else message

    return table_of_messages(path, {t: _IMU if within[t] else kinds[t] for t in kinds}, messages)


def _field_of_imu(store, kind: str) -> str | None:
    """The field in which a message of a driver's own holds an Imu, as bags of ROS 1 say it."""
    fields = store.fielddefs.get(kind, ([], []))[1]
    return next((name for name, (_, of) in fields if of == _IMU), None)


def _database(path: Path) -> Table:
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.LATEST)
    bag = sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro", uri=True)
    try:
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
                yield topic, at_ns, store.deserialize_cdr(raw, kind)

    return table_of_messages(path, {topic: kind for _, topic, kind in rows}, messages)
