"""What a kernel's text needs in viper to call another kernel.

Viper takes a result for an object, so each use of one becomes int(...). A pointer cannot be passed
on: as an argument it would be boxed as an address, on the heap where that is beyond a small
integer. So `s: ptr32` becomes the object `s_`, which is passed on, with a local `s = ptr32(s_)`.
"""

from __future__ import annotations

import ast
from collections.abc import Collection, Iterator
from typing import NamedTuple

POINTERS = ("ptr8", "ptr32")


class Edit(NamedTuple):
    """Put `text` in place of columns start..end of the 1-based `row`."""

    row: int
    start: int
    end: int
    text: str


def let_it_call(lines: list[str], function: ast.FunctionDef, results: Collection[str]) -> None:
    """Change the lines of `function` in place; results: names of kernels that return something."""
    passed_on = _pointers_passed_on(function)
    edits = [*_results_as_integers(function, results), *_objects_for(function, passed_on)]
    for row, start, end, text in sorted(edits, reverse=True):
        line = lines[row - 1]
        lines[row - 1] = line[:start] + text + line[end:]
    used = _indexed(function)
    first = function.body[1 if ast.get_docstring(function) else 0].lineno - 1
    made = [f"    {p} = {kind}({p}_)\n" for p, kind in passed_on.items() if p in used]
    lines[first] = "".join(made) + lines[first]


def _calls(function: ast.FunctionDef) -> list[ast.Call]:
    return [node for node in ast.walk(function) if isinstance(node, ast.Call)]


def _plain_name(node: ast.expr | None) -> str:
    """The plain name that an expression is, else an empty string."""
    return node.id if isinstance(node, ast.Name) else ""


def _indexed(function: ast.FunctionDef) -> set[str]:
    return {_plain_name(n.value) for n in ast.walk(function) if isinstance(n, ast.Subscript)}


def _pointers_passed_on(function: ast.FunctionDef) -> dict[str, str]:
    passed = {_plain_name(a) for call in _calls(function) for a in call.args}
    kinds = {a.arg: _plain_name(a.annotation) for a in function.args.args if a.arg in passed}
    return {name: kind for name, kind in kinds.items() if kind in POINTERS}


def _objects_for(function: ast.FunctionDef, passed_on: Collection[str]) -> Iterator[Edit]:
    for parameter in function.args.args:
        if parameter.arg in passed_on:
            end = parameter.end_col_offset or 0
            yield Edit(parameter.lineno, parameter.col_offset, end, f"{parameter.arg}_")
    for argument in (a for call in _calls(function) for a in call.args):
        if _plain_name(argument) in passed_on:
            end = argument.end_col_offset or 0
            yield Edit(argument.lineno, end, end, "_")


def _results_as_integers(function: ast.FunctionDef, results: Collection[str]) -> Iterator[Edit]:
    alone = [node.value for node in ast.walk(function) if isinstance(node, ast.Expr)]
    for call in _calls(function):
        if _plain_name(call.func) in results and call not in alone:
            yield Edit(call.lineno, call.col_offset, call.col_offset, "int(")
            end = call.end_col_offset or 0
            yield Edit(call.end_lineno or call.lineno, end, end, ")")
