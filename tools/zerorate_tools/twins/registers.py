"""Which locals of a kernel live in registers: viper keeps its first three parameters there.

A word through a pointer in a register costs viper one instruction less, and so does each use of a
number. So a kernel that only kernels call gets what it uses most as its first parameters: its own
ones, pointers to arrays that it also passes on as objects, and locals, for which callers pass 0.
"""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Collection
from dataclasses import dataclass

from .inlining import POINTERS, is_stored, kinds

REGISTERS = 3
# uses that make up for passing one argument more, and how often a loop is taken to run
_WORTH = 200
_ROUNDS = 20


@dataclass(frozen=True)
class Parameter:
    """A parameter in a twin. argument: its place in the kernel's call, None where 0 is passed.

    kind: int, ptr8, ptr32, or empty for an object.
    """

    name: str
    kind: str
    argument: int | None


def as_it_is(function: ast.FunctionDef, passed: Collection[str]) -> list[Parameter]:
    """The parameters of a kernel that others than kernels call; passed: pointers it passes on."""
    return [
        Parameter(f"{name}_", "", place) if name in passed else Parameter(name, kind, place)
        for place, (name, kind) in enumerate(kinds(function).items())
    ]


def for_registers(function: ast.FunctionDef, passed: Collection[str]) -> list[Parameter]:
    """The parameters of a kernel that only kernels call, those it uses most before the others."""
    own = kinds(function)
    places = {name: place for place, name in enumerate(own)}
    used: Counter[str] = Counter()
    for statement in function.body:
        _count(statement, 1, used)
    typed = {name: kind for name, kind in own.items() if name not in passed or used[name]}
    typed |= {name: kind for name, kind in _locals(function).items() if used[name] >= _WORTH}
    order = sorted(typed, key=lambda name: (-used[name], name))
    chosen = order[:REGISTERS] + [name for name in order[REGISTERS:] if name in own]
    made = [Parameter(name, typed[name], places.get(name)) for name in chosen]
    return made + [Parameter(f"{name}_", "", places[name]) for name in own if name in passed]


def _count(node: ast.AST, rounds: float, used: Counter[str]) -> None:
    """Add the uses of each name: many in a loop, half a one in a branch, none where passed on."""
    if isinstance(node, (ast.While, ast.For)):
        rounds *= _ROUNDS
    if isinstance(node, ast.If):
        rounds /= 2
    if isinstance(node, ast.Name):
        used[node.id] += rounds  # type: ignore[assignment]
    for child in ast.iter_child_nodes(node):
        passed_on = isinstance(node, ast.Call) and "." in getattr(node.func, "id", "")
        if not (passed_on and isinstance(child, ast.Name)):
            _count(child, rounds, used)


def _locals(function: ast.FunctionDef) -> dict[str, str]:
    """Local -> int, ptr8 or ptr32."""
    found: dict[str, str] = {}
    for node in ast.walk(function):
        if isinstance(node, ast.Assign) and is_stored(node.targets[0]):
            kind = getattr(getattr(node.value, "func", None), "id", "")
            found[node.targets[0].id] = kind if kind in POINTERS else "int"  # type: ignore
    return {name: kind for name, kind in found.items() if name not in kinds(function)}
