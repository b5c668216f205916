"""Instructions and time of one sample: bytecode, viper, and C compiled from the same kernels.

Each figure is a difference of two lengths, less that of the same loop without the call. C is built
for the instruction set that the interpreter itself was built for (i686, ARMv7 Thumb-2).
"""

from __future__ import annotations

import tempfile
import time
from pathlib import Path

from ..errors import ZerorateError
from ..replay.jit import firmware_package
from ..runtimes import Runtime, find
from ..runtimes.callgrind import instructions
from .c_program import CProgram, compiled, program_in_c
from .workload import CYCLE, Workload

HARNESS = Path(__file__).with_name("on_interpreter.py")
HEAP = 4 << 20
KINDS = ("bytecode", "viper", "c")
_REPEATS = 5


def instructions_per_sample(work: Workload) -> dict[str, float]:
    """KINDS -> instructions on x86. Raises MissingRuntime, and ZerorateError if states differ."""
    with tempfile.TemporaryDirectory(prefix="zerorate-bench-") as folder:
        program = _yardstick(Path(folder), "x86")
        same_states(work, find("x86"), program)
        return {
            kind: _difference(lambda n, call, kind=kind: _counted(work, program, kind, n, call))
            for kind in KINDS
        }


def seconds_per_sample(work: Workload) -> dict[str, float]:
    """KINDS -> seconds under qemu-arm, the fewest of some runs each. Raises MissingRuntime."""
    with tempfile.TemporaryDirectory(prefix="zerorate-bench-") as folder:
        program = _yardstick(Path(folder), "armhf")
        same_states(work, find("armhf"), program)
        return {
            kind: _difference(lambda n, call, kind=kind: _timed(work, program, kind, n, call))
            for kind in KINDS
        }


def same_states(work: Workload, runtime: Runtime, program: Runtime) -> None:
    """Raise ZerorateError unless bytecode, viper and C end in the same state and frames."""
    ends = [_run(work, *_who(runtime, program, kind), CYCLE, True) for kind in KINDS]
    if not ends[0] or any(end != ends[0] for end in ends):
        raise ZerorateError(f"bytecode, viper and C differ on {runtime.name}: no cost is compared")


def _yardstick(folder: Path, target: str) -> CProgram:
    source = folder / "yardstick.c"
    source.write_text(program_in_c(firmware_package()), encoding="utf-8")
    return compiled(source, folder / "yardstick", target)


def _who(runtime: Runtime, program: Runtime, kind: str) -> tuple[Runtime, list[str]]:
    return (program, []) if kind == "c" else (runtime, [kind])


def _run(work: Workload, runner: Runtime, more: list[str], count: int, call: bool) -> dict:
    outputs = ["state.out", "frames.out"]
    result = runner.run(HARNESS, [count, int(call), *more], files_out=outputs, **_how(work))
    return result.files


def _how(work: Workload) -> dict:
    return {
        "modules": [firmware_package().parent],
        "files_in": work.files(),
        "heap": HEAP,
        "check": True,
    }


def _counted(work: Workload, program: CProgram, kind: str, count: int, call: bool) -> float:
    runner, more = _who(find("x86"), program, kind)
    how = {key: value for key, value in _how(work).items() if key != "check"}
    return instructions(runner, HARNESS, [count, int(call), *more], **how)


def _timed(work: Workload, program: CProgram, kind: str, count: int, call: bool) -> float:
    runner, more = _who(find("armhf"), program, kind)
    # C is so fast that starting it would hide it
    times = 200 if kind == "c" else 1
    spent = []
    for _ in range(_REPEATS):
        start = time.perf_counter()
        _run(work, runner, [*more, str(times)] if kind == "c" else more, count, call)
        spent.append(time.perf_counter() - start)
    return min(spent) / times


def _difference(cost) -> float:
    full = cost(CYCLE, True) - cost(0, True)
    return (full - (cost(CYCLE, False) - cost(0, False))) / CYCLE
