"""The firmware's own kernels compiled by Numba: the same text, machine code instead of bytecode."""

from __future__ import annotations

import ast
import hashlib
import importlib.util
import sys
import types
from collections.abc import Callable, Sequence
from functools import lru_cache
from pathlib import Path

import numba
from zerorate.corrector import (
    ACCELEROMETER,
    EFFECT_Q8,
    IN_MOTION,
    LEVEL_BIAS,
    MOTION_BIAS,
    OUT_Q8,
    QUALITY_Q8,
    SOURCE,
)

from zerorate_tools.recordings.checks import GAP
from zerorate_tools.runtimes.cache import cache_folder
from zerorate_tools.viper_twins import hot_functions, kernel_files

_PACKAGE = "zerorate_compiled"
# first word of the extra channels in the effects' array
EXTRA = 104


def firmware_package() -> Path:
    """The folder of the installed `zerorate` firmware package."""
    spec = importlib.util.find_spec("zerorate")
    assert spec is not None and spec.origin is not None
    return Path(spec.origin).parent


@lru_cache(maxsize=8)
def compiled_kernels(*roots: str) -> types.SimpleNamespace:
    """The kernels behind `roots` with every function compiled (at its first call), by module.

    They are a private copy: the firmware modules that others import stay plain Python. Machine
    code is cached in a folder named by a hash of all kernel sources, for Numba itself notices
    no change in a file that a function calls into.
    """
    files = _in_order_of_imports(roots, kernel_files(firmware_package()))
    digest = hashlib.sha256(b"".join(path.read_bytes() for path in files)).hexdigest()[:16]
    numba.config.CACHE_DIR = str(cache_folder() / "numba" / digest)
    sys.modules[_PACKAGE] = types.ModuleType(_PACKAGE)
    sys.modules[_PACKAGE].__path__ = []
    modules = {path.stem: _compiled(path) for path in files}
    return types.SimpleNamespace(**modules)


def _compiled(path: Path) -> types.ModuleType:
    module = types.ModuleType(f"{_PACKAGE}.{path.stem}")
    module.__file__ = str(path)
    module.__package__ = _PACKAGE
    sys.modules[module.__name__] = module
    exec(compile(path.read_text(encoding="utf-8"), str(path), "exec"), module.__dict__)
    for name in hot_functions(path):
        setattr(module, name, numba.njit(cache=True)(getattr(module, name)))
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
    froms = [n for n in ast.walk(tree) if isinstance(n, ast.ImportFrom) and n.level == 1]
    return {n.module for n in froms if n.module}


@lru_cache(maxsize=8)
def compiled_run(
    motion: bool = False, level: bool = False, effects: bool = False
) -> Callable[..., None]:
    """run(s, c, others, samples, dt_us, extra, bias_q8, source, quality_q8, verdict), compiled.

    What `Corrector.update` does for each row. others: state and settings of the source in motion,
    of the accelerometer's, and the effects' array, each used where it is on; extra: (n, channels)
    int32, what the application passes in for the model's extra channels.
    """
    roots = ["step", *["in_motion"] * motion, *["realtime"] * level, *["effects"] * effects]
    update = _update(compiled_kernels(*roots), motion, level, effects)

    @numba.njit
    def run(s, c, others, samples, dt_us, extra, bias_q8, source, quality_q8, verdict):
        for i in range(len(samples)):
            for k in range(extra.shape[1]):
                if extra[i, k] != GAP:
                    others[4][EXTRA + k] = extra[i, k]
            verdict[i] = update(s, c, others, samples[i], dt_us[i])
            for axis in range(3):
                bias_q8[i, axis] = s[OUT_Q8 + axis] + s[EFFECT_Q8 + axis]
                quality_q8[i, axis] = s[QUALITY_Q8 + axis]
                source[i, axis] = s[SOURCE + axis]

    return run


def _update(
    kernels: types.SimpleNamespace, motion: bool, level: bool, effects: bool
) -> Callable[..., int]:
    step = kernels.step
    examine, admit, finish, consider = step.examine, step.admit, step.finish, step.consider
    in_motion = kernels.in_motion.update if motion else _never
    by_level = kernels.realtime.update if level else _never
    sense = kernels.effects.sense if effects else _nothing

    @numba.njit
    def update(s, c, others, x, dt_us):
        m, k, r, q, e = others
        kind = examine(s, c, x, dt_us)
        if effects:
            sense(s, e, x, dt_us, 0 if kind else 1)
        admit(s, c, x, kind)
        if kind == 0:
            if motion and in_motion(m, k, x, dt_us):
                consider(s, c, m, MOTION_BIAS, IN_MOTION)
            if level and by_level(r, q, x, dt_us):
                consider(s, c, r, LEVEL_BIAS, ACCELEROMETER)
        return finish(s, c, x, kind)

    return update


@numba.njit
def _never(state, settings, x, dt_us):
    return 0


@numba.njit
def _nothing(s, e, x, dt_us, good):
    return 0
