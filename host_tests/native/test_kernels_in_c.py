"""Kernels become C statement by statement; what the subset lacks is refused with its row."""

import pytest
from zerorate_tools.kernels.c_functions import kernels_in_c
from zerorate_tools.kernels.reading import Kernels, NotKernel

ONE = '''"""The first file."""
from micropython import const

from .sub.two import lower as down
from .sub.two import plain

_LEAST = const(-3)
_NONE = const(0)
_PLACE = const(0x10)
NAMES = ("a", "b")
ptr32 = None


def not_a_kernel(a, b):
    return NAMES[a] + b


def first(s: ptr32, c: ptr32, a: int, unused: int) -> int:
    """Every form of a statement."""
    total = 0
    for i in range(3):
        total += s[_PLACE + i] // c[_NONE]
    for i in range(1, a):
        total <<= 2
        for k in range(i, a + 4, 2):
            if s[k] == _LEAST:
                continue
            if s[k] > total and not c[k] or total != 1:
                break
            else:
                total -= 1
    while a < total <= 9:
        a = down(s, a) if a & 1 else -a
        plain()
    while a:
        a >>= 1
    s[a] = ~total ^ (a | 2) * (a % 7)
    return total


def apart(s: ptr32):
    if s[0] >= 1:
        return
    s[0] = 2
'''
TWO = '''ptr32 = None


def deepest(a: int) -> int:
    return a


def lower(s: ptr32, a: int) -> int:
    return deepest(a) + plain() + deepest(s[1])


def plain() -> int:
    """A kernel by what it returns."""
    return 1
'''
IN_C = """#include <stdint.h>

/* arithmetic */
static int32_t two_plain() {
    return 1;
}

static int32_t two_deepest(int32_t a) {
    return a;
}

static int32_t two_lower(int32_t *s, int32_t a) {
    return ((two_deepest(a) + two_plain()) + two_deepest(s[1]));
}

static int32_t one_first(int32_t *s, int32_t *c, int32_t a, int32_t unused) {
    (void)unused;
    int32_t i = 0;
    int32_t k = 0;
    int32_t total = 0;
    total = 0;
    for (i = 0; i < 3; i += 1) {
        total = (total + floor_div(s[(16 + i)], c[0]));
    }
    for (i = 1; i < a; i += 1) {
        total = shift_left(total, 2);
        for (k = i; k < (a + 4); k += 2) {
            if (s[k] == (-3)) {
                continue;
            }
            if (((s[k] > total) && (!c[k])) || (total != 1)) {
                break;
            } else {
                total = (total - 1);
            }
        }
    }
    while ((a < total) && (total <= 9)) {
        a = ((a & 1) ? two_lower(s, a) : (-a));
        two_plain();
    }
    while (a) {
        a = (a >> 1);
    }
    s[a] = ((~total) ^ ((a | 2) * floor_mod(a, 7)));
    return total;
}

static void one_apart(int32_t *s) {
    if (s[0] >= 1) {
        return;
    }
    s[0] = 2;
}
"""


def package(folder, **files):
    """Kernels of files by their path, its folders parted by __."""
    for name, text in files.items():
        path = folder / f"{name.replace('__', '/')}.py"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return Kernels(folder)


def test_every_form_of_the_subset_has_its_c_behind_what_it_calls(tmp_path):
    generated = "def kernel(a: int):\n    a = 1.5\n"
    kernels = package(tmp_path, one=ONE, sub__two=TWO, native__one=generated, plain="A = 1\n")
    entries = ("one", "first"), ("one", "apart")
    assert kernels_in_c(kernels, *entries, arithmetic="/* arithmetic */") == IN_C
    assert sorted(kernels.files) == ["one", "two"]


@pytest.mark.parametrize(
    ("statement", "what"),
    {
        "return 1.5": "Constant",
        "return True": "Constant",
        "return a / 2": "BinOp",
        "return +a": "UnaryOp",
        "return a is s": "Compare",
        "a **= 2": "AugAssign",
        "a = s = 1": "Assign",
        "s.a = 1": "Attribute",
        "s.f()": "Call",
        "g(a=1)": "Call",
        "pass": "Pass",
        "while a: a = 0\n    else: a = 1": "While",
        "for i in range(3): a = 0\n    else: a = 1": "For",
        "for i in s: a = 0": "For",
        "for i in list(a): a = 0": "For",
        "for i in s.f(a): a = 0": "For",
        "for s[0] in range(a): a = 0": "For",
        "for i in range(): a = 0": "For",
        "for i in range(1, 2, 3, 4): a = 0": "For",
    }.items(),
)
def test_what_the_subset_does_not_have_is_refused_with_its_row(tmp_path, statement, what):
    kernels = package(tmp_path, a=f"ptr32 = 0\ndef f(s: ptr32, a: int):\n    {statement}\n")
    with pytest.raises(NotKernel, match=f"a.py: row 3: {what} is not in the kernel subset"):
        kernels_in_c(kernels, ("a", "f"))


def test_what_is_no_kernel_is_not_called_and_none_that_is_missing_is_begun_with(tmp_path):
    kernels = package(tmp_path, a="def f(a: int):\n    g(a)\ndef g(a):\n    pass\n")
    with pytest.raises(NotKernel, match="a.py: calls g, which is no kernel"):
        kernels_in_c(kernels, ("a", "f"))
    for file, name in (("a", "g"), ("b", "f")):
        with pytest.raises(NotKernel, match=f"has no kernel {name} in a file {file}.py"):
            kernels_in_c(kernels, (file, name))
