"""Outputs appear whole or not at all."""

from __future__ import annotations

import os
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ..errors import InFile

_ENDING = 40
_LONGEST_NAME = 255


@contextmanager
def written_beside(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Yield a file name beside `path`, renamed onto it when the block ends well, else deleted.

    The name keeps the suffixes, as libraries choose a format by them. Raises InFile if the folder
    does not exist or cannot be written.
    """
    path = Path(path)
    temporary = path.with_name(_beside(path.name))
    try:
        temporary.touch()
    except OSError as error:
        problem = f"cannot be written: {error.strerror}"
        raise InFile(path, problem, do="name a folder that exists and is yours") from error
    if len(os.fsencode(path.name)) > _LONGEST_NAME:
        temporary.unlink(missing_ok=True)
        problem = f"the name is longer than {_LONGEST_NAME} bytes"
        raise InFile(path, problem, do="give it a shorter one")
    try:
        yield temporary
        os.replace(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)


def _beside(name: str) -> str:
    """The name with a mark before it; where that is too long, its checksum and its end."""
    mark = f".{os.getpid()}.partial."
    if len(os.fsencode(mark + name)) > _LONGEST_NAME:
        name = f"{zlib.crc32(os.fsencode(name)):08x}{name[-_ENDING:]}"
    return mark + name
