"""Bounds on what is read: small files, and a child with limits of its own.

What a file says of itself bounds nothing. A child runs no code from the folder one stands in.
"""

import os
import signal
import stat
import sys
from os import PathLike

from .errors import InFile

_MOST_BYTES = 1_048_576
#: What a child that reads a file may take.
MEMORY_MB = 400
#: The environment of a child that reads what may be damaged: nothing of it runs at once.
ALONE = {
    "ARROW_DEFAULT_MEMORY_POOL": "system",
    "MALLOC_ARENA_MAX": "1",
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
}
_CPU_S, _CPU_S_PER_MB = 60, 6
# -I leaves out the working folder and PYTHONPATH; the parent's own paths come as an argument.
_BEGIN = "import os, sys; sys.path[:] = sys.argv.pop().split(os.pathsep); "


def bytes_of(path: str | PathLike[str], do: str, error: type[InFile] = InFile) -> bytes:
    """What is in it. Raises `error` for what is none: a device has no end, a pipe no writer."""
    try:
        if not stat.S_ISREG(os.stat(path).st_mode):
            raise error(path, "is no file", do=do)
        with open(path, "rb") as file:
            data = file.read(_MOST_BYTES + 1)
    except OSError as failure:
        missing = isinstance(failure, FileNotFoundError)
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


def python_child(code: str, *arguments: str) -> list[str]:
    """The command that runs code, which sees the arguments from sys.argv[1] on."""
    paths = os.pathsep.join(filter(None, sys.path))
    return [sys.executable, "-I", "-c", _BEGIN + code, *arguments, paths]


def limit_myself(size: int) -> None:
    """In the child: no more memory or processor, from now on, than a file of so many bytes needs.

    Windows has no such limits.
    """
    try:
        import resource
    except ImportError:
        return
    used = resource.getrusage(resource.RUSAGE_SELF)
    cpu_s = int(used.ru_utime + used.ru_stime + _CPU_S + _CPU_S_PER_MB * size / 1e6)
    for what, most in (
        (resource.RLIMIT_DATA, MEMORY_MB << 20),
        (resource.RLIMIT_CORE, 0),
        (resource.RLIMIT_CPU, cpu_s),
    ):
        hard = resource.getrlimit(what)[1]  # which a user may have set lower
        resource.setrlimit(what, (most if hard < 0 else min(most, hard), hard))


def how_it_ended(code: int) -> tuple[str, str]:
    """Of a child that ended before it had read a file: the problem, and what to do."""
    if code == -getattr(signal, "SIGXCPU", 24):
        return "takes too long to read", "cut it into parts"
    if code > 0:  # no parser's doing
        return f"its reader ended with {code}", "look whether `ulimit -a` allows it too little"
    return f"its reader ended with {code}", "the file is damaged: copy it again"
