"""The kernels as a library of this machine, compiled from their C once and kept in the cache."""

import ctypes
import errno
import hashlib
import importlib.util
import os
import platform
import shutil
import subprocess
import sys
import tempfile
import threading
from collections.abc import Sequence
from functools import lru_cache
from multiprocessing import parent_process
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zerorate_tools.layout import EFFECTS, GRAVITY, MOTION, SOURCE, STATE, STILLNESS

from ..errors import MissingRuntime, ZerorateError
from ..recordings.checks import GAP
from ..runtimes.runtime import cache_folder, fill
from .c_functions import kernels_in_c
from .reading import Kernels

ENTRIES = (
    *(("guard", "check"), ("step", "admit"), ("step", "consider"), ("step", "finish")),
    *(("in_motion", "update"), ("gravity", "update")),
    *(("effects", "sense"), ("effect_refine", "attend")),
)
_WORDS = {
    **{
        name: getattr(STATE, name)
        for name in ("OUT_Q8", "EFFECT_Q8", "QUALITY_Q8", "SOURCE", "STILLNESS")
    },
    "SILENT": STILLNESS.SILENT,
    **{"MOTION_BIAS_Q8": MOTION.MOTION_BIAS_Q8, "GRAVITY_BIAS_Q8": GRAVITY.GRAVITY_BIAS_Q8},
    **{"LATE_US": MOTION.LATE_US, "GRAVITY_LATE_US": GRAVITY.GRAVITY_LATE_US},
    **{"IN_MOTION": SOURCE.IN_MOTION, "GRAVITY": SOURCE.GRAVITY},
    **{name: getattr(EFFECTS, name) for name in ("CHANNELS", "REFINE_ON")},
    "GAP": GAP,
}
# -O1 compiles in a third of the time of -O2, and replays as fast
_FLAGS = ("-O1", "-fwrapv", "-fno-sanitize=undefined", "-shared", "-fPIC", "-fvisibility=hidden")
_FOLDER = Path(__file__).parent
_PREBUILT = _FOLDER / "prebuilt"
_ENDINGS = {"win32": ".dll", "darwin": ".dylib"}
# what a wheel carries: platform and machine as Python names them -> the compiler's target
_TARGETS = {
    ("linux", "x86_64"): "x86_64-linux-gnu.2.17",
    ("linux", "aarch64"): "aarch64-linux-gnu.2.17",
    ("darwin", "x86_64"): "x86_64-macos-none",
    ("darwin", "arm64"): "aarch64-macos-none",
    ("win32", "amd64"): "x86_64-windows-gnu",
    ("win32", "arm64"): "aarch64-windows-gnu",
}

_ONE_AT_A_TIME = threading.Lock()


def text_of(*files: str) -> str:
    """C of all kernels, then of files of this folder, with the layout's words that they name."""
    return f"{kernels_in_c(Kernels(), *ENTRIES)}\n{own_text(*files)}"


def own_text(*files: str) -> str:
    """C of files of this folder, with the layout's words that they name."""
    words = "\n".join(f"#define {name} ({value})" for name, value in _WORDS.items())
    own = [(_FOLDER / name).read_text(encoding="utf-8") for name in files]
    return "\n".join([words, "", *own])


def library() -> ctypes.CDLL:
    """zerorate_run and zerorate_source (rows.c). Raises MissingRuntime without a C compiler.

    A wheel carries it. Else it is compiled and kept in the cache, under a hash of its text; where
    no cache can be written it is compiled for this process alone, and the user is told.
    """
    with _ONE_AT_A_TIME:  # else each thread that finds none compiles its own
        return _library()


@lru_cache(maxsize=1)
def _library() -> ctypes.CDLL:
    text, name = text_of("sample.c", "rows.c"), f"kernels{_ending(sys.platform)}"
    key = _key(text, sys.platform, platform.machine().lower())
    prebuilt = _PREBUILT / f"{key}{_ending(sys.platform)}"
    if prebuilt.is_file():
        return ctypes.CDLL(str(prebuilt))
    command = compiler()
    try:
        kept = cache_folder() / "kernels" / key
        folder = fill(kept, lambda draft: compile_library(command, text, draft / name))
        return ctypes.CDLL(str(folder / name))
    except (OSError, RuntimeError, ZerorateError) as error:  # RuntimeError: there is no HOME
        found = _for_this_process(command, text, name)
        say_once(f"no cache can be kept ({_why(error)}); the kernels are compiled for this run")
        return found


def _for_this_process(command: list[str], text: str, name: str) -> ctypes.CDLL:
    # a library that is loaded may lose its file; Windows keeps it, and the folder with it
    try:
        with tempfile.TemporaryDirectory(prefix="zerorate-", ignore_cleanup_errors=True) as folder:
            compile_library(command, text, Path(folder) / name)
            return ctypes.CDLL(str(Path(folder) / name))
    except OSError as error:
        raise MissingRuntime(f"no place to compile the kernels: {_why(error)}") from error


