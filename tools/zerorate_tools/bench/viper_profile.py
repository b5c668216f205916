"""Where the instructions of a viper sample go: its own machine code, or the interpreter's.

Code that MicroPython has made belongs to no file, which is how callgrind tells it apart.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ..replay.jit import firmware_package
from ..runtimes import find
from ..runtimes.callgrind import callgrind_command
from .instructions import BURST, HARNESS, HEAP, fixed
from .workload import CYCLE, Workload

_OUT = "callgrind.out"
_OBJECT = re.compile(r"^ob=\((\d+)\)(?: (.*))?$")
_CALLED_OBJECT = re.compile(r"^cob=\((\d+)\) (.*)$")
_COST = re.compile(r"^[+*\-\d]\S* (\d+)$")
_NO_FILE = "???"


def machine_code_per_sample(work: Workload) -> float:
    """Instructions of a sample inside the code that viper made, x86. Raises MissingRuntime."""
    full, none = (_in_machine_code(work, count) for count in (CYCLE, 0))
    return (full - none) / CYCLE


def _in_machine_code(work: Workload, count: int) -> int:
    *command, _ = callgrind_command()
    result = find("x86").run(
        HARNESS,
        [fixed(count), 1, BURST, "viper"],
        modules=[firmware_package().parent],
        files_in=work.files(),
        files_out=[_OUT],
        heap=HEAP,
        check=True,
        prefix=[*command, f"--callgrind-out-file={_OUT}"],
    )
    return own_costs(result.files[_OUT].decode().splitlines()).get(_NO_FILE, 0)


def own_costs(lines: list[str]) -> dict[str, int]:
    """Object -> instructions of its own in a callgrind profile, those of what it calls left out."""
    costs: dict[str, int] = {}
    for name, cost in _own_lines(lines):
        costs[name] = costs.get(name, 0) + cost
    return costs


def _own_lines(lines: list[str]) -> Iterator[tuple[str, int]]:
    names: dict[str, str] = {}
    here, called = _NO_FILE, False
    for line in lines:
        if found := _OBJECT.match(line):
            number, name = found.groups()
            here = names.setdefault(number, name or _NO_FILE)
        elif found := _CALLED_OBJECT.match(line):
            names.setdefault(*found.groups())
        elif line.startswith("calls="):
            called = True
        elif found := _COST.match(line):
            if not called:
                yield here, int(found.group(1))
            called = False
