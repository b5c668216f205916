"""Compiles a part for a processor and checks that the code runs at any even address.

The compiler is clang of ziglang, pinned in requirements/, so that the same kernels give the same
bytes everywhere. Code is execute-only: numbers are made by instructions, never read from beside
the code, for MicroPython aligns frozen ARMv6-M code to two bytes and literals want four.
"""

import re
import struct
import subprocess
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from zerorate_tools.errors import ZerorateError
from zerorate_tools.kernels.c_functions import ARITHMETIC, kernels_in_c
from zerorate_tools.kernels.library import zig_cc
from zerorate_tools.kernels.reading import Kernels

from zerorate_bench.native.parts import PARTS

_COMMON = (
    "-ffreestanding -fno-jump-tables -fwrapv -fno-sanitize=undefined -fno-builtin "
    "-ffunction-sections "
    # a loop that subtracts stays one, for there is no division to make of it
    "-mllvm -replexitval=never"
).split()
# Small, and as fast as may be: what branches share is made once, before or behind them; a select is
# a branch on this processor, so that none is made of one; a load is not made twice to save one.
_SMALL = (
    "-mllvm -inline-threshold=15 -mllvm -sink-common-insts=1 -mllvm -enable-gvn-hoist "
    "-mllvm -enable-pre=0 -mllvm -two-entry-phi-node-folding-threshold=0"
).split()
# What every sample runs through: where instructions are saved for the fewest bytes.
_ALWAYS = "static inline __attribute__((always_inline))"
_WHOLE = '_Pragma("clang loop unroll(full)")'
INLINED = ("step_step", "step_admit")
UNROLLED = ("stillness_gather", "step_finish")
# What runs once a segment, where a board has little heap: small before fast.
_SELDOM = re.compile(
    r"^static (?=\w+ (?:bias|estimators|fit|histogram|recent)_\w+\()", re.MULTILINE
)
# ARMv6-M cannot divide: most quotients of the kernels are short, and this is short with them
_SHORT_QUOTIENT = """\
static __attribute__((noinline)) uint32_t quotient(uint32_t a, uint32_t b) {
    uint32_t found = 0, bit = 1;
    while (b <= a >> 4) b <<= 4, bit <<= 4;
    while (b <= a >> 1) b <<= 1, bit <<= 1;
    do {
        if (a >= b) a -= b, found += bit;
        b >>= 1, bit >>= 1;
    } while (bit);
    return found;
}
"""
# a bit in five or six cycles, from the highest that may be set: the carry goes into what is found
_FAST_QUOTIENT = """\
#define BELOW(n) "lsrs r3, r0, #" #n "\\n cmp r3, r1\\n bcs 1f\\n b " #n "f\\n1:\\n"
#define BIT(n) "lsrs r3, r0, #" #n "\\n cmp r3, r1\\n bcc 1f\\n" \
    "lsls r3, r1, #" #n "\\n subs r0, r3\\n1: adcs r2, r2\\n"
#define FOUR(a, b, c, d) BIT(a) BIT(b) BIT(c) BIT(d)
__attribute__((naked, noinline, const)) static uint32_t quotient(uint32_t a, uint32_t b) {
    __asm__("movs r2, #0\\n" BELOW(8) BELOW(12) BELOW(16) FOUR(31, 30, 29, 28)
        FOUR(27, 26, 25, 24) FOUR(23, 22, 21, 20) FOUR(19, 18, 17, 16) "16:" FOUR(15, 14, 13, 12)
        "12:" FOUR(11, 10, 9, 8) "8:" FOUR(7, 6, 5, 4) BIT(3) BIT(2) BIT(1)
        "cmp r0, r1\\n adcs r2, r2\\n movs r0, r2\\n bx lr\\n");
}
"""
_WITHOUT_DIVISION = """\
static __attribute__((noinline)) int32_t floor_div(int32_t a, int32_t b) {
    if (a >= 0 && b > 0) return (int32_t)quotient((uint32_t)a, (uint32_t)b);
    if (b == 0) return 0;
    uint32_t n = a < 0 ? 0u - (uint32_t)a : (uint32_t)a, d = b < 0 ? 0u - (uint32_t)b : (uint32_t)b;
    int32_t q = (int32_t)quotient(n, d);
    if ((a < 0) == (b < 0)) return q;
    return -q - ((uint32_t)q * d != n);
}
static inline int32_t floor_mod(int32_t a, int32_t b) { return a - floor_div(a, b) * b; }
static inline int32_t shift_left(int32_t a, int32_t by) { return (int32_t)((uint32_t)a << by); }
"""
_ENTRY = """
__attribute__((section(".text.entry")))
int32_t entry(int32_t *a, int32_t *b, int32_t *c, int32_t what) {{
{body}}}
"""
_SECTIONS = """\
ENTRY(entry)
SECTIONS {{
    . = {base};
    .text : {{ KEEP(*(.text.entry)) *(.text .text.*) }}
    .other : {{ *(.rodata .rodata.* .data .data.* .bss .bss.* COMMON) }}
    /DISCARD/ : {{ *(.ARM.* .comment .note.* .eh_frame* .riscv.attributes .llvm*) }}
}}
ASSERT(SIZEOF(.other) == 0, "machine code with data")
"""