def _why(error: Exception) -> str:
    return (isinstance(error, OSError) and error.strerror) or str(error)


def say_once(text: str) -> None:
    """A line on standard error, unless a process above this one says it."""
    if parent_process() is None:
        print(f"zerorate: {text}", file=sys.stderr)


def prebuild() -> list[Path]:
    """Write the library for every system that a wheel is for. Raises MissingRuntime."""
    _PREBUILT.mkdir(exist_ok=True)
    for old in _PREBUILT.iterdir():
        old.unlink()
    text = text_of("sample.c", "rows.c")
    for system in _TARGETS:
        with tempfile.TemporaryDirectory(prefix="zerorate-kernels-") as scratch:
            name = f"{_key(text, *system)}{_ending(system[0])}"
            shutil.copy(cross_compiled(text, system, Path(scratch) / name), _PREBUILT)
    return sorted(_PREBUILT.iterdir())


def cross_compiled(text: str, system: tuple[str, str], target: Path) -> Path:
    """C as a library for another system, (platform, machine). Raises MissingRuntime."""
    # Windows has no C library that every machine has: no loop may become its memset
    own = ("-nostdlib", "-fno-builtin") if system[0] == "win32" else ()
    compile_library([*_zig(), "-target", _TARGETS[system], "-s", *own], text, target)
    return target


def _ending(system: str) -> str:
    # Windows opens no library without it
    return _ENDINGS.get(system, ".so")


def _key(text: str, system: str, machine: str) -> str:
    return f"{hashlib.sha256(text.encode()).hexdigest()[:16]}-{system}-{machine}"


def address(words: NDArray[Any] | None) -> ctypes.c_void_p:
    """Where a NumPy array begins, for a call of the library; None is a null pointer."""
    return ctypes.c_void_p(None if words is None else words.ctypes.data)


def run_rows(
    arrays: Sequence[NDArray[Any] | None],
    frames: NDArray[np.int32],
    dt_us: NDArray[np.int32],
    extra: NDArray[np.int32],
    frozen: NDArray[np.int32] | None = None,
    learn: NDArray[np.int8] | None = None,
) -> tuple[NDArray[Any], ...]:
    """(bias_q8, source, quality_q8, each (n, 3), and verdict) of zerorate_run.

    arrays: state, settings and those of the sources and the model, or None; frames are corrected;
    frozen: settings of the rows at which learn, (n,) int8, is 0.
    """
    n = len(frames)
    bias, quality = (np.empty((n, 3), np.int32, order="F") for _ in range(2))
    source, verdict = np.empty((n, 3), np.int8, order="F"), np.empty(n, np.int8)
    given = [np.ascontiguousarray(part, np.int32) for part in (frames, dt_us, extra)]
    count, channels = ctypes.c_int64(n), ctypes.c_int64(extra.shape[1])
    library().zerorate_run(
        *map(address, arrays),
        *(address(given[0]), address(given[1]), count, address(given[2]), channels),
        *map(address, (bias, source, quality, verdict, frozen, learn)),
    )
    if given[0] is not frames:
        frames[:] = given[0]
    return bias, source, quality, verdict


def compile_library(command: list[str], text: str, target: Path, *flags: str) -> None:
    """Compile C to a library at `target` by a `compiler`. Raises ZerorateError."""
    source = target.with_suffix(".c")
    source.write_text(text, encoding="utf-8")
    command = [*command, *_FLAGS, *flags, str(source), "-o", str(target)]
    done = subprocess.run(command, capture_output=True, text=True)
    if os.strerror(errno.ENOSPC) in done.stderr:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(target))
    if done.returncode:
        raise ZerorateError(f"the kernels do not compile here: {done.stderr.strip()[:300]}")


def compiler() -> list[str]:
    """The command of a C compiler. Raises MissingRuntime."""
    found = shutil.which("cc")
    return [found] if found else _zig()


def _zig() -> list[str]:
    return zig_cc("no C compiler here; `pip install ziglang` is one")


def zig_cc(missing: str) -> list[str]:
    """The command of ziglang's C compiler, itself: `-m ziglang` would run a ziglang.py of the
    working folder. Raises MissingRuntime, which says `missing`."""
    found = importlib.util.find_spec("ziglang")
    if found is None or found.origin is None or Path(found.origin).name != "__init__.py":
        raise MissingRuntime(missing)
    return [str(Path(found.origin).with_name("zig")), "cc"]


if __name__ == "__main__":
    print(*prebuild(), sep="\n")
