"""What a kernel needs in viper to call another kernel.

Viper takes a result for an object, so each use of one becomes int(...). A pointer cannot be passed
on: as an argument it would be boxed as an address, on the heap where that is beyond a small
integer. So `s: ptr32` becomes the object `s_`, which is passed on, with a local `s = ptr32(s_)`.
"""

from __future__ import annotations

import ast
from collections.abc import Collection, Mapping

from .inlining import POINTERS, assigned, calls, kinds


def able_to_call(
    function: ast.FunctionDef, local: Mapping[str, str], results: Collection[str]
) -> None:
    """Change `function` in place, which calls kernels by their full names.

    local: full name -> the kernel's name in this file; results: full names of those that return.
    """
    found = list(calls(function, local))
    passed = {a.id for call in found for a in call.args if isinstance(a, ast.Name)}
    pointers = {name: kind for name, kind in kinds(function).items() if kind in POINTERS}
    objects = {name: kind for name, kind in pointers.items() if name in passed}
    used = {n.value.id for n in ast.walk(function) if isinstance(n, ast.Subscript)}  # type: ignore
    used |= _addressed(function)
    for parameter in function.args.args:
        if parameter.arg in objects:
            parameter.arg, parameter.annotation = f"{parameter.arg}_", None
    function.body = [_Call(objects, local, results).visit(node) for node in function.body]
    made = [
        assigned(name, ast.parse(f"{kind}({name}_)", mode="eval").body)
        for name, kind in objects.items()
        if name in used
    ]
    function.body = [*made, *function.body]


def _addressed(function: ast.FunctionDef) -> set[str]:
    """Names in int(...), of which pointers are made."""
    casts = [n for n in ast.walk(function) if isinstance(n, ast.Call)]
    return {getattr(n.args[0], "id", "") for n in casts if getattr(n.func, "id", "") == "int"}


class _Call(ast.NodeTransformer):
    def __init__(self, objects, local, results) -> None:
        self._objects, self._local, self._results = objects, local, results

    def visit_Expr(self, node: ast.Expr) -> ast.stmt:
        made = self.visit(node.value)
        unused = isinstance(made, ast.Call) and getattr(made.func, "id", "") == "int"
        node.value = made.args[0] if unused else made
        return node

    def visit_Call(self, node: ast.Call) -> ast.expr:
        self.generic_visit(node)
        name = getattr(node.func, "id", "")
        if name not in self._local:
            return node
        arguments: list[ast.expr] = []
        for argument in node.args:
            own = isinstance(argument, ast.Name) and argument.id in self._objects
            arguments.append(ast.Name(f"{argument.id}_", ast.Load()) if own else argument)  # type: ignore
        call = ast.Call(ast.Name(self._local[name], ast.Load()), arguments, [])
        return ast.Call(ast.Name("int", ast.Load()), [call], []) if name in self._results else call
