"""The firmware's own kernels compiled by Numba: the same text, machine code instead of bytecode."""

from __future__ import annotations

import ast
import hashlib
import re
import sys
import types
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

import numba
from zerorate.layout import EFFECTS, GRAVITY, MOTION, SOURCE, STATE

from zerorate_tools.kernels.reading import firmware_package, hot_functions, kernel_files
from zerorate_tools.recordings.checks import GAP
from zerorate_tools.runtimes.cache import cache_folder, fill

_PACKAGE = "zerorate_compiled"
_FROM_FOLDER = re.compile(rb"^from \.+(?:\w+\.)*(\w+) import", re.MULTILINE)
_LOOP = Path(__file__).with_name("sample_loop.py")
_STEPS = ("examine", "admit", "finish", "consider")
_WORDS = {
    "GAP": GAP,
    **{name: getattr(STATE, name) for name in ("OUT_Q8", "EFFECT_Q8", "QUALITY_Q8", "SOURCE")},
    "MOTION_BIAS_Q8": MOTION.MOTION_BIAS_Q8,
    "GRAVITY_BIAS_Q8": GRAVITY.GRAVITY_BIAS_Q8,
    **{"IN_MOTION": SOURCE.IN_MOTION, "ACCELEROMETER": SOURCE.ACCELEROMETER},
    "CHANNELS": EFFECTS.CHANNELS,
}


@lru_cache(maxsize=8)
def compiled_kernels(*roots: str) -> types.SimpleNamespace:
    """The kernels behind `roots` with every function compiled (at its first call), by module.

    They are a private copy: the firmware modules that others import stay plain Python. Machine
    code is cached in a folder named by a hash of all kernel sources, for Numba itself notices
    no change in a file that a function calls into; beside a copy of them, for it keeps code by a
    source's place and time, and another installation has the same kernels elsewhere.
    """
    files = _in_order_of_imports(roots, kernel_files(firmware_package()))
    texts = {path.name: _in_one_folder(path) for path in (*files, _LOOP)}
    digest = hashlib.sha256(b"".join([*texts.values(), repr(_WORDS).encode()])).hexdigest()[:16]
    kept = cache_folder() / "numba" / digest
    numba.config.CACHE_DIR = str(kept)  # type: ignore[attr-defined]
    copies = fill(kept / "sources", lambda draft: _write(texts, draft))
    sys.modules[_PACKAGE] = types.ModuleType(_PACKAGE)
    sys.modules[_PACKAGE].__path__ = []
    modules = {path.stem: _compiled(copies / path.name) for path in files}
    return types.SimpleNamespace(**modules, loop=copies / _LOOP.name)


def _in_one_folder(path: Path) -> bytes:
    """A file as it stands in the copy, where all kernels lie in one folder."""
    return _FROM_FOLDER.sub(rb"from .\1 import", path.read_bytes())


def _write(texts: Mapping[str, bytes], folder: Path) -> None:
    for name, text in texts.items():
        (folder / name).write_bytes(text)


def _compiled(path: Path) -> types.ModuleType:
    module = _loaded(path, path.stem, {})
    for name in hot_functions(path):
        setattr(module, name, numba.njit(cache=True)(getattr(module, name)))
    return module


def _loaded(path: Path, name: str, given: Mapping[str, object]) -> types.ModuleType:
    module = types.ModuleType(f"{_PACKAGE}.{name}")
    module.__file__ = str(path)
    module.__package__ = _PACKAGE
    module.__dict__.update(given)
    sys.modules[module.__name__] = module
    exec(compile(path.read_text(encoding="utf-8"), str(path), "exec"), module.__dict__)
    return module


def _in_order_of_imports(roots: Sequence[str], files: list[Path]) -> list[Path]:
    """The files named `roots` and all that they import, each behind those that it imports."""
    known = {path.stem: path for path in files}
    done: dict[str, Path] = {}

    def visit(name: str) -> None:
        if name in known and name not in done:
            for other in sorted(_imports(known[name])):
                visit(other)
            done[name] = known[name]

    for root in roots:
        visit(root)
    return list(done.values())


def _imports(path: Path) -> set[str]:
    tree = ast.parse(path.read_text(encoding="utf-8"))
    froms = [n for n in ast.walk(tree) if isinstance(n, ast.ImportFrom) and n.level]
    return {n.module.rpartition(".")[2] for n in froms if n.module}


@lru_cache(maxsize=8)
def compiled_run(
    motion: bool = False, level: bool = False, effects: bool = False, refining: bool = False
) -> Callable[..., None]:
    """run(s, c, others, samples, dt_us, extra, bias_q8, source, quality_q8, verdict), compiled.

    What `Corrector.update` does for each row. others: state and settings of the source in motion,
    of the accelerometer's, and the effects' array, each used where it is on; extra: (n, channels)
    int32, what the application passes in for the model's extra channels.
    """
    on = {"in_motion": motion, "realtime": level, "effects": effects, "effect_refine": refining}
    kernels = compiled_kernels("step", *(root for root in on if on[root]))
    given = {
        **_WORDS,
        **{name: getattr(kernels.step, name) for name in _STEPS},
        **{"MOTION": motion, "LEVEL": level, "EFFECTS": effects, "REFINING": refining},
        "in_motion": kernels.in_motion.update if motion else _never,
        "by_level": kernels.realtime.update if level else _never,
        "sense": kernels.effects.sense if effects else _nothing,
        "attend": kernels.effect_refine.attend if refining else _no_coefficient,
    }
    # a name of its own: kept machine code of another loop of the same name would be taken for it
    name = "_".join([kernels.loop.stem, *(root for root in on if on[root])])
    loop: Any = _loaded(kernels.loop, name, given)
    loop.update = numba.njit(cache=True)(loop.update)
    return numba.njit(cache=True, nogil=True)(loop.run)


@numba.njit
def _never(state, settings, x, dt_us):
    return 0


@numba.njit
def _nothing(s, e, x, dt_us, good):
    return 0


@numba.njit
def _no_coefficient(s, c, e):
    return
