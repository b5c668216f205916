"""What a kernel may hold to do the same on CPython, as bytecode and as C, whose writer takes it.

What is outside the subset is refused by that writer (zerorate_tools.kernels.c_functions).

Source: each rule was tried on MicroPython 1.25 and 1.27. A path without return gives garbage in C,
a shift by 32 differs between processors, and bytecode takes heap for what leaves 31 bits.
"""

import ast
import re
import subprocess
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

from zerorate_tools.kernels.c_functions import kernels_in_c
from zerorate_tools.kernels.library import zig_cc
from zerorate_tools.kernels.reading import KernelFile, Kernels

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
