"""Kernels and board files hold only what every interpreter has, and does the same.

A kernel runs as CPython, as bytecode and as C. What is outside the subset is refused by the writer
of C (zerorate_tools.kernels.c_functions).

Source: each rule was tried on MicroPython 1.25 and 1.27. A path without return gives garbage in C,
a shift by 32 differs between processors, and bytecode takes heap for what leaves 31 bits.
"""

import ast
import re
import subprocess
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest
from zerorate_tools.errors import ZerorateError
from zerorate_tools.kernels.c_functions import kernels_in_c
from zerorate_tools.kernels.library import zig_cc
from zerorate_tools.kernels.reading import KernelFile, Kernels, kernel_files
from zerorate_tools.runtimes.runtime import UnixPort

_KINDS = ("int", "ptr32")
_LIMIT = 1 << 30
_LONGEST_SHIFT = 30


def breaches(path: Path) -> list[str]:
    """Every breach in the annotated functions of a file, as `file:row: what`."""
    lines = path.read_text(encoding="utf-8").splitlines()
    return [
        f"{path.name}:{row}: {what}"
        for function in KernelFile(path).kernels.values()
        for row, what in sorted({*_signature(function), *_body(function), *_anew(function, lines)})
    ]


def left_open(package: Path) -> list[str]:
    """What clang says of the kernels: locals that some way leaves unset, ways without return."""
    kernels = Kernels(package)
    every = [(file.name, name) for file in kernels.files.values() for name in file.kernels]
    text = re.sub(r"^(    int32_t \w+) = 0;", r"\1;", kernels_in_c(kernels, *every), flags=re.M)
    asked = ["-Wno-everything", "-Wconditional-uninitialized", "-Wuninitialized", "-Wreturn-type"]
    with tempfile.TemporaryDirectory() as folder:
        out = ["-x", "c", "-c", "-", "-o", f"{folder}/kernels.o"]
        command = [*zig_cc("pip install ziglang"), *asked, *out]
        said = subprocess.run(command, input=text, capture_output=True, text=True).stderr
    return re.findall(r"(?:warning|error): (.+)", said)


def remarks(function: ast.FunctionDef, lines: Sequence[str]) -> str:
    """What the function's remarks of "eleven words" say: what a parameter is from there on."""
    text = "\n".join(lines[function.lineno - 1 : function.end_lineno])
    return " ".join(re.findall(r"# eleven words: (.+)", text))


def _anew(function: ast.FunctionDef, lines: Sequence[str]) -> Iterator[tuple[int, str]]:
    parameters = {a.arg for a in function.args.args}
    said = set(re.findall(r"\w+", remarks(function, lines)))
    for node in ast.walk(function):
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            if node.id in parameters - said:
                yield node.lineno, f"the parameter {node.id} is assigned: a local has a name"


def _signature(function: ast.FunctionDef) -> Iterator[tuple[int, str]]:
    of = function.args
    if of.defaults or of.kwonlyargs or of.vararg or of.kwarg or of.posonlyargs:
        yield function.lineno, "parameters are positional, without defaults"
    for parameter in of.args:
        if parameter.annotation and _name(parameter.annotation) not in _KINDS:
            yield parameter.lineno, f"{parameter.arg} is none of {', '.join(_KINDS)}"
    if function.returns and _name(function.returns) != "int":
        yield function.lineno, "a result is an int"


def _body(function: ast.FunctionDef) -> Iterator[tuple[int, str]]:
    has_docstring = ast.get_docstring(function) is not None
    statements = function.body[1:] if has_docstring else function.body
    yield from _after_its_loop(statements)
    for node in (n for statement in statements for n in ast.walk(statement)):
        row = getattr(node, "lineno", function.lineno)
        if isinstance(node, ast.For):
            yield from ((row, what) for what in _counted(node))
        elif isinstance(node, ast.Return) and node.value is not None and not function.returns:
            yield row, f"{function.name} returns a value without `-> int`"
        else:
            yield from ((row, what) for what in _node(node))


