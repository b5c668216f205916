"""A file of settings, words or code that a user names, which is never large."""

import errno
import os
import stat
from os import PathLike

from .errors import InFile

_MOST_BYTES = 1 << 20


def bytes_of(path: str | PathLike[str], do: str, error: type[InFile] = InFile) -> bytes:
    """What is in it. Raises `error` for what is none: a device has no end, a pipe no writer."""
    try:
        if not stat.S_ISREG(os.stat(path).st_mode):
            raise error(path, "is no file", do=do)
        with open(path, "rb") as file:
            data = file.read(_MOST_BYTES + 1)
    except OSError as failure:
        missing = failure.errno == errno.ENOENT
        problem = "no such file" if missing else f"cannot be read: {failure.strerror}"
        raise error(path, problem, do=do) from failure
    if len(data) > _MOST_BYTES:
        raise error(path, f"more than {_MOST_BYTES >> 20} MiB", do=do)
    return data


def text_of(path: str | PathLike[str], do: str) -> str:
    """The same as text in UTF-8. Raises InFile."""
    try:
        return bytes_of(path, do).decode()
    except UnicodeDecodeError as failure:
        raise InFile(path, f"no text in UTF-8: {failure.reason}", do=do) from failure
