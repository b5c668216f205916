"""An integer that minds 31 bits, and the kernels as C that does, a thousand times as fast.

A small integer of a 32-bit MicroPython has 31 bits; what leaves them is an object on the heap, and
in C a wrapped number. Plain kernels compute with whatever they are given, so an I31 in every
word of their arrays checks every intermediate result.

In C every operation is computed in 64 bits. The first whose result no small integer holds, that
shifts or divides as a kernel may not, that reaches before an array, or that comes when a call
should long have returned, ends the call; its line is kept.
"""

import ctypes
import tempfile
from pathlib import Path

import numpy as np
from zerorate_tools.kernels.c_functions import Expressions, kernels_in_c
from zerorate_tools.kernels.library import ENTRIES, address, compile_library, compiler, own_text
from zerorate_tools.kernels.reading import Kernels

LEAST, MOST = -(1 << 30), (1 << 30) - 1


class OutOf31Bits(AssertionError):
    """An intermediate result that no small integer holds."""


class I31(int):
    """An int whose operators give I31 or raise OutOf31Bits."""

    __slots__ = ()


def checked(value, what=""):
    """The value as I31. Raises OutOf31Bits."""
    if not LEAST <= value <= MOST:
        raise OutOf31Bits(f"{what} = {value}")
    return int.__new__(I31, value)


def _checking(name):
    plain, make = getattr(int, name), int.__new__

    def operator(a, b):
        result = plain(a, b)
        if LEAST <= result <= MOST:
            return make(I31, result)
        raise OutOf31Bits(f"{int(a)} {name} {int(b)} = {result}")

    return operator


def _shifting(name):
    checking, by_the_first = _checking(name), name in ("__rlshift__", "__rrshift__")

    def operator(a, b):
        if 0 <= (a if by_the_first else b) <= 30:
            return checking(a, b)
        raise OutOf31Bits(f"{int(a)} {name} {int(b)}")

    return operator


def _dividing(name):
    checking = _checking(name)

    def operator(a, b):
        try:
            return checking(a, b)
        except ZeroDivisionError as error:
            raise OutOf31Bits(f"{int(a)} {name} {int(b)}") from error

    return operator


for _kind, _names in {
    _checking: ("add", "sub", "mul", "and", "or", "xor"),
    _shifting: ("lshift", "rshift"),
    _dividing: ("floordiv", "mod"),
}.items():
    for _name in _names:
        setattr(I31, f"__{_name}__", _kind(f"__{_name}__"))
        setattr(I31, f"__r{_name}__", _kind(f"__r{_name}__"))
I31.__neg__ = lambda a: checked(-int(a), f"-{int(a)}")
I31.__invert__ = lambda a: checked(~int(a))


class Words(list):
    """A list of I31 that takes only what fits; counts nothing, forgives nothing."""

    def __init__(self, values):
        super().__init__(checked(v, "settings or state") for v in values)

    def __setitem__(self, index, value):
        if index < 0:
            raise OutOf31Bits(f"word {int(index)} of the state")
        super().__setitem__(index, checked(value, f"word {int(index)}"))


