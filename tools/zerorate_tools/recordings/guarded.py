"""A Parquet file is read to its end in a child with limits before this process opens it.

A damaged one can end its parser by a signal, or take all memory: that ends the child alone. One
child serves its process for good.
"""

import json
import os
import signal
import subprocess
import sys
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from threading import Lock

from ..bounds import ALONE, how_it_ended, limit_myself, python_child
from ..errors import BadRecording
from .parquet_format import batches, open_file

_RUN = "from zerorate_tools.recordings.guarded import main; main()"
_ROWS = 65_536


def read_in_safety(path: Path) -> None:
    """Read it in the child, once while it does not change. Raises BadRecording."""
    about = path.stat()
    _read(path, str(path.absolute()), about.st_ino, about.st_size, about.st_mtime_ns)


@lru_cache(16_384)
def _read(path: Path, absolute: str, inode: int, size: int, change_ns: int) -> None:
    problem, do = _readers.setdefault(os.getpid(), _Reader()).answer(absolute)
    if problem:
        raise BadRecording(path, problem, do=do)


class _Reader:
    """The child, which begins with the first file, and anew after one that it did not survive."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._child: subprocess.Popen[bytes] | None = None

    def answer(self, path: str) -> tuple[str, str]:
        """(what is wrong with a file, or nothing; what to do)."""
        with self._lock:
            # none is left where this is interrupted: its answer would be taken for the next one's
            child, self._child = self._child, None
            if child is None or child.poll() is not None:
                child = _begun()
            try:
                answer = _asked(child, path)
            except BaseException:
                child.kill()
                raise
            if answer:
                self._child = child
                return tuple(json.loads(answer))
            with child:
                return how_it_ended(child.wait())


def _begun() -> subprocess.Popen[bytes]:
    return subprocess.Popen(
        python_child(_RUN),
        bufsize=0,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        env=os.environ | ALONE,
    )


def _asked(child: subprocess.Popen[bytes], path: str) -> bytes:
    assert child.stdin is not None and child.stdout is not None
    with suppress(BrokenPipeError):
        child.stdin.write(json.dumps(path).encode() + b"\n")
    return child.stdout.readline()


_readers: dict[int, _Reader] = {}  # of each process: a fork has its own


def main() -> None:
    """In the child: a line of words for each line of a path, until there are no more."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent ends it
    out = os.dup(1)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    for line in sys.stdin.buffer:
        path, answer = Path(json.loads(line)), ("", "")
        limit_myself(path.stat().st_size)
        try:
            for _ in batches(open_file(path), path, _ROWS):
                pass
        except BadRecording as error:
            answer = (error.problem, error.do)
        os.write(out, json.dumps(answer).encode() + b"\n")
