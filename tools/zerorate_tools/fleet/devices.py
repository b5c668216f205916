"""Which recordings belong to which device: files here, or at a URL of a store (s3://, gs://)."""

import re
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from glob import glob, has_magic
from os import PathLike
from os.path import realpath
from pathlib import Path, PurePosixPath
from typing import Any
from urllib.parse import unquote

from ..errors import MissingLibrary, ZerorateError, os_error_in_words
from ..installed import beside
from ..recordings.csv_format import SUFFIXES as CSV
from ..recordings.csv_format import scales_path
from ..recordings.parquet_format import SUFFIXES as PARQUET
from ..recordings.reading import recording_name

_PARTITION = "device="
#: One letter is a drive.
_URL = re.compile(r"[a-z][a-z0-9+.-]+://")


@dataclass(frozen=True)
class Device:
    """A device and the files of its power-ons, in their order."""

    name: str
    recordings: tuple[str, ...]

    @property
    def size_bytes(self) -> int:
        """Bytes of its recordings; a file that is gone counts none."""
        return sum(size for size, _ in map(size_and_change, self.recordings))


def devices_of(
    sources: Iterable[str | PathLike[str]],
    device_from: str | None = None,
    without: str | PathLike[str] | None = None,
) -> list[Device]:
    """Group recordings by device, both in the order of their names (2 before 10).

    sources: files, glob patterns, or folders, which are searched, here or at a URL that fsspec
    knows (s3://bucket/folder); device_from: a regular expression whose first group, found in a
    file's path, names its device; without it a folder `device=NAME` on the path does, else each
    file is a device of its own. without: a folder that is left out. Raises ZerorateError.
    """
    pattern = _compiled(device_from)
    found: dict[str, list[str]] = {}
    named = [str(source) for source in sources]
    here = [source for source in named if not is_url(source)]
    urls = [url for source in named if is_url(source) for url in urls_of(source)]
    files = _files(here, Path(realpath(without)) if without else None)
    for name in dict.fromkeys([*files, *urls]):
        found.setdefault(_device(PurePosixPath(name), pattern), []).append(name)
    return [
        Device(name, tuple(sorted(found[name], key=_natural)))
        for name in sorted(found, key=_natural)
    ]


def _compiled(device_from: str | None) -> re.Pattern[str] | None:
    if device_from is None:
        return None
    try:
        pattern = re.compile(device_from)
    except re.error as error:
        raise ZerorateError(f"{device_from}: no regular expression: {error}") from error
    if pattern.groups < 1:
        raise ZerorateError(f"{device_from}: has no group; put the device's name in (brackets)")
    return pattern


def _files(sources: Iterable[str], without: Path | None) -> list[str]:
    """The recordings of this machine, each once, in the order of the sources."""
    found: dict[Path, Path] = {}
    for source in sources:
        there = [path for path in _expanded(source) if without not in path.resolve().parents]
        if not there:
            raise _nothing_at(source)
        for path in there:
            found.setdefault(path.resolve(), path)
    return [str(path) for path in found.values()]


def _nothing_at(source: str) -> ZerorateError:
    do = "name recordings (.parquet, .csv, .csv.gz), a pattern or a folder of them, outside --out"
    return ZerorateError(f"{source}: no recording there; {do}")


def _expanded(source: str) -> Iterator[Path]:
    """A file, what matches a pattern, and what of them are folders searched."""
    places = [Path(source)]
    if has_magic(source) and not places[0].exists():
        places = [Path(place) for place in sorted(glob(source, recursive=True))]
    for place in places:
        if place.is_dir():
            yield from filter(_is_recording, place.rglob("*"))
        elif place.exists():
            yield place


def _is_recording(path: Path) -> bool:
    # what begins with a dot is being written
    named = path.name.endswith((*CSV, *PARQUET)) and not path.name.startswith(".")
    return named and path.is_file()


def _device(path: PurePosixPath, pattern: re.Pattern[str] | None) -> str:
    if pattern is not None:
        match = pattern.search(path.as_posix())
        if match is None or not match.group(1):
            raise ZerorateError(f"{path}: --device-from finds no device in this path; correct it")
        return match.group(1)
    parts = [part for part in path.parts if part.startswith(_PARTITION)]
    return unquote(parts[-1].removeprefix(_PARTITION)) if parts else recording_name(Path(path))


def _natural(text: str) -> list[tuple[bool, int, str]]:
    parts = re.split(r"(\d+)", text)
    return [(not p.isdecimal(), int(p) if p.isdecimal() else 0, p) for p in parts]


def is_url(place: str) -> bool:
    """Whether it names a file of another store than this machine's disk."""
    return _URL.match(place) is not None


def absolute(place: str) -> str:
    """The place, wherever the program that opens it works."""
    return place if is_url(place) else str(Path(place).resolve())


def urls_of(source: str) -> list[str]:
    """The recordings at a URL: a file, a glob pattern, or a folder, which is searched.

    Raises MissingLibrary, ZerorateError.
    """
    store, path = _store(source)
    try:
        found = store.glob(path) if "*" in path else store.find(path)
    except Exception as error:  # each store has errors of its own
        raise ZerorateError(f"{source}: {_in_words(error)}") from error
    found = [one for one in sorted(found) if one.endswith((*CSV, *PARQUET))]
    if not found:
        raise _nothing_at(source)
    return [store.unstrip_protocol(one) for one in found]


def size_and_change(place: str) -> tuple[int, str]:
    """Bytes of a file, and what changes with its content; (0, "") for one that is gone."""
    if not is_url(place):
        file = Path(place)
        if not file.is_file():
            return 0, ""
        there = file.stat()
        return there.st_size, str(there.st_mtime_ns)
    store, path = _store(place)
    try:
        info = store.info(path)
    except FileNotFoundError:
        return 0, ""
    changed = next((info[key] for key in ("ETag", "LastModified", "mtime") if key in info), "")
    return int(info.get("size") or 0), str(changed)


@contextmanager
def here(place: str, scratch: str | PathLike[str]) -> Iterator[str]:
    """The recording as a file of this machine: itself, or a copy for as long as it is used."""
    if not is_url(place):
        yield place
        return
    store, path = _store(place)
    with tempfile.TemporaryDirectory(dir=scratch) as folder:
        copy = Path(folder) / path.rpartition("/")[2]
        store.get_file(path, str(copy))
        beside = scales_path(copy)
        there = f"{path.rpartition('/')[0]}/{beside.name}"
        if copy.name.endswith(CSV) and store.exists(there):
            store.get_file(there, str(beside))
        yield str(copy)


def _store(url: str) -> tuple[Any, str]:
    try:
        from fsspec.core import url_to_fs
    except ImportError as error:
        raise MissingLibrary("fsspec") from error
    try:
        return url_to_fs(url)
    except ImportError as error:
        missing = getattr(error.__cause__, "name", None) or str(error)
        raise ZerorateError(f"{url}: a package is missing: {beside(missing)}") from error
    except ValueError as error:
        raise ZerorateError(f"{url}: {_in_words(error)}") from error


def _in_words(error: Exception) -> str:
    return os_error_in_words(error) if isinstance(error, OSError) else str(error)
