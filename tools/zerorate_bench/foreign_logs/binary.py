"""Small files in foreign formats, written byte by byte from the formats' own descriptions."""

import json
import struct
from collections.abc import Callable, Collection, Iterable, Sequence
from functools import reduce
from operator import xor
from pathlib import Path
from typing import Any

import numpy as np
from mcap.writer import Writer
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Writer2
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from .world import World

#: {topic: {field: (type, values)}}.
Topics = dict[str, dict[str, tuple[str, np.ndarray]]]
Rows = Sequence[tuple[float, ...]]
#: Topic, ns, message.
_Message = tuple[str, int, Any]
SHORT = World(600, 200.0)


def ulog(path: Path, topics: Topics) -> None:
    """A PX4 ULog (PX4 user guide, ULog file format)."""
    types = {"uint64_t": "<u8", "float": "<f4", "float[3]": "<f4"}
    out = [b"ULog\x01\x12\x35\x01" + struct.pack("<Q", 0)]

    def message(kind: str, body: bytes) -> None:
        out.append(struct.pack("<HB", len(body), ord(kind)) + body)

    message("B", bytes(40))
    for name, fields in topics.items():
        listed = "".join(f"{kind} {field};" for field, (kind, _) in fields.items())
        message("F", f"{name}:{listed}".encode())
    for number, name in enumerate(topics):
        message("A", struct.pack("<BH", 0, number) + name.encode())
    for number, fields in enumerate(topics.values()):
        columns = [np.asarray(values).astype(types[kind]) for kind, values in fields.values()]
        for row in zip(*columns):
            message("D", struct.pack("<H", number) + b"".join(cell.tobytes() for cell in row))
    path.write_bytes(b"".join(out))


def dataflash_of_2015(path: Path, rows: Rows) -> None:
    """An ArduPilot log as it was in 2015: rows of TimeMS, gyro, accel, T."""
    _dataflash(path, "TimeMS,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,Temp", "Ifffffff", "<I7f", rows)


def dataflash(path: Path, rows: Rows) -> None:
    """An ArduPilot DataFlash log: FMT messages, then IMU rows (TimeUS, I, gyro, accel, T)."""
    _dataflash(path, "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,T", "QBfffffff", "<QB7f", rows)


