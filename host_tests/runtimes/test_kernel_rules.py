"""Kernels and board files hold only what every interpreter has, and does the same."""

import ast
import re
import subprocess
from pathlib import Path

import pytest
from zerorate_tools.errors import ZerorateError
from zerorate_tools.kernels.reading import KernelFile, kernel_files
from zerorate_tools.runtimes.runtime import UnixPort

from .kernel_rules import breaches, left_open

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
    while 1:
        value -= 1
        if value < 100:
            last = value
            break
    give_up(w, n)
    return last


def give_up(s: ptr32, n: int):
    n -= 1  # eleven words: n is from here on the word before
    s[n] ^= 5
'''

BROKEN = [
    ("return n & 0x40000000", "1073741824 is no integer below"),
    ("return n << 31", "a shift by 31"),
    ("n -= 1\n    return n", "the parameter n is assigned"),
    ("return n // 0", "division by zero"),
    ("return s[-1]", "a negative index"),
    ("a = n\n    for i in range(a):\n        a -= 1\n    return a", "counts by changes within it"),
    ("for i in range(s[0]):\n        s[0] -= 1\n    return n", "a number, a local or a setting"),
    ("for i in range(0, n, n):\n        s[i] = 0\n    return n", "takes heap"),
    ("for i in range(3):\n        s[i] = 0\n    return i", "is another in C behind it"),
    ("while n:\n        return 1", "does not return a value"),
    (
        "while 1:\n        if n:\n            break\n        a = 1\n    return a",
        "uninitialized",
    ),
    ("return 1", "without defaults", "def f(s: ptr32, n: int = 3) -> int:"),
    ("return 1", "s is none of int, ptr32", "def f(s: ptr16, n: int) -> int:"),
    ("return 1", "a result is an int", "def f(s: ptr32, n: int) -> bool:"),
    ("return 1", "without `-> int`", "def f(s: ptr32, n: int):"),
]


@pytest.fixture
def breaches_of(tmp_path):
    def find(text):
        file = tmp_path / "kernel.py"
        file.write_text(text)
        return breaches(file) + left_open(tmp_path)

    return find


def test_a_sound_kernel_has_no_breach(breaches_of):
    assert breaches_of(SOUND) == []


@pytest.mark.parametrize("broken", BROKEN, ids=str)
def test_each_breach_is_found(breaches_of, broken):
    body, what, header = (*broken, "def f(s: ptr32, n: int) -> int:")[:3]
    assert any(what in line for line in breaches_of(f"{header}\n    {body}\n"))


def test_a_breach_is_named_with_its_row(breaches_of):
    found = breaches_of("def f(s: ptr32) -> int:\n    s[0] = 1\n    return s[0] >> 31\n")
    assert found == ["kernel.py:3: a shift by 31; at most 30"]


def test_the_firmwares_kernels_have_no_breach(repository):
    files = kernel_files(repository / "firmware" / "zerorate")
    assert len(files) > 10
    assert [line for file in files for line in breaches(file)] == []
    assert left_open(repository / "firmware" / "zerorate") == []


#: Words that a frame may have before it goes to the heap.
WORDS_ON_STACK = 11

_WORDS_PER_HANDLER = 3
_BLOCK = re.compile(r"code block '(.+?)'.*?\(N_STATE (\d+)\)\n\(N_EXC_STACK (\d+)\)", re.DOTALL)


def frame_words(runtime: UnixPort, source: Path) -> dict[str, int]:
    """Words of each function's bytecode frame, by the function's plain name.

    Of functions with the same name (methods of two classes) the largest frame counts.
    Raises ZerorateError when the file does not compile.
    """
    compile_only = ["-X", "compile-only", "-v", "-v", "-v", str(source)]
    command = [*runtime.launcher, str(runtime.executable), *compile_only]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        said = done.stderr.strip().splitlines() or ["no message"]
        raise ZerorateError(f"{source} does not compile on {runtime.name}: {said[-1]}")
    words: dict[str, int] = {}
    for name, state, handlers in _BLOCK.findall(done.stdout):
        size = int(state) + _WORDS_PER_HANDLER * int(handlers)
        words[name] = max(size, words.get(name, 0))
    return words


# What a program runs at every sample, outside the kernels.
HOT_METHODS = {
    "firmware/zerorate/corrector.py": "update",
    "firmware/zerorate/others.py": "update _sense_effects _ask_others _consider",
    "firmware/zerorate/bursts.py": "update _one_by_one _update_at",
    "firmware/zerorate/model.py": "channel",
    "drivers/zerorate_i2c/mpu6050.py": "read read_sample verify doubt check _is_configured "
    "_is_kept",
    "drivers/zerorate_i2c/data_registers.py": "read read_sample _is_suspect "
    "_is_one_word_repeated _has_leapt _read_again",
    "drivers/zerorate_i2c/registers.py": "decode read_register read_into _transfer",
    "drivers/zerorate_i2c/fifo.py": "read _load _count _count_bytes _take _transfer _align "
    "_deliver _is_doubtful",
    "drivers/zerorate_i2c/data_ready.py": "_on_edge take",
}
# Run as machine code only: bursts.py takes its samples one by one elsewhere.
NEVER_BYTECODE = {"block.py"}


@pytest.fixture(scope="module")
def x86(find_runtime):
    return find_runtime("x86")


def test_every_hot_function_of_every_kernel_keeps_its_frame_on_the_stack(x86, repository):
    files = kernel_files(repository / "firmware" / "zerorate")
    files = [file for file in files if file.name not in NEVER_BYTECODE]
    frames = {}
    for file in files:
        words = frame_words(x86, file)
        frames |= {f"{file.name} {name}": words[name] for name in KernelFile(file).kernels}
    assert len(frames) > len(files) > 0
    assert {name: words for name, words in frames.items() if words > WORDS_ON_STACK} == {}


@pytest.mark.parametrize("name", HOT_METHODS)
def test_every_method_of_an_update_keeps_its_frame_on_the_stack(x86, repository, name):
    words = frame_words(x86, repository / name)
    assert {m: words[m] for m in HOT_METHODS[name].split() if words[m] > WORDS_ON_STACK} == {}


ABSENT_MODULES = {"typing", "dataclasses", "enum", "abc", "functools", "contextlib", "__future__"}
ABSENT_NAMES = {"bit_length", "cast", "__set_name__", "__init_subclass__"}


def lacking(tree):
    """Row and what for everything in a file that a board does not have."""
    plain = plain_names(tree)
    for node in walked(tree):
        found = [*imports(node), *attributes(node, plain), *syntax(node)]
        yield from ((getattr(node, "lineno", 0), what) for what in found)


def walked(tree):
    """Every node but those under `if TYPE_CHECKING:`, which no board runs."""
    left = [tree]
    while left:
        node = left.pop()
        yield node
        never = isinstance(node, ast.If) and getattr(node.test, "id", "") == "TYPE_CHECKING"
        left += node.orelse if never else ast.iter_child_nodes(node)


def imports(node):
    if isinstance(node, ast.ImportFrom):
        modules = [node.module or ""]
        folded = [alias.name for alias in node.names if is_folded(alias.name)]
        yield from (f"{name} is folded away where it is defined" for name in folded)
    else:
        modules = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
    yield from (f"{name} is absent" for name in modules if name.split(".")[0] in ABSENT_MODULES)


def attributes(node, plain):
    name = node.attr if isinstance(node, ast.Attribute) else getattr(node, "name", "")
    if name in ABSENT_NAMES:
        yield f"{name} is absent"
    if isinstance(node, ast.Attribute) and is_folded(node.attr) and node.attr not in plain:
        yield f"{node.attr} as an attribute: const(_X) leaves none on a board"
    if isinstance(node, ast.Call) and getattr(node.func, "attr", "") == "from_bytes":
        if any(keyword.arg == "signed" for keyword in node.keywords):
            yield "from_bytes has no signed"


def plain_names(tree):
    """Names that are given a value other than const(...), which stay on a board."""
    assignments = [node for node in ast.walk(tree) if isinstance(node, ast.Assign)]
    plain = [a for a in assignments if getattr(getattr(a.value, "func", None), "id", "") != "const"]
    return {target.id for a in plain for target in a.targets if isinstance(target, ast.Name)}


def syntax(node):
    if isinstance(node, ast.Match):
        yield "match is a SyntaxError"
    if isinstance(node, ast.arguments) and node.posonlyargs:
        yield "positional-only parameters are a SyntaxError"


def is_folded(name):
    return name.startswith("_") and not name.startswith("__") and name == name.upper() != "_"


def board_files(repository):
    firmware = (repository / "firmware").rglob("*.py")
    drivers = (repository / "drivers").rglob("*.py")
    # linux.py runs on a Linux board, under CPython.
    return sorted({*firmware, *drivers} - set(repository.glob("drivers/*/linux.py")))


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("import typing", "typing is absent"),
        ("from dataclasses import field", "dataclasses is absent"),
        ("from .parts import _WHO_AM_I", "folded away"),
        ("_ID = const(1)\nclass A:\n    def f(self):\n        return self._ID", "leaves none"),
        ("class A:\n    _ID = const(1)\n    def f(self):\n        return self._ID", "leaves none"),
        ("x = (5).bit_length()", "bit_length is absent"),
        ("class A:\n    def __set_name__(self, a, b):\n        pass", "__set_name__ is absent"),
        ("int.from_bytes(b'1', 'big', signed=True)", "no signed"),
        ("match x:\n    case 1:\n        pass", "match"),
        ("def f(a, /):\n    pass", "positional-only"),
    ],
)
def test_what_a_board_lacks_is_found(text, what):
    assert any(what in found for _, found in lacking(ast.parse(text)))


def test_firmware_and_drivers_have_no_breach(repository):
    files = board_files(repository)
    assert {"zerorate", "zerorate_i2c"} <= {file.parent.name for file in files}
    found = [
        f"{file.relative_to(repository)}:{row}: {what}"
        for file in files
        for row, what in lacking(ast.parse(file.read_text(encoding="utf-8"), str(file)))
    ]
    assert found == []