@dataclass(frozen=True)
class Processor:
    """target, aims (what the code is made for), flags: of the compiler; arithmetic: floor_div,
    floor_mod, shift_left in C.
    """

    target: str
    aims: tuple[str, ...]
    flags: tuple[str, ...]
    arithmetic: str
    decorator: str
    registers: str


PROCESSORS = {
    "thumb": Processor(
        *("thumb-freestanding-eabi", ("-Os", *_SMALL), ("-mcpu=cortex_m0plus", "-mexecute-only")),
        *(_WITHOUT_DIVISION, "asm_thumb", "r0, r1, r2, r3"),
    ),
    # for speed: the boards that have it have heap for half as much again
    "rv32": Processor(
        *("riscv32-freestanding-none", ("-O2",), ("-mcpu=generic_rv32+m+c", "-mrelax")),
        *(ARITHMETIC, "asm_rv32", "a0, a1, a2, a3"),
    ),
}


def machine_code(kernels: Kernels, part: str, processor: str, fast: bool = False) -> bytes:
    """The part's code, entry first. Raises MissingRuntime without ziglang, and ZerorateError.

    fast: by -O2 and no hints, which is the yardstick, not what boards get.
    """
    how, what = PROCESSORS[processor], PARTS[part]
    arithmetic = how.arithmetic
    if arithmetic == _WITHOUT_DIVISION:
        arithmetic = (_FAST_QUOTIENT if what.divides else _SHORT_QUOTIENT) + arithmetic
    text = kernels_in_c(kernels, *what.kernels, arithmetic=arithmetic)
    text = text if fast else _hinted(text, small="-Os" in how.aims)
    text += _ENTRY.format(body=what.body)
    with tempfile.TemporaryDirectory(prefix="zerorate-native-") as folder:
        aims = ("-O2",) if fast else how.aims
        (Path(folder) / "part.c").write_text(text, encoding="utf-8")
        _zig(Path(folder), how, *aims, "-c", "part.c", "-o", "part.o")
        codes = [_linked(Path(folder), how, base) for base in (0, 0x4000)]
    if codes[0] != codes[1]:
        raise ZerorateError(f"the code of {part} for {processor} holds an absolute address")
    if found := [*problems(codes[0], processor)]:
        raise ZerorateError(f"the code of {part} for {processor}: {found[0]}")
    return codes[0]


def _hinted(text: str, small: bool) -> str:
    """The C with what is asked for the kernels that every sample runs through, and the others."""
    for name in INLINED:
        text = text.replace(f"static int32_t {name}(", f"{_ALWAYS} int32_t {name}(")
    for name in UNROLLED:
        body = text.partition(f" {name}(")[2].partition("\n}\n")[0]
        text = text.replace(body, body.replace("    while ", f"    {_WHOLE} while "))
    return _SELDOM.sub("static __attribute__((minsize)) ", text) if small else text


def _linked(folder: Path, how: Processor, base: int) -> bytes:
    (folder / "part.ld").write_text(_SECTIONS.format(base=base), encoding="utf-8")
    _zig(folder, how, "-nostdlib", "-Wl,--gc-sections,-T,part.ld", "part.o", "-o", "part.elf")
    elf = (folder / "part.elf").read_bytes()
    heads, size = struct.unpack_from("<I10xH", elf, 32)
    start, length = struct.unpack_from("<2I", elf, heads + size + 16)  # of its first section
    return elf[start : start + length]


def _zig(folder: Path, how: Processor, *words: str) -> None:
    zig = zig_cc("machine code is made by ziglang: pip install 'zerorate[bench]'")
    command = [*zig, *_COMMON, *how.flags, "-target", how.target, *words]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    if done.returncode:
        raise ZerorateError(f"the kernels do not compile for {how.target}: {done.stderr[:400]}")


def problems(code: bytes, processor: str) -> Iterator[str]:
    """What reads or addresses bytes beside the code, by the instruction's own coding."""
    for at, word in instructions(code, processor):
        if processor == "thumb" and word >> 11 in (9, 20):
            yield f"the instruction at {at} reads beside the code"
        if processor == "rv32" and word & 0x7F == 0x17:
            yield f"the instruction at {at} addresses from where it stands"


def instructions(code: bytes, processor: str) -> Iterator[tuple[int, int]]:
    """Where each instruction lies, and its first half word."""
    at = 0
    while at + 1 < len(code):
        (word,) = struct.unpack_from("<H", code, at)
        yield at, word
        wide = word >> 11 in (0b11101, 0b11110, 0b11111) if processor == "thumb" else word & 3 == 3
        at += 4 if wide else 2
