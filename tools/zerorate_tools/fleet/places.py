"""Where recordings are: files here, or at a URL of a store that fsspec knows (s3://, gs://)."""

import re
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from os import PathLike
from pathlib import Path
from typing import Any

from ..errors import MissingLibrary, ZerorateError, os_error_in_words
from ..recordings.csv_format import SUFFIXES as CSV
from ..recordings.csv_format import scales_path
from ..recordings.parquet_format import SUFFIXES as PARQUET

#: One letter is a drive.
_URL = re.compile(r"[a-z][a-z0-9+.-]+://")


def is_url(place: str) -> bool:
    """Whether it names a file of another store than this machine's disk."""
    return _URL.match(place) is not None


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
        do = "name recordings (.parquet, .csv, .csv.gz), a pattern or a folder of them"
        raise ZerorateError(f"{source}: no recording there; {do}")
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
        raise ZerorateError(f"{url}: a package is missing: pip install {missing}") from error
    except ValueError as error:
        raise ZerorateError(f"{url}: {_in_words(error)}") from error


def _in_words(error: Exception) -> str:
    return os_error_in_words(error) if isinstance(error, OSError) else str(error)
