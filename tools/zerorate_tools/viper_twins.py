"""Writes firmware/zerorate/viper/X.py from every kernel file firmware/zerorate/X.py.

The decorator is handled by MicroPython's compiler, so it cannot be chosen at run time in one file:
the plain file is what people edit, its twin has `@micropython.viper` before every annotated def.
`make viper` runs this; host_tests/runtimes/test_viper_twins.py fails while a twin is stale.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Collection, Sequence
from pathlib import Path

from zerorate_tools.errors import InFile
from zerorate_tools.viper_calls import POINTERS, let_it_call

_NOTE = "# Generated from zerorate/{name} by `make viper`: edit that file, not this one.\n"


class BadKernel(InFile):
    """A kernel file from which no twin can be made."""


def kernel_files(package: Path) -> list[Path]:
    """The files of `package` with annotated functions, which only kernels have; sorted by name."""
    files = sorted(package.glob("*.py"))
    return [path for path in files if _annotated(_parsed(path))]


def hot_functions(path: Path) -> list[str]:
    """The names of a kernel file's annotated functions: those that run in every update."""
    return [node.name for node in _annotated(_parsed(path))]


def twin(path: Path, kernels: Sequence[str], results: Collection[str] = ()) -> str:
    """The text of a kernel file's twin.

    kernels: names of all kernel modules, which it may import; results: names of all kernels that
    return something.

    Raises BadKernel for a function that is decorated already, or an import that mixes kernels and
    other modules.
    """
    tree = _parsed(path)
    lines = path.read_text(encoding="utf-8").splitlines(keepends=True)
    for node in tree.body:
        if isinstance(node, ast.ImportFrom) and node.level == 1:
            lines[node.lineno - 1] = _one_package_up(path, node, lines[node.lineno - 1], kernels)
        elif _stands_in_for_a_pointer(node):
            _blank(lines, node)
    for node in _annotated(tree):
        if node.decorator_list:
            raise BadKernel(path, f"{node.name} has a decorator", row=node.lineno)
        let_it_call(lines, node, results)
        lines[node.lineno - 1] = "@micropython.viper\n" + lines[node.lineno - 1]
    first = _end_of_docstring(tree)
    text = "".join([*lines[:first], "\nimport micropython\n\n", *lines[first:]])
    return _NOTE.format(name=path.name) + _at_most_two_blank_lines(text)


def twins(package: Path) -> dict[Path, str]:
    """Path and text of every twin of `package`, its __init__.py included."""
    files = kernel_files(package)
    names = [path.stem for path in files]
    functions = [f for path in files for f in _annotated(_parsed(path))]
    results = {f.name for f in functions if f.returns}
    made = {package / "viper" / path.name: twin(path, names, results) for path in files}
    return {package / "viper" / "__init__.py": "", **made}


def stale(package: Path) -> list[Path]:
    """Twins that are missing, differ from their kernel file, or have lost it."""
    wanted = twins(package)
    there = set((package / "viper").glob("*.py"))
    changed = {p for p in there & set(wanted) if p.read_text(encoding="utf-8") != wanted[p]}
    return sorted(changed | (there ^ set(wanted)))


def write(package: Path) -> list[Path]:
    """Write the twins and remove those without a kernel file; return what changed."""
    wanted, changed = twins(package), stale(package)
    (package / "viper").mkdir(exist_ok=True)
    for path in changed:
        if path in wanted:
            path.write_text(wanted[path], encoding="utf-8")
        else:
            path.unlink()
    return changed


def _parsed(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"), str(path))


def _annotated(tree: ast.Module) -> list[ast.FunctionDef]:
    functions = [node for node in tree.body if isinstance(node, ast.FunctionDef)]
    return [f for f in functions if f.returns or any(a.annotation for a in f.args.args)]


def _stands_in_for_a_pointer(node: ast.stmt) -> bool:
    """Is this what gives ptr8 or ptr32 a meaning on CPython? Viper has its own."""
    if isinstance(node, ast.Assign):
        return all(isinstance(t, ast.Name) and t.id in POINTERS for t in node.targets)
    return isinstance(node, ast.FunctionDef) and node.name in POINTERS


def _blank(lines: list[str], node: ast.stmt) -> None:
    for number in range(node.lineno - 1, node.end_lineno or node.lineno):
        lines[number] = ""


def _one_package_up(path: Path, node: ast.ImportFrom, line: str, kernels: Sequence[str]) -> str:
    sources = [node.module] if node.module else [alias.name for alias in node.names]
    outside = [name for name in sources if name not in kernels]
    if not outside:
        return line
    if len(outside) < len(sources):
        raise BadKernel(path, "imports kernels and other modules in one line", row=node.lineno)
    return line.replace("from .", "from ..", 1)


def _end_of_docstring(tree: ast.Module) -> int:
    if ast.get_docstring(tree) is None:
        return 0
    return tree.body[0].end_lineno or 0


def _at_most_two_blank_lines(text: str) -> str:
    while "\n\n\n\n" in text:
        text = text.replace("\n\n\n\n", "\n\n\n")
    return text


def main(arguments: Sequence[str]) -> int:
    package = Path(arguments[0] if arguments else "firmware/zerorate")
    for path in write(package):
        print(path)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