_OPERATIONS = """\
#include <setjmp.h>
#include <stdint.h>
__attribute__((visibility("default"))) jmp_buf escape;
__attribute__((visibility("default"))) int32_t left_at = 0;
__attribute__((visibility("default"))) int64_t left_by = 0, operations = 0;
static int32_t leave(int64_t value, int32_t at) {
    left_at = at;
    left_by = value;
    longjmp(escape, 1);
}
static inline int32_t fits(int64_t v, int32_t at) {
    return v < -(1 << 30) || v >= 1 << 30 || --operations < 0 ? leave(v, at) : (int32_t)v;
}
#define PLAIN(name, op) static inline int32_t name(int64_t a, int64_t b, int32_t at) { \\
    return fits(a op b, at); }
PLAIN(op_add, +) PLAIN(op_sub, -) PLAIN(op_mul, *) PLAIN(op_and, &) PLAIN(op_or, |) PLAIN(op_xor, ^)
static inline int32_t op_right(int64_t a, int64_t b, int32_t at) {
    return b < 0 || b > 30 ? leave(b, at) : fits(a >> b, at);
}
static inline int32_t op_left(int64_t a, int64_t b, int32_t at) {
    return b < 0 || b > 30 ? leave(b, at) : fits(a * ((int64_t)1 << b), at);
}
static inline int32_t op_div(int64_t a, int64_t b, int32_t at) {
    return b ? fits(a / b - (a % b != 0 && (a < 0) != (b < 0)), at) : leave(0, at);
}
static inline int32_t op_mod(int64_t a, int64_t b, int32_t at) {
    if (!b) return leave(0, at);
    int64_t rest = a % b;
    return fits(rest != 0 && (rest < 0) != (b < 0) ? rest + b : rest, at);
}
static inline int32_t word(int32_t index, int32_t at) {
    return index < 0 ? leave(index, at) : index;
}
"""
_NAMES = {"Add": "add", "Sub": "sub", "Mult": "mul", "BitAnd": "and", "BitOr": "or"}
_NAMES |= {"BitXor": "xor", "RShift": "right", "LShift": "left", "FloorDiv": "div", "Mod": "mod"}
_RUN = """
SHOWN void checked_run(int32_t **a, int32_t *frames, int32_t *dt_us, int64_t n, int32_t *extra,
                       int32_t *bias_q8, int8_t *source, int32_t *quality_q8, int8_t *verdict) {
    if (!setjmp(escape))
        zerorate_run(a[0], a[1], a[2], a[3], a[4], a[5], a[6], frames, dt_us, n, extra, 0, bias_q8,
                     source, quality_q8, verdict, 0, 0);
}
"""
_MOST_OPERATIONS = 40000  # of a sample, on the average; 800 are usual, most 21,000
_PLACES: list[str] = []


class CheckedExpressions(Expressions):
    """Expressions whose operations mind 31 bits."""

    def _at(self, node):
        _PLACES.append(f"{self._path.name}:{node.lineno}")
        return len(_PLACES)

    def binary(self, operator, left, right, node):
        name = _NAMES.get(type(operator).__name__)
        if name is None:
            raise self.refused(node)
        return f"op_{name}({left}, {right}, {self._at(node)})"

    def _unaryop(self, node):
        plain = super()._unaryop(node)
        return plain if plain.startswith("(!") else f"fits({plain}, {self._at(node)})"

    def _subscript(self, node):
        return f"{self.text(node.value)}[word({self.text(node.slice)}, {self._at(node)})]"


class CheckedLibrary:
    """The firmware's kernels, compiled so; ENTRIES of library.py.

    flags: -O0 compiles in a sixth of the time of -O1, which runs four times as fast.
    """

    def __init__(self, flags=("-O0",)) -> None:
        first = len(_PLACES)
        text = kernels_in_c(
            Kernels(), *ENTRIES, arithmetic=_OPERATIONS, expressions=CheckedExpressions
        )
        self._places = [""] * first + _PLACES[first:]
        with tempfile.TemporaryDirectory(prefix="zerorate-checked-") as folder:
            target = Path(folder) / "checked.so"
            text = f"{text}\n{own_text('sample.c', 'rows.c')}{_RUN}"
            compile_library(compiler(), text, target, *flags)
            self.functions = ctypes.CDLL(str(target))
        self._at = ctypes.c_int32.in_dll(self.functions, "left_at")
        self._by = ctypes.c_int64.in_dll(self.functions, "left_by")
        self._operations = ctypes.c_int64.in_dll(self.functions, "operations")

    def left(self) -> str:
        """Where 31 bits were left since the last question, and with what; "" if nowhere."""
        at, by = self._at.value, self._by.value
        self._at.value = 0
        if not at:
            return ""
        return f"{self._places[at - 1]}: {'no end' if self._operations.value < 0 else by}"

    def run(self, arrays, frames, dt_us) -> str:
        """Drive arrays (of `Corrector`, None where off) with rows; what left 31 bits, or ""."""
        n = len(frames)
        bias, quality = np.empty((3, n), np.int32), np.empty((3, n), np.int32)
        source, verdict = np.empty((3, n), np.int8), np.empty(n, np.int8)
        frames, dt_us = (np.array(part, np.int32, order="C") for part in (frames, dt_us))
        self._operations.value = _MOST_OPERATIONS * n
        self.functions.checked_run(
            (ctypes.c_void_p * len(arrays))(*map(address, arrays)),
            *(address(frames), address(dt_us), ctypes.c_int64(n), address(np.zeros(1, np.int32))),
            *map(address, (bias, source, quality, verdict)),
        )
        return self.left()