def _counted(loop: ast.For) -> Iterator[str]:
    """C counts by a test before each round, Python by numbers known before the first."""
    assert isinstance(loop.iter, ast.Call)
    if not isinstance(loop.iter.args[-1], ast.Constant) and len(loop.iter.args) == 3:
        yield "a range whose step is no number takes heap"
    names = [n for s in loop.body for n in ast.walk(s) if isinstance(n, ast.Name)]
    stored = {n.id for n in names if isinstance(n.ctx, ast.Store)}
    numbers = [n for part in loop.iter.args for n in ast.walk(part)]
    if stored & {n.id for n in (loop.target, *numbers) if isinstance(n, ast.Name)}:
        yield "what a for loop counts by changes within it"
    if any(isinstance(n, ast.Subscript) and _name(n.value) != "c" for n in numbers):
        yield "the end of a for loop is a number, a local or a setting"


def _after_its_loop(statements: Sequence[ast.stmt]) -> Iterator[tuple[int, str]]:
    nodes = [node for statement in statements for node in ast.walk(statement)]
    set_last = {id(t): n for n in nodes if isinstance(n, ast.Assign) for t in n.targets}
    names = [n for n in nodes if isinstance(n, ast.Name)]
    # what an assignment sets is behind what it reads
    names.sort(key=lambda n: (set_last.get(id(n), n).end_lineno, id(n) in set_last))
    read = {id(n.target) for n in nodes if isinstance(n, ast.AugAssign)}
    for loop in (n for n in nodes if isinstance(n, ast.For)):
        counter, end = _name(loop.target), loop.end_lineno or 0
        following = next((n for n in names if n.id == counter and n.lineno > end), None)
        if following and (isinstance(following.ctx, ast.Load) or id(following) in read):
            yield following.lineno, f"{counter}, which a loop counted, is another in C behind it"


def _node(node: ast.AST) -> Iterator[str]:
    if isinstance(node, ast.Constant) and node.value >= _LIMIT:
        yield f"{node.value!r} is no integer below 2^30"
    elif isinstance(node, (ast.BinOp, ast.AugAssign)):
        right = node.right if isinstance(node, ast.BinOp) else node.value
        yield from _operation(node.op, right)
    elif isinstance(node, ast.Subscript) and isinstance(node.slice, ast.UnaryOp):
        yield "a negative index reads before the array in C"


def _operation(operator: ast.operator, right: ast.expr) -> Iterator[str]:
    if not isinstance(right, ast.Constant) or not isinstance(right.value, int):
        return
    if isinstance(operator, (ast.LShift, ast.RShift)) and right.value > _LONGEST_SHIFT:
        yield f"a shift by {right.value}; at most {_LONGEST_SHIFT}"
    if isinstance(operator, (ast.FloorDiv, ast.Mod)) and right.value == 0:
        yield "division by zero ends the program in C"


def _name(node: ast.expr | None) -> str:
    return node.id if isinstance(node, ast.Name) else ""


def test_a_breach_is_named_with_its_row_and_a_way_without_return(tmp_path):
    file = tmp_path / "kernel.py"
    file.write_text("def f(s: ptr32) -> int:\n    while s[0]:\n        return s[0] >> 31\n")
    assert breaches(file) == ["kernel.py:3: a shift by 31; at most 30"]
    assert any("does not return a value" in line for line in left_open(tmp_path))


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


def test_firmware_and_drivers_have_no_breach(repository):
    files = board_files(repository)
    assert {"zerorate", "zerorate_i2c"} <= {file.parent.name for file in files}
    found = [
        f"{file.relative_to(repository)}:{row}: {what}"
        for file in files
        for row, what in lacking(ast.parse(file.read_text(encoding="utf-8"), str(file)))
    ]
    assert found == []
