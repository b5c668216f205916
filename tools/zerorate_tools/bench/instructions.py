"""Instructions and time of one sample: bytecode, viper, and C compiled from the same kernels.

Of `Corrector.update`, and of `Bursts.update` with a burst as a FIFO holds it; C is called
without the object. Each figure is a difference of two lengths, less that of the same loop without
the call. C is built for the instruction set that the interpreter itself was built for (i686, ARMv7
Thumb-2).
"""

from __future__ import annotations

import resource
import tempfile
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from ..errors import ZerorateError
from ..replay.jit import firmware_package
from ..runtimes import Runtime, find
from ..runtimes.callgrind import instructions
from .c_program import compiled, program_in_c
from .workload import CYCLE, Workload

HARNESS = Path(__file__).with_name("on_interpreter.py")
HEAP = 8 << 20
# frames of 14 bytes in the 1024 bytes of an MPU-6050's FIFO, of which it loses none at this
BURST = 64
KINDS = ("bytecode", "viper", "c")
_REPEATS = 5
# how often what is timed is done in one run: what is fast would be hidden by its start
_ROUNDS = {"bytecode": 1, "viper": 40, "c": 200}


def instructions_per_sample(work: Workload, at_once: int = BURST) -> dict[str, float]:
    """KINDS -> instructions on x86. Raises MissingRuntime, and ZerorateError if states differ.

    at_once: samples a call, more than one by `Bursts.update`.
    """
    with tempfile.TemporaryDirectory(prefix="zerorate-bench-") as folder:
        runs = _Runs(work, Path(folder), "x86", at_once)
        return {kind: _difference(partial(runs.counted, kind)) for kind in KINDS}


def seconds_per_sample(work: Workload, at_once: int = BURST) -> dict[str, float]:
    """KINDS -> seconds under qemu-arm, the fewest of some runs each. Raises MissingRuntime."""
    with tempfile.TemporaryDirectory(prefix="zerorate-bench-") as folder:
        runs = _Runs(work, Path(folder), "armhf", at_once)
        # qemu translates the code as it meets it, which the first cycle pays for
        return {kind: _difference(partial(runs.timed, kind), first=CYCLE) for kind in KINDS}


def instructions_of_samples(work: Workload, count: int) -> int:
    """Instructions of a run of `count` updates with viper, start-up included."""
    runner, how = find("x86"), _how(work)
    return instructions(runner, HARNESS, [fixed(count), 1, 1, "viper"], **how)


class _Runs:
    """Runs of the three kinds, compared before anything is measured of them."""

    def __init__(self, work: Workload, folder: Path, target: str, at_once: int) -> None:
        self._work, self._at_once = work, at_once
        source = folder / "yardstick.c"
        source.write_text(program_in_c(firmware_package()), encoding="utf-8")
        self._program = compiled(source, folder / "yardstick", target)
        self._runtime = find(target)
        ends = [self._ended(kind, CYCLE, True) for kind in KINDS]
        if not ends[0] or any(end != ends[0] for end in ends):
            problem = f"bytecode, viper and C differ on {target}: no cost is compared"
            raise ZerorateError(problem)

    def counted(self, kind: str, count: int, call: bool) -> float:
        """Instructions of a whole run."""
        runner, args = self._who(kind, count, call)
        return instructions(runner, HARNESS, args, **_how(self._work))

    def timed(self, kind: str, count: int, call: bool) -> float:
        """Seconds of a whole run."""
        times = _ROUNDS[kind]
        spent = []
        for _ in range(_REPEATS):
            start = _child_s()
            runner, args = self._who(kind, count, call)
            runner.run(HARNESS, [*args, times], check=True, **_how(self._work))
            spent.append(_child_s() - start)
        return min(spent) / times

    def _ended(self, kind: str, count: int, call: bool) -> dict:
        runner, args = self._who(kind, count, call)
        outputs = ["state.out", "frames.out"]
        how = {**_how(self._work), "files_out": outputs, "check": True}
        return runner.run(HARNESS, args, **how).files

    def _who(self, kind: str, count: int, call: bool) -> tuple[Runtime, list[object]]:
        args: list[object] = [fixed(count), int(call), self._at_once]
        return (self._program, args) if kind == "c" else (self._runtime, [*args, kind])


def _how(work: Workload) -> dict[str, Any]:
    return {"modules": [firmware_package().parent], "files_in": work.files(), "heap": HEAP}


def fixed(count: int) -> str:
    """The number in a width that is always the same: another would move the heap's collections."""
    return f"{count:06d}"


def _child_s() -> float:
    """Seconds of the processor that ended children took; what others take does not count."""
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime


def _difference(cost: Callable[[int, bool], float], first: int = 0) -> float:
    last = first + CYCLE
    full = cost(last, True) - cost(first, True)
    return (full - (cost(last, False) - cost(first, False))) / CYCLE
