"""Which reader a file needs, told by its first bytes and then by its name."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from ..errors import BadRecording
from .tables.checked_lines import checked_lines, has_checked_lines
from .tables.columnar import columnar
from .tables.delimited import delimited
from .tables.table import Table

#: First bytes -> the reader in `logs`.
_MAGIC = {
    b"ULog\x01\x12\x35": "ulog",
    b"\xa3\x95": "dataflash",
    b"#ROSBAG V": "ros_bag",
    b"SQLite format 3": "ros_bag",
    b"\x89MCAP0\r\n": "mcap_file",
    b"H Product:Blackbox": "blackbox",
    b"MATLAB 5.0": "matlab",
    b"\x89HDF": "matlab",
    b"FMT,": "dataflash",
}
_SUFFIXES = {
    **{".ulg": "ulog", ".ulog": "ulog", ".bin": "dataflash", ".bag": "ros_bag", ".db3": "ros_bag"},
    **{".mcap": "mcap_file", ".bbl": "blackbox", ".bfl": "blackbox", ".mat": "matlab"},
}

#: First bytes of what people have tables in and nothing here reads -> what it is, what to do.
_OTHERS = {
    b"PK\x03\x04": ("a spreadsheet or an archive", "save its table as CSV, or unpack it"),
    b"\x93NUMPY": ("an array of NumPy", "write it with numpy.savetxt(..., delimiter=',')"),
    b"SQLite format 3": ("a database, and no .db3 of ROS 2", "write its table as CSV"),
}
_OF_TEXT = bytes([9, 10, 13, *range(32, 127)])


@contextmanager
def table_of(path: Path, instance: int, advance: Callable[[float], None]) -> Iterator[Table]:
    """The table that a file is. Raises BadRecording, MissingLibrary.

    instance: which of several sensors in a log; advance: takes bytes as they are read.
    """
    reader = _reader(path)
    if reader is not None:
        from .logs.apart import table_apart

        with table_apart(reader, path, instance, advance) as table:
            yield table
    elif path.name.lower().endswith(".parquet") or _starts(path, b"PAR1"):
        yield columnar(path, advance)
    elif has_checked_lines(path):
        yield checked_lines(path, advance)
    else:
        yield delimited(path, advance)


def _reader(path: Path) -> str | None:
    if path.is_dir():
        if not (path / "metadata.yaml").is_file():
            do = "name a file, or the folder of a ROS 2 bag"
            raise BadRecording(path, "a folder without metadata.yaml", do=do)
        return "ros_bag"
    other = next((words for magic, words in _OTHERS.items() if _starts(path, magic)), None)
    if other and path.suffix.lower() != ".db3":
        raise BadRecording(path, other[0], do=other[1])
    by_magic = next((name for magic, name in _MAGIC.items() if _starts(path, magic)), None)
    return by_magic or (None if _is_text(path) else _SUFFIXES.get(path.suffix.lower()))


def _is_text(path: Path) -> bool:
    """Whether a file is text, whatever its name ends with."""
    with open(path, "rb") as file:
        first = file.read(4096)
    return b"\n" in first and not first.translate(None, _OF_TEXT)


def _starts(path: Path, magic: bytes) -> bool:
    with open(path, "rb") as file:
        return file.read(len(magic)) == magic
