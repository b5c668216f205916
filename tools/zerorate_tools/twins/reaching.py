"""Which kernels need a twin of their own: what other code asks for, and all that they call."""

from __future__ import annotations

import ast
from collections.abc import Collection, Iterator, Sequence
from pathlib import Path

from .inlining import Kernels, callee, calls
from .sources import annotated, parsed


def asked_for(paths: Sequence[Path]) -> Iterator[str]:
    """The names that code beside the kernels may mean kernels by."""
    for path in sorted({file for one in paths for file in one.parent.glob("*.py")}):
        tree = parsed(path)
        nodes = annotated(tree) if path in paths else []
        own = {id(n) for function in nodes for n in ast.walk(function)}
        for node in ast.walk(tree):
            if isinstance(node, ast.Attribute) and id(node) not in own:
                yield node.attr
            elif isinstance(node, ast.ImportFrom) and path not in paths:
                yield from (alias.name for alias in node.names)


def roots_of(kernels: Kernels, asked_for: Collection[str]) -> set[str]:
    """The kernels that code beside them may ask for, and those that no kernel calls."""
    called = {callee(call) for function in kernels.values() for call in calls(function, kernels)}
    return {n for n in kernels if n.rpartition(".")[2] in asked_for or n not in called}


def reached(kernels: Kernels, roots: Collection[str]) -> set[str]:
    """The roots and all that they call."""
    found: set[str] = set()
    left = list(roots)
    while left:
        name = left.pop()
        if name not in found:
            found.add(name)
            left += [callee(call) for call in calls(kernels[name], kernels)]
    return found
