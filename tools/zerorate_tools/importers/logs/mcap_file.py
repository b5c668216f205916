"""MCAP: messages of ROS 1, of ROS 2, or as JSON."""

import json
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

from ..tables.table import Table
from .messages import Logged, is_wanted, table_of_messages

_CODINGS = ("cdr", "ros1", "json")


def read(path: Path, instance: int = 0) -> Table:
    """Raises BadRecording, ModuleNotFoundError."""
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
