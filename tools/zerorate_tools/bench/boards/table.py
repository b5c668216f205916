"""Boards, what memory they have, and what the firmware needs of it: docs/boards.md.

python -m zerorate_tools.bench.boards.table > docs/boards.md
"""

from __future__ import annotations

from dataclasses import dataclass

from ...boards.needs import needs
from ..tables import table

#: Heap that a program needs beside the firmware: its text, a store, a FIFO and its buffers.
_PROGRAM = 16_000
_MHZ_OF_PICO = 125


@dataclass(frozen=True)
class Board:
    """A kind of board: heap free at the prompt, megahertz, and the code that it runs."""

    name: str
    heap_free: int
    mhz: int
    code: str
    measured: bool = False


BOARDS = (
    Board("RP2040 (Pico)", 241_808, 125, "thumb", measured=True),
    Board("RP2350 (Pico 2)", 480_000, 150, "thumb"),
    Board("STM32F405", 100_000, 168, "thumb"),
    Board("SAMD21", 20_000, 48, "thumb"),
    Board("SAMD51", 130_000, 120, "thumb"),
    Board("ESP32", 160_000, 240, ""),
    Board("ESP32-C3", 150_000, 160, "rv32"),
    Board("ESP8266", 36_000, 80, ""),
    Board("micro:bit v2", 60_000, 64, "thumb"),
)
_HEAD = """# Which board, and what fits

The heap that each part keeps was measured on an emulated Pico with stock MicroPython 1.28
(`zerorate bench boards`); other boards' free heap is what their makers and users tell, and their
rows are reckoned from it. A program's own needs, some 16 KB with a store and a FIFO, come on top.
Machine code is loaded on every Cortex-M and on RISC-V; elsewhere the same kernels run as bytecode.
"""
_FOOT = """
On the emulated Pico a sample of the rest path takes 1,675 cycles in the kernels, the worst one
16,687 (ten times the median), over one minute of the bench; in bursts of 64 (`Bursts.update`) some
470, and the call of `Corrector.update` costs some 2,200 more. As bytecode it is 114,000. What fits
no heap can be frozen into a build (`manifest.py`): then it takes flash instead, 36 KB.
"""


def page() -> str:
    """The text of docs/boards.md."""
    head = ["board", "heap free", "runs", "rest", "with motion and gravity", "verdict"]
    return (
        "\n".join([_HEAD, table(head, [_row(board) for board in BOARDS]), _FOOT.lstrip()]).rstrip()
        + "\n"
    )


def _row(board: Board) -> list[str]:
    kept = needs()["native" if board.code else "bytecode"]
    rest = kept["rest"]
    both = rest + kept["motion"] + kept.get("gravity", 0)
    free = f"{board.heap_free:,}" if board.measured else f"some {board.heap_free:,}"
    runs = f"machine code, {board.mhz} MHz" if board.code else f"bytecode, {board.mhz} MHz"
    return [board.name, free, runs, f"{rest:,}", f"{both:,}", verdict(board.heap_free, rest, both)]


def verdict(heap_free: int, rest: int, both: int) -> str:
    """What of it the heap has room for, in words."""
    if heap_free >= both + _PROGRAM:
        return "all sources"
    if heap_free >= rest + _PROGRAM:
        return "learning at rest"
    if heap_free >= rest:
        return "learning at rest, in a small program"
    return "frozen alone"


if __name__ == "__main__":
    print(page(), end="")
