"""What a kernel needs in viper to call another kernel.

Viper takes a result for an object, so each use of one becomes int(...). A pointer cannot be passed
on: as an argument it would be boxed as an address, on the heap where that is beyond a small
integer. So `s: ptr32` becomes the object `s_`, which is passed on, with a local `s = ptr32(s_)`
unless it is a parameter as well (see registers.py).
"""

from __future__ import annotations

import ast
from collections.abc import Collection, Mapping, Sequence

from .inlining import POINTERS, assigned, calls, kinds
from .registers import Parameter

Signatures = Mapping[str, Sequence[Parameter]]


def passed_on(function: ast.FunctionDef, kernels: Collection[str]) -> set[str]:
    """The pointers that a kernel passes on to others."""
    pointers = {name for name, kind in kinds(function).items() if kind in POINTERS}
    arguments = [a for call in calls(function, kernels) for a in call.args]
    return pointers & {a.id for a in arguments if isinstance(a, ast.Name)}


def able_to_call(
    function: ast.FunctionDef,
    name: str,
    signatures: Signatures,
    local: Mapping[str, str],
    results: Collection[str],
) -> None:
    """Change `function` in place, which calls kernels by their full names.

    name: its own full name; local: full name -> the kernel's name in this file; results: full
    names of those that return.
    """
    objects = passed_on(function, local)
    used = {n.value.id for n in ast.walk(function) if isinstance(n, ast.Subscript)}  # type: ignore
    used |= _addressed(function)
    pointers = kinds(function)
    function.args.args = [_argument(parameter) for parameter in signatures[name]]
    function.body = [
        _Call(objects, signatures, local, results).visit(node) for node in function.body
    ]
    typed = {parameter.name for parameter in signatures[name] if parameter.kind}
    made = [
        assigned(name, ast.parse(f"{pointers[name]}({name}_)", mode="eval").body)
        for name in sorted((objects & used) - typed, key=list(pointers).index)
    ]
    function.body = [*made, *function.body]


def _argument(parameter: Parameter) -> ast.arg:
    kind = ast.Name(parameter.kind, ast.Load()) if parameter.kind else None
    return ast.arg(parameter.name, kind)


def _addressed(function: ast.FunctionDef) -> set[str]:
    """Names in int(...), of which pointers are made."""
    casts = [n for n in ast.walk(function) if isinstance(n, ast.Call)]
    return {getattr(n.args[0], "id", "") for n in casts if getattr(n.func, "id", "") == "int"}


class _Call(ast.NodeTransformer):
    def __init__(self, objects, signatures: Signatures, local, results) -> None:
        self._objects, self._signatures = objects, signatures
        self._local, self._results = local, results

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
        given = [self._given(argument) for argument in node.args]
        places = [parameter.argument for parameter in self._signatures[name]]
        arguments = [ast.Constant(0) if place is None else given[place] for place in places]
        call = ast.Call(ast.Name(self._local[name], ast.Load()), arguments, [])
        return ast.Call(ast.Name("int", ast.Load()), [call], []) if name in self._results else call

    def _given(self, argument: ast.expr) -> ast.expr:
        own = isinstance(argument, ast.Name) and argument.id in self._objects
        return ast.Name(f"{argument.id}_", ast.Load()) if own else argument  # type: ignore
