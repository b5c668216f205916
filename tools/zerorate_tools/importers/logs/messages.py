"""ROS messages of inertial sensors and thermometers as rows, named as PlotJuggler names them."""

from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

from ...errors import BadRecording
from ..tables.table import Table, chunks_of

#: Type -> paths of the numbers in a message.
_FIELDS = {
    "Imu": [f"{v}/{a}" for v in ("angular_velocity", "linear_acceleration") for a in "xyz"],
    "Temperature": ["temperature"],
    "Float32": ["data"],
    "Float64": ["data"],
}
_UNITS = {"temperature": " [degc]"}
_TIME = "t_us"

#: topic, when it was logged in nanoseconds, what decodes the message
Logged = tuple[str, int, Callable[[], Any]]
T = TypeVar("T")


def is_wanted(kind: str) -> bool:
    """Whether messages of this type (`sensor_msgs/msg/Imu`, `sensor_msgs/Imu`) are read."""
    return kind.rpartition("/")[2] in _FIELDS


def table_of_messages(
    path: Path, topics: dict[str, str], messages: Callable[[], Iterator[Logged]]
) -> Table:
    """A row a message, with the columns of its topic. topics: topic -> type.

    Raises BadRecording where no topic holds rates.
    """
    wanted = {topic: kind.rpartition("/")[2] for topic, kind in topics.items() if is_wanted(kind)}
    if "Imu" not in wanted.values():
        has = ", ".join(f"{topic} ({kind})" for topic, kind in list(topics.items())[:12])
        problem = "no topic of type sensor_msgs/Imu"
        raise BadRecording(path, problem, do=f"name a bag that has one; this has {has or 'none'}")
    columns = {
        topic: {field: f"{topic}/{field}{_UNITS.get(field, '')}" for field in _FIELDS[kind]}
        for topic, kind in wanted.items()
    }
    names = [_TIME, *(name for of in columns.values() for name in of.values())]

    def rows() -> Iterator[dict[str, float]]:
        for topic, logged_ns, decoded in as_far_as_it_goes(messages(), table.notes):
            try:
                message = decoded()
            except MemoryError:
                raise
            except Exception:  # a message of bytes that are none of its type
                table.dropped["a message that cannot be decoded"] += 1
                yield {}
                continue
            values = {name: _number(message, field) for field, name in columns[topic].items()}
            yield {_TIME: _time_us(message, logged_ns), **values}

    table = Table(names, partial(chunks_of, rows), sensor="IMU of ROS")
    return table


def as_far_as_it_goes(found: Iterator[T], notes: list[str]) -> Iterator[T]:
    """What comes before the place where a file is cut off or damaged; a note says that it is.

    Nothing is salvaged of a file whose first message cannot be had.
    """
    count = 0
    try:
        for one in found:
            yield one
            count += 1
    except (GeneratorExit, MemoryError):
        raise
    except Exception as error:
        if not count:
            raise
        words = " ".join(str(error).split())[:60] or type(error).__name__
        notes[:] = [*notes, f"cut off or damaged after {count} messages ({words}): those are taken"]


def _time_us(message: Any, logged_ns: int) -> float:
    """The stamp of the header; where that is absent or zero, when the message was logged."""
    stamp = _part(_part(message, "header"), "stamp")
    sec = _part(stamp, "sec")
    nano = _part(stamp, "nanosec")
    if nano is None:
        nano = _part(stamp, "nsec")
    if sec is None or nano is None or not (sec or nano):
        return logged_ns * 1e-3
    return float(sec) * 1e6 + float(nano) * 1e-3


def _number(message: Any, field: str) -> float:
    value = message
    for part in field.split("/"):
        value = _part(value, part)
    return float(value) if isinstance(value, (int, float)) else float("nan")


def _part(message: Any, name: str) -> Any:
    """A field of a message, which is an object or, out of JSON, a dict."""
    return message.get(name) if isinstance(message, dict) else getattr(message, name, None)
