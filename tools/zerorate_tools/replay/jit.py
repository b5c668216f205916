"""The firmware's own kernels compiled by Numba: the same text, machine code instead of bytecode."""

from __future__ import annotations

import ast
import hashlib
import importlib.util
import sys
import types
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path

import numba
from zerorate.corrector import EFFECT_Q8, OUT_Q8, QUALITY_Q8, SOURCE

from zerorate_tools.runtimes.cache import cache_folder
from zerorate_tools.viper_twins import hot_functions, kernel_files

_PACKAGE = "zerorate_compiled"


def firmware_package() -> Path:
    """The folder of the installed `zerorate` firmware package."""
    spec = importlib.util.find_spec("zerorate")
    assert spec is not None and spec.origin is not None
    return Path(spec.origin).parent


@lru_cache(maxsize=1)
def compiled_kernels() -> types.SimpleNamespace:
    """The kernels behind `step` with every function compiled (at its first call), by module.

    They are a private copy: the firmware modules that others import stay plain Python. Machine
    code is cached in a folder named by a hash of all kernel sources, for Numba itself notices
    no change in a file that a function calls into.
    """
    files = _in_order_of_imports("step", kernel_files(firmware_package()))
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


def _in_order_of_imports(root: str, files: list[Path]) -> list[Path]:
    """The file named `root` and all that it imports, each behind those that it imports."""
    known = {path.stem: path for path in files}
    done: dict[str, Path] = {}

    def visit(name: str) -> None:
        if name in known and name not in done:
            for other in sorted(_imports(known[name])):
                visit(other)
            done[name] = known[name]

    visit(root)
    return list(done.values())


def _imports(path: Path) -> set[str]:
    tree = ast.parse(path.read_text(encoding="utf-8"))
    froms = [n for n in ast.walk(tree) if isinstance(n, ast.ImportFrom) and n.level == 1]
    return {n.module for n in froms if n.module}


@lru_cache(maxsize=1)
def compiled_run() -> Callable[..., None]:
    """run(state, settings, samples, dt_us, bias_q8, source, quality_q8, verdict), compiled."""
    step = compiled_kernels().step.step

    @numba.njit
    def run(state, settings, samples, dt_us, bias_q8, source, quality_q8, verdict):
        for i in range(len(samples)):
            verdict[i] = step(state, settings, samples[i], dt_us[i])
            for axis in range(3):
                bias_q8[i, axis] = state[OUT_Q8 + axis] + state[EFFECT_Q8 + axis]
                quality_q8[i, axis] = state[QUALITY_Q8 + axis]
                source[i, axis] = state[SOURCE + axis]

    return run
