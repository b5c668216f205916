"""The kernels of a firmware package: constants are numbers, callees are named in full."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from ..kernel_rules import is_kernel


def parsed(path: Path) -> ast.Module:
    """The syntax tree of a file."""
    return ast.parse(path.read_text(encoding="utf-8"), str(path))


def annotated(tree: ast.Module) -> list[ast.FunctionDef]:
    """The kernels of a file: its functions with annotated parameters."""
    return [n for n in tree.body if isinstance(n, ast.FunctionDef) and is_kernel(n)]


@dataclass(frozen=True)
class KernelFile:
    """A file with kernels: its functions call others by "module.function"."""

    path: Path
    functions: dict[str, ast.FunctionDef]

    @property
    def module(self) -> str:
        """The name that other files import it by."""
        return self.path.stem


def kernel_file(path: Path) -> KernelFile:
    """Read a kernel file."""
    tree = parsed(path)
    constants = dict(_constants(tree))
    own = {node.name: f"{path.stem}.{node.name}" for node in annotated(tree)}
    names = {**dict(_imported(tree)), **own}
    resolve = _Resolve(constants, names)
    functions = {f"{path.stem}.{f.name}": _body_resolved(f, resolve) for f in annotated(tree)}
    return KernelFile(path, functions)


def all_kernels(files: Sequence[KernelFile]) -> dict[str, ast.FunctionDef]:
    """Qualified name -> function, of all files."""
    return {name: function for file in files for name, function in file.functions.items()}


def _constants(tree: ast.Module) -> Iterator[tuple[str, int]]:
    for node in tree.body:
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            value = node.value
            if isinstance(value, ast.Call) and getattr(value.func, "id", "") == "const":
                value = value.args[0]
            try:
                number = ast.literal_eval(value)
            except ValueError:
                continue
            if type(number) is int:
                yield node.targets[0].id, number


def _imported(tree: ast.Module) -> Iterator[tuple[str, str]]:
    for node in tree.body:
        if isinstance(node, ast.ImportFrom) and node.level == 1 and node.module:
            for alias in node.names:
                yield alias.asname or alias.name, f"{node.module}.{alias.name}"


def _body_resolved(function: ast.FunctionDef, resolve: _Resolve) -> ast.FunctionDef:
    body = function.body[1:] if ast.get_docstring(function) else function.body
    function.body = [resolve.visit(statement) for statement in body] or [ast.Pass()]
    return function


class _Resolve(ast.NodeTransformer):
    """Puts numbers for constants and full names for callees; drops int() around a call."""

    def __init__(self, constants: Mapping[str, int], names: Mapping[str, str]) -> None:
        self._constants, self._names = constants, names

    def visit_Name(self, node: ast.Name) -> ast.expr:
        if node.id in self._constants and isinstance(node.ctx, ast.Load):
            return ast.Constant(self._constants[node.id])
        return node

    def visit_Call(self, node: ast.Call) -> ast.expr:
        node.args = [self.visit(argument) for argument in node.args]
        name = getattr(node.func, "id", "")
        if name == "int" and isinstance(node.args[0], ast.Call):
            return node.args[0]
        if name in self._names:
            return ast.Call(ast.Name(self._names[name], ast.Load()), node.args, [])
        return node
