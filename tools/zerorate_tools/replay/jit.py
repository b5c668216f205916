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
from zerorate.corrector import EFFECT_Q8, IN_MOTION, MOTION_BIAS, OUT_Q8, QUALITY_Q8, SOURCE

from zerorate_tools.runtimes.cache import cache_folder
from zerorate_tools.viper_twins import hot_functions, kernel_files

_PACKAGE = "zerorate_compiled"


def firmware_package() -> Path:
    """The folder of the installed `zerorate` firmware package."""
    spec = importlib.util.find_spec("zerorate")
    assert spec is not None and spec.origin is not None
    return Path(spec.origin).parent


@lru_cache(maxsize=2)
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


@lru_cache(maxsize=2)
def compiled_run(motion: bool = False) -> Callable[..., None]:
    """run(s, c, m, k, samples, dt_us, bias_q8, source, quality_q8, verdict), compiled.

    What `Corrector.update` does for each row; with `motion` the source in motion is asked as well,
    whose state and settings are m and k.
    """
    kernels = compiled_kernels("step", "in_motion") if motion else compiled_kernels("step")
    update = _update_in_motion(kernels) if motion else _update(kernels)

    @numba.njit
    def run(s, c, m, k, samples, dt_us, bias_q8, source, quality_q8, verdict):
        for i in range(len(samples)):
            verdict[i] = update(s, c, m, k, samples[i], dt_us[i])
            for axis in range(3):
                bias_q8[i, axis] = s[OUT_Q8 + axis] + s[EFFECT_Q8 + axis]
                quality_q8[i, axis] = s[QUALITY_Q8 + axis]
                source[i, axis] = s[SOURCE + axis]

    return run


def _update(kernels: types.SimpleNamespace) -> Callable[..., int]:
    step = kernels.step.step

    @numba.njit
    def update(s, c, m, k, x, dt_us):
        return step(s, c, x, dt_us)

    return update


def _update_in_motion(kernels: types.SimpleNamespace) -> Callable[..., int]:
    observe, consider, finish = kernels.step.observe, kernels.step.consider, kernels.step.finish
    in_motion = kernels.in_motion.update

    @numba.njit
    def update(s, c, m, k, x, dt_us):
        kind = observe(s, c, x, dt_us)
        if kind == 0 and in_motion(m, k, x, dt_us):
            consider(s, c, m, MOTION_BIAS, IN_MOTION)
        return finish(s, c, x, kind)

    return update
