"""Which reader a file needs, told by its first bytes and then by its name."""

import re
import zipfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path

from ..errors import BadRecording
from ..recordings.text import head
from .tables.archive import archive, folder_of_tables, tables_of_sensors, with_axes
from .tables.checked_lines import checked_lines
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
    b"MATLAB 7.3": "hdf5",
    b"\x89HDF": "hdf5",
    b"\x93NUMPY": "numpy_file",
    b"PAR1": "columnar",
    b"ARROW1": "columnar",
    b"FMT,": "dataflash",
}
_SUFFIXES = {
    **{".ulg": "ulog", ".ulog": "ulog", ".bin": "dataflash", ".bag": "ros_bag", ".db3": "ros_bag"},
    **{".mcap": "mcap_file", ".bbl": "blackbox", ".bfl": "blackbox", ".mat": "matlab"},
    **{".h5": "hdf5", ".hdf5": "hdf5", ".npy": "numpy_file", ".npz": "numpy_file"},
    **{".parquet": "columnar", ".feather": "columnar"},
}
#: Logs of messages, whose readers would look for the next one through any number of zeros.
_OF_MESSAGES = ("ulog", "dataflash", "mcap_file", "ros_bag", "blackbox")
_OF_MATLAB = ("matlab", "hdf5")
_LONGEST_START, _ZEROS = 64, 4096
_DATABASE = b"SQLite format 3"
_ZIP = b"PK\x03\x04"
#: An object, or a list of what a list may hold; what begins as [INFO] or [12:00:01] is a text.
_JSON = re.compile(rb"\s*(\{|\[\s*[\[{\"]|[\[(]\s*[-\d.eE]+\s*,)")
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
    elif path.is_dir():
        with _opened(advance) as opened:
            yield folder_of_tables(path, opened)
    elif _first(path).startswith(_ZIP):
        with archive(path) as unpacked, _opened(advance) as opened:
            if unpacked.is_dir():
                yield folder_of_tables(unpacked, opened, path)
            else:
                with table_of(unpacked, instance, advance) as table:
                    yield table
    else:
        yield checked_lines(path, advance) or delimited(path, advance)


@contextmanager
def table_of_files(files: Sequence[Path], advance: Callable[[float], None]) -> Iterator[Table]:
    """The table of a recording whose sensors have a file each. Raises BadRecording."""
    with _opened(advance) as opened:
        yield tables_of_sensors(files, opened)


@contextmanager
def _opened(advance: Callable[[float], None]) -> Iterator[Callable[[Path], Table]]:
    """What reads a file of several; all of them are closed behind it."""
    from .logs.apart import table_apart

    with ExitStack() as stack:

        def opened(file: Path) -> Table:
            reader = _reader(file)
            if reader in _OF_MATLAB:
                return with_axes(stack.enter_context(table_apart(reader, file, 0, advance)), file)
            return with_axes(delimited(file, advance), file)

        yield opened


def _reader(path: Path) -> str | None:
    if path.is_dir():
        return "ros_bag" if (path / "metadata.yaml").is_file() else None
    first = _first(path)
    if first.startswith(_DATABASE) and path.suffix.lower() != ".db3":
        do = "write its table as CSV"
        raise BadRecording(path, "a database, and no .db3 of ROS 2", do=do)
    if first.startswith(_ZIP):
        return "numpy_file" if _holds_arrays(path) else None
    if by_magic := next((name for magic, name in _MAGIC.items() if first.startswith(magic)), None):
        behind = first[_LONGEST_START:]
        if by_magic in _OF_MESSAGES and behind == bytes(_ZEROS):
            raise BadRecording(path, "nothing but zeros behind its start", do="copy the file again")
        return by_magic
    if _JSON.match(head(path, 1000)[0].removeprefix(b"\xef\xbb\xbf")):
        return "json_file"
    is_text = b"\n" in first and not first.translate(None, _OF_TEXT)
    return None if is_text else _SUFFIXES.get(path.suffix.lower())


def _holds_arrays(path: Path) -> bool:
    try:
        with zipfile.ZipFile(path) as packed:
            names = packed.namelist()
    except Exception as error:  # whatever its parser stumbles over
        raise BadRecording(path, "the zip is cut off or damaged", do="copy it again") from error
    return bool(names) and all(name.endswith(".npy") for name in names)


def _first(path: Path) -> bytes:
    with open(path, "rb") as file:
        return file.read(_LONGEST_START + _ZEROS)
