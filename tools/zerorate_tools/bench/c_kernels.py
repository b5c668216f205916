"""The firmware's kernels as one C file: the yardstick of what a compiler makes of the same text."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

from ..viper_twins import hot_functions, kernel_files
from .c_expressions import Expressions, NotKernel

_KINDS = {"int": "int32_t ", "ptr32": "int32_t *", "ptr8": "uint8_t *"}
_PREAMBLE = """\
/* Generated from firmware/zerorate by `python -m zerorate_tools.bench.c_program FILE`: edit
   those, not this. A yardstick for the benchmark; no board runs it. */
#include <stdint.h>

static inline int32_t floor_div(int32_t a, int32_t b) {
    return a / b - (a % b != 0 && (a < 0) != (b < 0));
}
static inline int32_t floor_mod(int32_t a, int32_t b) {
    int32_t rest = a % b;
    return rest != 0 && (rest < 0) != (b < 0) ? rest + b : rest;
}
static inline int32_t shift_left(int32_t a, int32_t by) {
    return (int32_t)((uint32_t)a << by);
}
"""


def kernels_in_c(package: Path, *entries: tuple[str, str]) -> str:
    """C text of `entries` (module, function) and all they call, as `int32_t MODULE_FUNCTION(...)`.

    package: the folder of the firmware. Raises NotKernel for text outside the subset.
    """
    files = {path.stem: _File(path) for path in kernel_files(package)}
    order: list[tuple[str, str]] = []
    for entry in entries:
        _visit(files, entry, order)
    parts = [_PREAMBLE, *(files[module].function(name) for module, name in order)]
    return "\n".join(parts)


def _visit(files: dict[str, _File], one: tuple[str, str], order: list[tuple[str, str]]) -> None:
    """Append `one` to `order` behind everything that it calls, unless it is there."""
    if one in order:
        return
    for called in files[one[0]].calls(one[1]):
        _visit(files, called, order)
    order.append(one)


class _File:
    """One kernel file: its constants, its functions and where the names come from."""

    def __init__(self, path: Path) -> None:
        self._path, tree = path, ast.parse(path.read_text(encoding="utf-8"))
        self._functions = {n.name: n for n in tree.body if isinstance(n, ast.FunctionDef)}
        self._homes = dict.fromkeys(hot_functions(path), path.stem)
        for node in tree.body:
            if isinstance(node, ast.ImportFrom) and node.level == 1 and node.module:
                self._homes.update((alias.name, node.module) for alias in node.names)
        self._write = Expressions(path, dict(_constants(tree)), self._name_in_c)

    def _name_in_c(self, name: str) -> str:
        if name not in self._homes:
            raise NotKernel(self._path, f"calls {name}, which is no kernel")
        return f"{self._homes[name]}_{name}"

    def calls(self, name: str) -> list[tuple[str, str]]:
        """The kernels that the function calls: (module, function)."""
        calls = [n for n in ast.walk(self._functions[name]) if isinstance(n, ast.Call)]
        names = [n.func.id for n in calls if isinstance(n.func, ast.Name) and n.func.id != "int"]
        return [(self._homes.get(n, self._path.stem), n) for n in dict.fromkeys(names)]

    def function(self, name: str) -> str:
        """The function in C."""
        node = self._functions[name]
        parameters = [a.arg for a in node.args.args]
        kinds = [_KINDS[a.annotation.id] for a in node.args.args]  # type: ignore[union-attr]
        head = ", ".join(kind + arg for kind, arg in zip(kinds, parameters))
        result = "static int32_t" if node.returns else "static void"
        lines = [f"{result} {self._name_in_c(name)}({head}) {{"]
        names = {n.id for n in ast.walk(node) if isinstance(n, ast.Name)}
        stored = {n.id for n in ast.walk(node) if isinstance(n, ast.Name) and _is_stored(n)}
        lines += [f"    int32_t {local} = 0;" for local in sorted(stored & names - set(parameters))]
        body = node.body[1 if ast.get_docstring(node) else 0 :]
        lines += [line for statement in body for line in self._statement(statement, "    ")]
        return "\n".join([*lines, "}", ""])

    def _statement(self, node: ast.stmt, indent: str) -> Iterator[str]:
        text = self._write.text
        if isinstance(node, ast.Assign) and len(node.targets) == 1:
            yield f"{indent}{text(node.targets[0])} = {text(node.value)};"
        elif isinstance(node, ast.AugAssign):
            target = text(node.target)
            value = self._write.binary(node.op, target, text(node.value), node)
            yield f"{indent}{target} = {value};"
        elif isinstance(node, ast.Return):
            yield f"{indent}return {text(node.value)};" if node.value else f"{indent}return;"
        elif isinstance(node, ast.Expr):
            yield f"{indent}{text(node.value)};"
        elif isinstance(node, (ast.If, ast.While)):
            yield from self._block(node, indent)
        elif isinstance(node, (ast.Break, ast.Continue)):
            yield f"{indent}{type(node).__name__.lower()};"
        else:
            raise self._write.refused(node)

    def _block(self, node: ast.If | ast.While, indent: str) -> Iterator[str]:
        word = "if" if isinstance(node, ast.If) else "while"
        yield f"{indent}{word} {self._write.test(node.test)} {{"
        yield from self._body(node.body, indent)
        if node.orelse and isinstance(node, ast.While):
            raise self._write.refused(node)
        if node.orelse:
            yield f"{indent}}} else {{"
            yield from self._body(node.orelse, indent)
        yield f"{indent}}}"

    def _body(self, statements: list[ast.stmt], indent: str) -> Iterator[str]:
        for statement in statements:
            yield from self._statement(statement, indent + "    ")


def _is_stored(node: ast.AST) -> bool:
    return isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)


def _constants(tree: ast.Module) -> Iterator[tuple[str, int]]:
    for node in tree.body:
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.Call):
            yield node.targets[0].id, ast.literal_eval(node.value.args[0])  # type: ignore[attr-defined]
