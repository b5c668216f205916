"""Boards, what memory they have, and what the firmware needs of it: docs/boards.md.

python -m zerorate_bench.boards.table [FIGURES] > docs/boards.md, where FIGURES is what
`zerorate bench boards --json FIGURES` wrote: its needs go to boards/needs.json first.
"""

import json
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from zerorate_tools.boards import parts
from zerorate_tools.boards.compiling import board_files, mpy_version
from zerorate_tools.boards.connection import BoardFacts
from zerorate_tools.boards.parts import BOTH, REST, heap_needed, needs

from ..native.native_cost import code_bytes
from ..tables import table

#: Heap that a program needs beside the firmware: its text, a store, a FIFO and its buffers.
_PROGRAM = 16_000
_BOTH = (REST, "motion", "gravity")


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

The row of the RP2040 is measured, on an emulated Pico with stock MicroPython 1.28 (`zerorate bench
boards`). So is every board's flash: what `zerorate flash` sends for learning at rest. Figures with
"some" are estimates:

- Free heap is what makers and users report.
- Heap needed is the Pico's, with RV32's larger code.
- The time of a sample is the Pico's cycle count divided by the board's clock rate. Other Cortex-M
  cores need fewer cycles. RV32 is assumed to be as fast as a Cortex-M0+.

No real board was tested.

Code for RV32 is compiled for speed: a sample takes no more instructions than with C -O2. So an
ESP32-C3 needs {rest_more:,} bytes more of heap and flash than a Pico at rest. With motion and
gravity it needs {both_more:,} bytes more.

Your program needs heap of its own, about 16 KB with a store and a FIFO. `zerorate flash` sends
machine code to every Cortex-M and to RISC-V. On other boards, and after an installation by `mip`,
the same kernels run as bytecode.
"""
_FOOT = """
Cycles a sample on the emulated Pico, with the recording of the bench:

| what | median | worst |
| --- | ---: | ---: |
| the kernels of learning at rest, with their call | {median:,.0f} | {worst:,.0f} |
| `Corrector.update` | {object_median:,.0f} | {object_worst:,.0f} |
| `Bursts.update`, 64 at once: mean | {burst:,.0f} | |
| as bytecode | some {bytecode:,.0f} | |

If the heap is too small, freeze the packages into the firmware image: in MicroPython's `ports/rp2`
run `make FROZEN_MANIFEST=FILE`. FILE, by its full path, has two lines:
`include("$(PORT_DIR)/boards/manifest.py")`, and `include(...)` with the full path of this project's
`manifest.py`. The image takes 129 KB more of flash; all sources together take 9 KB of heap. On the
emulated Pico it gave the same numbers in every mode, to the last bit. `zerorate bench boards`
compares it if it is `firmware/FROZEN-1.28.0.bin` in the folder that ZERORATE_BOARDS names.

## The heap of a program that keeps what it learned

`examples/keep.py` ([pico.md](pico.md#keep-what-was-learned)) runs in {least_heap:,} bytes of heap;
the limit is 49,152 bytes. Saving opens a file, and power-on reads a record in pieces of 64 bytes.
Both take heap for a short time and leave gaps. MicroPython never frees a name. So `zerorate flash`
sends private names as `_a`, `_b`, the same few in every file, and another module's constants as
numbers. The machine code is compiled for size, except for what every sample runs through. The
checkpoint makes a brown-out of the chip harmless. In a frozen image, bytecode and most names take
no heap.
"""


def page() -> str:
    """The text of docs/boards.md."""
    head = ["board", "runs", "heap free", "rest", "motion, gravity", "flash", "a sample", "verdict"]
    more, kept = _more("rv32"), needs()
    opening = _HEAD.format(rest_more=more[REST], both_more=sum(more[part] for part in _BOTH))
    foot = _FOOT.format(**kept["cycles"], least_heap=kept["heap"]["least"])
    return "\n".join([opening, table(head, [*map(_row, BOARDS)]) + foot])


def _more(code: str) -> dict[str, int]:
    """Part -> bytes of this code that the Pico's has not."""
    bytes_of = code_bytes()
    return {part: size - bytes_of["thumb"][part] for part, size in bytes_of[code].items()}


def needs_of(found: Mapping[str, Any]) -> dict[str, dict[str, int]]:
    """What `measure` found, as needs.json has it; what it does not measure stays as it is."""
    heap, before = found["heap_bytes"], needs()
    parts = {part: heap[part] - heap[REST] for part in ("motion", "gravity", "effects")}
    parts[BOTH] = heap["all"] - heap[REST]
    return {
        "native": {REST: heap[REST], **parts},
        "bytecode": before["bytecode"],
        "heap": {"least": found["least_heap_bytes"]},
        "cycles": {**before["cycles"], **{k: round(v) for k, v in found["cycles"].items()}},
    }


def _row(board: Board) -> list[str]:
    more = _more(board.code) if board.code else dict.fromkeys(_BOTH, 0)
    rest, both = (heap_needed(p, board.code) + sum(more[m] for m in p) for p in ([REST], _BOTH))
    some = "" if board.measured else "some "
    cycles = needs()["cycles"]["object_median" if board.code else "bytecode"]
    return [
        board.name,
        f"machine code, {board.mhz} MHz" if board.code else f"bytecode, {board.mhz} MHz",
        f"{some}{board.heap_free:,}",
        f"{some}{rest:,}",
        f"{some}{both:,}",
        f"{_flash_bytes(board.code):,}",
        f"{some}{cycles / board.mhz:,.0f} us",
        verdict(board.heap_free, rest, both),
    ]


@cache
def _flash_bytes(code: str) -> int:
    return sum(map(len, board_files([REST], BoardFacts(mpy=mpy_version()), code).values()))


def verdict(heap_free: int, rest: int, both: int) -> str:
    """What of it the heap has room for, in words."""
    if heap_free >= both + _PROGRAM:
        return "all sources"
    if heap_free >= rest + _PROGRAM:
        return "learning at rest"
    if heap_free >= rest:
        return "learning at rest, in a small program"
    return "frozen alone"


def main(figures: Path | None) -> None:
    """Print the page, after needs.json was written anew from `figures`."""
    if figures is not None:
        found = needs_of(json.loads(figures.read_text(encoding="utf-8")))
        text = json.dumps(found, indent=2) + "\n"
        Path(parts.__file__).with_name("needs.json").write_text(text, encoding="utf-8")
    print(page(), end="")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if sys.argv[1:] else None)
