"""Interpreters that are programs of this machine: CPython, and MicroPython's unix port."""

import os
import sys
from pathlib import Path

from zerorate_tools.runtimes.runtime import Job, Runtime


class CPython(Runtime):
    """The Python that runs these tools."""

    name = "cpython"

    def command(self, job: Job) -> list[str]:
        return [sys.executable, "-B", job.script, *job.args]

    def environment(self, job: Job) -> dict[str, str]:
        return {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, job.modules))}


class UnixPort(Runtime):
    """MicroPython's unix port, started by `launcher` (a loader, an emulator, or nothing)."""

    def __init__(self, name: str, executable: Path, launcher: tuple[str, ...] = ()) -> None:
        self.name = name
        self.executable = executable
        self.launcher = launcher

    def command(self, job: Job) -> list[str]:
        heap = [] if job.heap_bytes is None else ["-X", f"heapsize={job.heap_bytes}"]
        return [*self.launcher, str(self.executable), *heap, job.script, *job.args]

    def environment(self, job: Job) -> dict[str, str]:
        return {**os.environ, "MICROPYPATH": ":".join([".frozen", *map(str, job.modules)])}
