"""Interpreters that are programs of this machine: CPython, and MicroPython's unix port."""

from __future__ import annotations

import os
import sys
from functools import cached_property
from pathlib import Path

from zerorate_tools.runtimes.runtime import Job, Runtime

# 64-bit words: viper compiles there, but its ptr32 loads are zero-extended.
_VIPER_PROBE = """
import sys
if sys.maxsize >> 31:
    raise SystemExit(1)
@micropython.viper
def add_one(value: int) -> int:
    return value + 1
raise SystemExit(0 if add_one(1) == 2 else 1)
"""


class CPython(Runtime):
    """The Python that runs these tools."""

    name = "cpython"
    viper = False

    def command(self, job: Job) -> list[str]:
        return [sys.executable, "-B", job.script, *job.args]

    def environment(self, job: Job) -> dict[str, str]:
        return {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, job.modules))}


class UnixPort(Runtime):
    """MicroPython's unix port, started by `launcher` (a loader, an emulator, or nothing).

    viper: whether it can be used; None finds out by trying.
    """

    def __init__(
        self,
        name: str,
        executable: Path,
        launcher: tuple[str, ...] = (),
        viper: bool | None = None,
    ) -> None:
        self.name = name
        self.executable = executable
        self.launcher = launcher
        self._viper = viper

    @cached_property
    def viper(self) -> bool:  # type: ignore[override]
        if self._viper is not None:
            return self._viper
        return self.run(_VIPER_PROBE).returncode == 0

    def command(self, job: Job) -> list[str]:
        heap = [] if job.heap_bytes is None else ["-X", f"heapsize={job.heap_bytes}"]
        return [*self.launcher, str(self.executable), *heap, job.script, *job.args]

    def environment(self, job: Job) -> dict[str, str]:
        return {**os.environ, "MICROPYPATH": ":".join([".frozen", *map(str, job.modules)])}
