"""The kernels hold only what does the same on every interpreter; the checker finds the rest."""

import pytest
from zerorate_tools.kernels.reading import KernelFile, kernel_files

from .kernel_rules import breaches

SOUND = '''
def total(s: ptr32, w: ptr32, n: int) -> int:
    """Return a sum."""
    value = 0
    i = 1
    while i < n:
        i += 2
        if s[i] > 3 and not w[i] or s[i] < -0x3FFFFFFF:
            continue
        value += s[i] // 3 if s[i] > 0 else -(s[i] >> 30)
    for k in range(1, n, 2):
        if s[k] < 0:
            break
        value += k
    while True:
        value -= 1
        if value < 100:
            last = value
            break
    return last + total(s, w, n - 1)


def give_up(s: ptr32, n: int):
    n -= 1  # eleven words: n is from here on the word before
    s[n] ^= 5


def object_of_a_person(s, deep=None):
    return [x for x in s] or (lambda: deep)
'''

BROKEN = [
    ("return s[0:n]", "Slice is not for kernels"),
    ("return [1, 2][n]", "List is not for kernels"),
    ("return n ** 2", "Pow is not for kernels"),
    ("return n / 2", "Div is not for kernels"),
    ("return len(s)", "len is called"),
    ("return s.index(n)", "an expression is called"),
    ("return total(s, n=n)", "other than positional"),
    ("return n * 1.5", "1.5 is no integer"),
    ("return n & 0x40000000", "1073741824 is no integer below"),
    ("return n == None", "None is no integer"),
    ("return n << 31", "a shift by 31"),
    ("n -= 1\n    return n", "the parameter n is assigned"),
    ("n -= 1  # eleven words: the one before\n    return n", "the parameter n is assigned"),
    ("a = n\n    a >>= 32\n    return a", "a shift by 32"),
    ("return n // 0", "division by zero"),
    ("n %= 0\n    return n", "division by zero"),
    ("return s[-1]", "a negative index"),
    ("return n in s", "In is not for kernels"),
    ("raise ValueError", "Raise is not for kernels"),
    ("for x in s:\n        n += x\n    return n", "a for loop counts through a range"),
    ("a = n\n    for i in range(a):\n        a -= 1\n    return a", "counts by changes within it"),
    ("for i in range(3):\n        i += 1\n    return n", "counts by changes within it"),
    ("for i in range(s[0]):\n        s[0] -= 1\n    return n", "a number, a local or a setting"),
    ("for i in range(0, n, n):\n        s[i] = 0\n    return n", "takes heap"),
    ("for i in range(3):\n        s[i] = 0\n    return i", "i is read before it is set"),
    ("a, b = n, n\n    return a", "Tuple is not for kernels"),
    ("s[0] = n", "ends without return on some path"),
    ("if n:\n        return 1", "ends without return on some path"),
    ("while True:\n        if n:\n            break", "ends without return on some path"),
    ("while n:\n        return 1", "ends without return on some path"),
    ("if n:\n        a = 1\n    return a", "a is read before it is set"),
    ("while n:\n        a = 1\n        n -= 1\n    return a", "a is read before it is set"),
    ("a += 1\n    return a", "a is read before it is set"),
    (
        "while True:\n        if n:\n            break\n        a = 1\n    return a",
        "a is read before it is set",
    ),
]

HEADERS = [
    ("def f(s: ptr32, n: int = 3) -> int:", "without defaults"),
    ("def f(s: ptr32, *n: int) -> int:", "without defaults"),
    ("def f(s: ptr16, n: int) -> int:", "s is none of int, ptr32"),
    ("def f(s: ptr32, n: int) -> bool:", "a result is an int"),
    ("def f(s: ptr32, n: int):", "without `-> int`"),
]


@pytest.fixture
def breaches_of(tmp_path):
    def find(text):
        file = tmp_path / "kernel.py"
        file.write_text(text)
        return breaches(file, {"total"})

    return find


def test_a_sound_kernel_has_no_breach(breaches_of):
    assert breaches_of(SOUND) == []


@pytest.mark.parametrize(("body", "what"), BROKEN)
def test_each_breach_is_found(breaches_of, body, what):
    found = breaches_of(f"def f(s: ptr32, n: int) -> int:\n    {body}\n")
    assert any(what in line for line in found)


@pytest.mark.parametrize(("header", "what"), HEADERS)
def test_each_breach_of_a_signature_is_found(breaches_of, header, what):
    found = breaches_of(f"{header}\n    return 1\n")
    assert any(what in line for line in found)


def test_a_breach_is_named_with_its_row(breaches_of):
    found = breaches_of("def f(s: ptr32) -> int:\n    s[0] = 1\n    return s[0] * 0.5\n")
    assert found == ["kernel.py:3: 0.5 is no integer below 2^30"]


def test_the_firmwares_kernels_have_no_breach(repository):
    files = kernel_files(repository / "firmware" / "zerorate")
    kernels = {name for file in files for name in KernelFile(file).kernels}
    assert len(kernels) > 10
    assert [line for file in files for line in breaches(file, kernels)] == []
