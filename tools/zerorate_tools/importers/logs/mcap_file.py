"""MCAP: messages of ROS 1, of ROS 2, or as JSON."""

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from ...errors import BadRecording
from ..tables.table import Table
from .messages import Logged, is_wanted, table_of_messages

KIND = "MCAP file"
_CODINGS = ("cdr", "ros1", "json")


def read(path: Path, instance: int = 0) -> Table:
    """Raises BadRecording, ModuleNotFoundError."""
    from mcap.reader import make_reader

    file = open(path, "rb")
    summary = make_reader(file).get_summary()
    if summary is None:
        do = "mend it with `mcap recover`"
        raise BadRecording(path, "it has no summary, as of a recording that was cut off", do=do)
    kinds, decoders = {}, {}
    for channel in summary.channels.values():
        schema = summary.schemas.get(channel.schema_id)
        kinds[channel.topic] = schema.name if schema else ""
        if channel.message_encoding not in _CODINGS:
            kinds[channel.topic] = f"in {channel.message_encoding}, which is not read"
        elif schema is not None and is_wanted(schema.name):
            decoders[channel.topic] = _decoder(channel.message_encoding, schema)

    def messages() -> Iterator[Logged]:
        found = make_reader(file).iter_messages(topics=list(decoders), log_time_order=False)
        for _, channel, message in found:
            yield channel.topic, message.log_time, decoders[channel.topic](message.data)

    return table_of_messages(path, kinds, messages)


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
