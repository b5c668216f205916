"""What a board is: its MicroPython, the code that it loads, and the room that it has."""

import ast
from dataclasses import dataclass

from .connection import told

_QUESTION = """
import gc, os, sys
gc.collect()
i = sys.implementation
s = os.statvfs(".") if hasattr(os, "statvfs") else (0, 0, 0, 0)
print(repr((getattr(i, "_machine", sys.platform), tuple(i.version[:3]), getattr(i, "_mpy", 0),
    gc.mem_free(), s[0] * s[3])))
"""
#: sys.implementation._mpy >> 10, as MicroPython's py/persistentcode.h numbers them.
_ARCHITECTURES = (
    *("", "x86", "x64", "armv6", "armv6m", "armv7m", "armv7em", "armv7emsp", "armv7emdp"),
    *("xtensa", "xtensawin", "rv32imc", "rv64imc"),
)


@dataclass(frozen=True)
class BoardFacts:
    """What was found out.

    mpy: version and sub-version of the .mpy files that it loads, (0, 0) for none; architecture:
    of machine code in them, "" for none; heap_free, disk_free: bytes, disk_free 0 if unknown.
    """

    machine: str = "a board of any kind"
    version: tuple[int, ...] = ()
    mpy: tuple[int, int] = (6, 0)
    architecture: str = ""
    heap_free: int = 0
    disk_free: int = 0

    def __str__(self) -> str:
        if not self.version:
            return self.machine
        version = ".".join(map(str, self.version))
        code = self.architecture or "bytecode alone"
        return f"{self.machine}, MicroPython {version}, .mpy {self.mpy[0]}.{self.mpy[1]}, {code}"


def ask(board) -> BoardFacts:
    """The facts of a board in its raw REPL."""
    machine, version, mpy, heap_free, disk_free = ast.literal_eval(told(board, _QUESTION))
    number = mpy >> 10
    return BoardFacts(
        machine,
        version,
        (mpy & 0xFF, mpy >> 8 & 3),
        _ARCHITECTURES[number] if number < len(_ARCHITECTURES) else "",
        heap_free,
        disk_free,
    )
