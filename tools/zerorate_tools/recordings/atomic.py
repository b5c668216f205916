"""Outputs appear whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ..errors import InFile


@contextmanager
def written_beside(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Yield a file name beside `path`, renamed onto it when the block ends well, else deleted.

    The name keeps the suffixes, as libraries choose a format by them. Raises InFile if the folder
    does not exist or cannot be written.
    """
    path = Path(path)
    temporary = path.with_name(f".{os.getpid()}.partial.{path.name}")
    try:
        temporary.touch()
    except OSError as error:
        problem = f"cannot be written: {error.strerror}"
        raise InFile(path, problem, do="name a folder that exists and is yours") from error
    try:
        yield temporary
        os.replace(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)