def _dataflash(path: Path, labels: str, letters: str, body: str, rows: Rows) -> None:
    head, out = b"\xa3\x95", []
    for kind, length, *words in (
        (128, 89, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns"),
        (131, 3 + struct.calcsize(body), "IMU", letters, labels),
    ):
        texts = (str(word).encode() for word in words)
        out.append(head + struct.pack("<BBB4s16s64s", 128, kind, length, *texts))
    out += [head + bytes([131]) + struct.pack(body, *row) for row in rows]
    path.write_bytes(b"".join(out))


def vectornav_line(rates: Sequence[float], accel: Sequence[float], temp: float) -> str:
    """One $VNIMU line with its checksum."""
    mag = "-00.2382,+00.7281,+00.2867"
    acc = ",".join(f"{v:+07.3f}" for v in accel)
    gyro = ",".join(f"{v:+010.6f}" for v in rates)
    text = f"VNIMU,{mag},{acc},{gyro},{temp:+05.1f},+096.559"
    return f"${text}*{reduce(xor, text.encode()):02X}"


def bag(
    folder: Path,
    kind: str,
    imu: bool = True,
    world: World = SHORT,
    torn: Collection[int] = (),
) -> Path:
    """A world's sensor_msgs/Imu, and Temperature at every 200th sample; where it is.

    kind: ros1, ros2 (a folder), db3 (its file alone), mcap, mcap-json. torn: numbers of JSON
    messages that are cut off.
    """
    stores = Stores.ROS1_NOETIC if kind == "ros1" else Stores.LATEST
    messages = [m for m in _messages(get_typestore(stores), world) if imu or m[0] != "/imu/data"]
    folder.mkdir(exist_ok=True)
    if kind == "mcap-json":
        return _mcap_of_json(folder / "run.mcap", messages, torn)
    if kind == "ros1":
        return _ros1(folder / "run.bag", messages, get_typestore(stores))
    path = folder / kind
    plugin = StoragePlugin.MCAP if kind == "mcap" else StoragePlugin.SQLITE3
    with Writer2(path, version=9, storage_plugin=plugin) as writer:
        store = get_typestore(stores)
        _write(writer, messages, store, store.serialize_cdr)
    return path if kind == "ros2" else next(path.glob("*.db3" if kind == "db3" else "*.mcap"))


def bag_of_a_driver(path: Path) -> Path:
    """A bag of ROS 1 whose messages, of a driver's own type, hold an Imu each."""
    store = get_typestore(Stores.ROS1_NOETIC)
    store.register(get_types_from_msg("string raw\nsensor_msgs/Imu imu", "driver/msg/Own"))
    own = store.types["driver/msg/Own"]
    messages = [(t, ns, own("$", one)) for t, ns, one in _messages(store) if t == "/imu/data"]
    return _ros1(path, messages, store)


def _ros1(path: Path, messages: list[_Message], store: Any) -> Path:
    path.unlink(missing_ok=True)
    with Writer1(path) as writer:
        _write(writer, messages, store, store.serialize_ros1)
    return path


def _messages(store: Any, world: World = SHORT) -> list[_Message]:
    types = store.types

    def header(ns: int) -> Any:
        time = types["builtin_interfaces/msg/Time"]
        stamp = time(sec=1_700_000_000 + ns // 10**9, nanosec=ns % 10**9)
        more = {"seq": 0} if "seq" in types["std_msgs/msg/Header"].__dataclass_fields__ else {}
        return types["std_msgs/msg/Header"](stamp=stamp, frame_id="imu", **more)

    vector = types["geometry_msgs/msg/Vector3"]
    nothing = np.zeros(9)
    readings = zip(*(of.tolist() for of in (world.whole(1e9), world.rad, world.mps2, world.degc)))
    out = []
    for i, (ns, rate, force, degc) in enumerate(readings):
        if i % 200 == 0:
            warm = types["sensor_msgs/msg/Temperature"]
            out.append(("/imu/temperature", ns, warm(header(ns), degc, 0.0)))
        message = types["sensor_msgs/msg/Imu"](
            header=header(ns),
            orientation=types["geometry_msgs/msg/Quaternion"](0.0, 0.0, 0.0, 1.0),
            orientation_covariance=nothing,
            angular_velocity=vector(*rate),
            angular_velocity_covariance=nothing,
            linear_acceleration=vector(*force),
            linear_acceleration_covariance=nothing,
        )
        out.append(("/imu/data", ns, message))
    return out


def _write(writer: Any, messages: list[_Message], store: Any, encode: Callable[..., Any]) -> None:
    connections: dict[str, Any] = {}
    for topic, ns, message in messages:
        if topic not in connections:
            connections[topic] = writer.add_connection(topic, message.__msgtype__, typestore=store)
        writer.write(connections[topic], ns, encode(message, message.__msgtype__))


def _mcap_of_json(path: Path, messages: list[_Message], torn: Collection[int]) -> Path:
    with open(path, "wb") as file:
        writer = Writer(file, chunk_size=1 << 16)
        writer.start()
        channels = {}
        for number, (topic, ns, message) in enumerate(messages):
            if topic not in channels:
                schema = writer.register_schema(message.__msgtype__, "jsonschema", b"{}")
                channels[topic] = writer.register_channel(topic, "json", schema)
            data = json.dumps(message, default=_as_json).encode()
            data = data[: len(data) // 2] if number in torn else data
            writer.add_message(channels[topic], ns, data, ns)
        writer.finish()
    return path


def _as_json(part: Any) -> Any:
    return part.tolist() if isinstance(part, np.ndarray) else vars(part)


def blackbox(path: Path, rows: Iterable[tuple[int, ...]]) -> None:
    """A Betaflight log of intra frames: time, three gyro counts of 1 dps, three of 1/2048 g."""
    names = ["loopIteration", "time", *(f"gyroADC[{i}]" for i in range(3))]
    names += [f"accSmooth[{i}]" for i in range(3)]
    fields = {
        "name": ",".join(names),
        **{"signed": "0,0,1,1,1,1,1,1", "predictor": "0,0,0,0,0,0,0,0"},
        "encoding": "1,1,0,0,0,0,0,0",
    }
    lines = ["Product:Blackbox flight data recorder by Nicholas Sherlock", "Data version:2"]
    lines += ["I interval:1", "P interval:1/1", "Firmware revision:Betaflight 4.3.0"]
    lines += [f"Field I {key}:{row}" for key, row in fields.items()]
    lines += ["gyro_scale:0x3f800000", "acc_1G:2048", "minthrottle:1070", "vbatref:160"]
    out = [f"H {line}\n".encode() for line in lines]
    for number, (at_us, *counts) in enumerate(rows):
        zigzag = [count * 2 if count >= 0 else -count * 2 - 1 for count in counts]
        out.append(b"I" + b"".join(map(_varint, (number, at_us, *zigzag))))
    path.write_bytes(b"".join(out) + b"E\xffEnd of log\x00")


def _varint(value: int) -> bytes:
    out = bytearray()
    while value > 127:
        out.append(value & 127 | 128)
        value >>= 7
    return bytes([*out, value])
