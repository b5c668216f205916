"""Writes firmware/zerorate/viper/X.py from every kernel file firmware/zerorate/X.py.

The decorator is handled by MicroPython's compiler, so it cannot be chosen at run time in one file:
the plain file is what people edit, its twin has `@micropython.viper` before every annotated def,
and says in fewer machine instructions what the plain one says for people (see twins/).
`make viper` runs this; host_tests/runtimes/test_viper_twins.py fails while a twin is stale.
"""

from __future__ import annotations

import ast
import copy
import sys
from collections import Counter
from collections.abc import Mapping, Sequence
from itertools import product
from pathlib import Path

from zerorate_tools.errors import InFile, ZerorateError
from zerorate_tools.kernel_rules import is_kernel
from zerorate_tools.twins.calling import able_to_call, passed_on
from zerorate_tools.twins.folding import folded
from zerorate_tools.twins.inlining import POINTERS, Inliner, callee, calls
from zerorate_tools.twins.jumps import REACH, longest_jumps
from zerorate_tools.twins.marks import marks
from zerorate_tools.twins.pointers import with_pointers
from zerorate_tools.twins.reaching import asked_for, reached, roots_of
from zerorate_tools.twins.registers import Parameter, as_it_is, for_registers
from zerorate_tools.twins.sources import all_kernels, annotated, kernel_file, parsed
from zerorate_tools.twins.wording import in_cheap_words

# nodes of the syntax tree that a function may have, each tried until its jumps are short enough
_LARGEST = (4000, 2500, 1500, 1000, 700, 500, 350, 200, 0)
# methods, which no kernel is
_BY_HAND = "direct.py"
# what room is kept for what parameters in registers change
_SHORT_ENOUGH = REACH - 100
_NOTE = "# Generated from zerorate/{name} by `make viper`: edit that file, not this one.\n"


class BadKernel(InFile):
    """A kernel file from which no twin can be made."""


def kernel_files(package: Path) -> list[Path]:
    """The files of `package` with annotated functions, which only kernels have; sorted by name."""
    files = sorted(package.glob("*.py"))
    return [path for path in files if annotated(parsed(path))]


def hot_functions(path: Path) -> list[str]:
    """The names of a kernel file's annotated functions: those that run in every update."""
    return [node.name for node in annotated(parsed(path))]


class Twins:
    """The twins of a package's kernel files. Raises BadKernel for one that cannot have any."""

    def __init__(self, paths: Sequence[Path]) -> None:
        for path in paths:
            _check(path, [p.stem for p in paths])
        self._kernels = all_kernels([kernel_file(path) for path in paths])
        self._results = {name for name, f in self._kernels.items() if f.returns}
        said = dict(mark for path in paths for mark in marks(path))
        self._inliners = [Inliner(self._kernels, said, largest) for largest in _LARGEST]
        roots = roots_of(self._kernels, set(asked_for(paths)))
        self._signatures = {name: self._parameters(f, True) for name, f in self._kernels.items()}
        self._flat = {name: self._flattened(name) for name in self._kernels}
        self._signatures = {n: self._parameters(f, n in roots) for n, f in self._flat.items()}
        self._needed = reached(self._flat, roots)

    def text(self, path: Path) -> str:
        """The text of a kernel file's twin; empty if it is written out wherever it is needed."""
        tree = parsed(path)
        names = [f"{path.stem}.{f.name}" for f in annotated(tree)]
        made = {name: self._flat[name] for name in names if name in self._needed}
        if not made:
            return ""
        others = sorted(
            {callee(c) for f in made.values() for c in calls(f, self._kernels)} - {*names}
        )
        local = _local_names(names, others)
        imports = [_import_line(name, local[name]) for name in others]
        plain = [ast.unparse(node) for node in self._plain_code(tree)]
        written = [self._written(name, function, local) for name, function in made.items()]
        head = [_NOTE.format(name=path.name) + _docstring(tree), "import micropython"]
        parts = ["\n\n".join([*head, *(["\n".join(imports)] if imports else []), *plain]), *written]
        return "\n\n\n".join(parts) + "\n"

    def _flattened(self, name: str) -> ast.FunctionDef:
        """The largest function whose jumps every compiler can say."""
        tried = ""
        for inliner, unrolled in product(self._inliners, (True, False)):
            function = in_cheap_words(with_pointers(folded(inliner.flat(name), unrolled)))
            text = self._alone(name, function)
            if text != tried and longest_jumps(text) <= [_SHORT_ENOUGH]:
                return function
            tried = text
        raise ZerorateError(f"{name} has jumps of more than {_SHORT_ENOUGH} bytes")

    def _parameters(self, function: ast.FunctionDef, fixed: bool) -> list[Parameter]:
        passed = passed_on(function, self._kernels)
        return (as_it_is if fixed else for_registers)(function, passed)

    def _alone(self, name: str, function: ast.FunctionDef) -> str:
        """A program of this function, with the parameters of the plain text everywhere."""
        self._signatures[name] = self._parameters(function, True)
        local = {name: name.replace(".", "_") for name in self._kernels}
        return "import micropython\n" + self._written(name, copy.deepcopy(function), local)

    def _plain_code(self, tree: ast.Module) -> list[ast.stmt]:
        """What is neither kernel nor made for kernels: code of the board beside them."""
        body = tree.body[1:] if ast.get_docstring(tree) else tree.body
        kept = [node for node in body if not _is_for_kernels(node)]
        modules = {name.partition(".")[0] for name in self._kernels}
        for node in kept:
            if isinstance(node, ast.ImportFrom) and node.level == 1:
                node.level = 1 if node.module in modules else 2
        return kept if any(isinstance(n, (ast.FunctionDef, ast.ClassDef)) for n in kept) else []

    def _written(self, name: str, function: ast.FunctionDef, local: Mapping[str, str]) -> str:
        able_to_call(function, name, self._signatures, local, self._results)
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
    return _changed(package, twins(package))


def _changed(package: Path, wanted: Mapping[Path, str]) -> list[Path]:
    there = set((package / "viper").glob("*.py")) - {package / "viper" / _BY_HAND}
    changed = {p for p in there & set(wanted) if p.read_text(encoding="utf-8") != wanted[p]}
    return sorted(changed | (there ^ set(wanted)))


def write(package: Path) -> list[Path]:
    """Write the twins and remove those without a kernel file; return what changed."""
    wanted = twins(package)
    changed = _changed(package, wanted)
    (package / "viper").mkdir(exist_ok=True)
    for path in changed:
        if path in wanted:
            path.write_text(wanted[path], encoding="utf-8")
        else:
            path.unlink()
    return changed


def _check(path: Path, kernels: Sequence[str]) -> None:
    tree = parsed(path)
    for function in annotated(tree):
        if function.decorator_list:
            raise BadKernel(path, f"{function.name} has a decorator", row=function.lineno)
    for node in tree.body:
        if isinstance(node, ast.ImportFrom) and node.level == 1:
            sources = [node.module] if node.module else [alias.name for alias in node.names]
            if len({name in kernels for name in sources}) > 1:
                problem = "imports kernels and other modules in one line"
                raise BadKernel(path, problem, row=node.lineno)


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
