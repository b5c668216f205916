"""Writes firmware/zerorate/viper/X.py from every kernel file firmware/zerorate/X.py.

The decorator is handled by MicroPython's compiler, so it cannot be chosen at run time in one file:
the plain file is what people edit, its twin has `@micropython.viper` before every annotated def,
and says in fewer machine instructions what the plain one says for people (see twins/).
`make viper` runs this; host_tests/runtimes/test_viper_twins.py fails while a twin is stale.
"""

from __future__ import annotations

import ast
import sys
from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from pathlib import Path

from zerorate_tools.errors import InFile
from zerorate_tools.kernel_rules import is_kernel
from zerorate_tools.twins.calling import able_to_call
from zerorate_tools.twins.folding import folded
from zerorate_tools.twins.inlining import POINTERS, Inliner, Kernels, calls
from zerorate_tools.twins.pointers import with_pointers
from zerorate_tools.twins.sources import all_kernels, kernel_file
from zerorate_tools.twins.wording import in_cheap_words

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


class Twins:
    """The twins of a package's kernel files. Raises BadKernel for one that cannot have any."""

    def __init__(self, paths: Sequence[Path]) -> None:
        for path in paths:
            _check(path, [p.stem for p in paths])
        self._kernels = all_kernels([kernel_file(path) for path in paths])
        self._results = {name for name, f in self._kernels.items() if f.returns}
        self._inliner = Inliner(self._kernels)
        self._flat = {name: self._flattened(name) for name in self._kernels}
        roots = _roots(self._kernels, set(_asked_for(paths)))
        self._needed = _reached(self._flat, roots)

    def text(self, path: Path) -> str:
        """The text of a kernel file's twin; empty if it is written out wherever it is needed."""
        tree = _parsed(path)
        names = [f"{path.stem}.{f.name}" for f in _annotated(tree)]
        made = {name: self._flat[name] for name in names if name in self._needed}
        if not made:
            return ""
        others = sorted(
            {_callee(c) for f in made.values() for c in calls(f, self._kernels)} - {*names}
        )
        local = _local_names(names, others)
        imports = [_import_line(name, local[name]) for name in others]
        plain = [ast.unparse(node) for node in self._plain_code(tree)]
        written = [self._written(function, local) for function in made.values()]
        head = [_NOTE.format(name=path.name) + _docstring(tree), "import micropython"]
        parts = ["\n\n".join([*head, *(["\n".join(imports)] if imports else []), *plain]), *written]
        return "\n\n\n".join(parts) + "\n"

    def _flattened(self, name: str) -> ast.FunctionDef:
        function = with_pointers(folded(self._inliner.flat(name)))
        return in_cheap_words(function)

    def _plain_code(self, tree: ast.Module) -> list[ast.stmt]:
        """What is neither kernel nor made for kernels: code of the board beside them."""
        body = tree.body[1:] if ast.get_docstring(tree) else tree.body
        kept = [node for node in body if not _is_for_kernels(node)]
        modules = {name.partition(".")[0] for name in self._kernels}
        for node in kept:
            if isinstance(node, ast.ImportFrom) and node.level == 1:
                node.level = 1 if node.module in modules else 2
        return kept if any(isinstance(n, (ast.FunctionDef, ast.ClassDef)) for n in kept) else []

    def _written(self, function: ast.FunctionDef, local: Mapping[str, str]) -> str:
        able_to_call(function, local, self._results)
        function.decorator_list = [ast.parse("micropython.viper", mode="eval").body]
        return ast.unparse(ast.fix_missing_locations(function))


def twins(package: Path) -> dict[Path, str]:
    """Path and text of every twin of `package`, its __init__.py included."""
    files = kernel_files(package)
    made = Twins(files)
    texts = {package / "viper" / path.name: made.text(path) for path in files}
    return {package / "viper" / "__init__.py": "", **{p: t for p, t in texts.items() if t}}


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
    return [n for n in tree.body if isinstance(n, ast.FunctionDef) and is_kernel(n)]


def _check(path: Path, kernels: Sequence[str]) -> None:
    tree = _parsed(path)
    for function in _annotated(tree):
        if function.decorator_list:
            raise BadKernel(path, f"{function.name} has a decorator", row=function.lineno)
    for node in tree.body:
        if isinstance(node, ast.ImportFrom) and node.level == 1:
            sources = [node.module] if node.module else [alias.name for alias in node.names]
            if len({name in kernels for name in sources}) > 1:
                problem = "imports kernels and other modules in one line"
                raise BadKernel(path, problem, row=node.lineno)


def _asked_for(paths: Sequence[Path]) -> Iterator[str]:
    """The names that code beside the kernels may mean kernels by."""
    for path in sorted({file for one in paths for file in one.parent.glob("*.py")}):
        tree = _parsed(path)
        nodes = _annotated(tree) if path in paths else []
        own = {id(n) for function in nodes for n in ast.walk(function)}
        for node in ast.walk(tree):
            if isinstance(node, ast.Attribute) and id(node) not in own:
                yield node.attr
            elif isinstance(node, ast.ImportFrom) and path not in paths:
                yield from (alias.name for alias in node.names)


def _roots(kernels: Kernels, asked_for: Collection[str]) -> set[str]:
    """The kernels that code beside them may ask for, and those that no kernel calls."""
    called = {_callee(call) for function in kernels.values() for call in calls(function, kernels)}
    return {n for n in kernels if n.rpartition(".")[2] in asked_for or n not in called}


def _reached(kernels: Kernels, roots: Collection[str]) -> set[str]:
    """The roots and all that they call."""
    found: set[str] = set()
    left = list(roots)
    while left:
        name = left.pop()
        if name not in found:
            found.add(name)
            left += [_callee(call) for call in calls(kernels[name], kernels)]
    return found


def _callee(call: ast.Call) -> str:
    return call.func.id  # type: ignore[attr-defined]


def _local_names(own: Sequence[str], others: Sequence[str]) -> dict[str, str]:
    """Full name -> the name in the twin: the short one, unless two have the same."""
    short = Counter(name.rpartition(".")[2] for name in [*own, *others])
    names = {name: name.rpartition(".")[2] for name in own}
    for name in others:
        simple = name.rpartition(".")[2]
        names[name] = simple if short[simple] == 1 else name.replace(".", "_")
    return names


def _import_line(name: str, local: str) -> str:
    module, _, simple = name.rpartition(".")
    return f"from .{module} import {simple}" + (f" as {local}" if local != simple else "")


def _docstring(tree: ast.Module) -> str:
    text = ast.get_docstring(tree)
    return f'"""{text}"""' if text else ""


def _is_for_kernels(node: ast.stmt) -> bool:
    if isinstance(node, ast.FunctionDef):
        return is_kernel(node) or node.name in POINTERS
    if isinstance(node, ast.Assign):
        return all(isinstance(t, ast.Name) and t.id in POINTERS for t in node.targets)
    return False


def main(arguments: Sequence[str]) -> int:
    package = Path(arguments[0] if arguments else "firmware/zerorate")
    for path in write(package):
        print(path)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
