"""A kernel with the kernels that it calls written out in it: in viper a call costs more than most.

A call from viper code to viper code takes some 700 instructions on x86, for its arguments and its
result are boxed and its name is looked up; so what is small, or called from one place only, is
written out there. Local names of a callee get its name before them.
"""

from __future__ import annotations

import ast
import copy
from collections import Counter
from collections.abc import Collection, Iterator, Mapping

from .marks import CALL, INLINE
from .returns import Deliver, without_returns

# nodes of the syntax tree: what is written out wherever it is called, and what where it is so once
SMALL = 180
ONCE = 1500

POINTERS = ("ptr8", "ptr32")

Kernels = Mapping[str, ast.FunctionDef]


def size(node: ast.AST) -> int:
    """How large a piece of a program is."""
    return sum(1 for _ in ast.walk(node))


def calls(node: ast.AST, kernels: Collection[str]) -> Iterator[ast.Call]:
    """The calls of kernels within `node`."""
    for n in ast.walk(node):
        if isinstance(n, ast.Call) and isinstance(n.func, ast.Name) and n.func.id in kernels:
            yield n


def callee(call: ast.Call) -> str:
    """The name of what is called; empty where it is no name."""
    return getattr(call.func, "id", "")


def is_stored(node: ast.AST) -> bool:
    """Is it a name that is given a value?"""
    return isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)


def names_stored(node: ast.AST) -> set[str]:
    """The names that are given a value within `node`."""
    return {n.id for n in ast.walk(node) if is_stored(n)}  # type: ignore[attr-defined]


def kinds(function: ast.FunctionDef) -> dict[str, str]:
    """Parameter -> int, ptr8 or ptr32; an empty string where it is an object."""
    return {a.arg: getattr(a.annotation, "id", "") for a in function.args.args}


def assigned(name: str, value: ast.expr) -> ast.Assign:
    """The statement `name = value`."""
    return ast.Assign([ast.Name(name, ast.Store())], value)


class Inliner:
    """kernels: full name -> function, whose calls name their callees in full.

    marks: INLINE of those that are written out wherever they are called, CALL of those that are
    called in every case; largest: nodes that a function may grow to.
    """

    def __init__(self, kernels: Kernels, marks: Mapping[str, str], largest: int) -> None:
        self._kernels, self._marks, self._largest = kernels, marks, largest
        self._flat: dict[str, ast.FunctionDef] = {}
        self._sites = Counter(callee(c) for f in kernels.values() for c in calls(f, kernels))
        self._simple = Counter(name.rpartition(".")[2] for name in kernels)
        self._arrays: set[str] = set()
        self._grown = 0

    def flat(self, name: str) -> ast.FunctionDef:
        """The kernel with everything written out in it that is worth it."""
        if name not in self._flat:
            function = copy.deepcopy(self._kernels[name])
            outer = self._arrays, self._grown
            self._grown = size(function)
            self._arrays = {arg for arg, kind in kinds(function).items() if kind in POINTERS}
            function.body = self._block(function.body)
            self._arrays, self._grown = outer
            self._flat[name] = function
        return self._flat[name]

    def _worth(self, name: str) -> bool:
        large = size(self.flat(name))
        mark = self._marks.get(name)
        most = ONCE if self._sites[name] == 1 or mark == INLINE else SMALL
        return mark != CALL and large <= min(most, self._largest - self._grown)

    def _block(self, statements: list[ast.stmt]) -> list[ast.stmt]:
        return [made for statement in statements for made in self._statement(statement)]

    def _statement(self, node: ast.stmt) -> list[ast.stmt]:
        before: list[ast.stmt] = []
        if isinstance(node, (ast.While, ast.For)):
            node.body = self._block(node.body)
        elif isinstance(node, ast.If):
            before = self._before_a_test(node)
            node.body, node.orelse = self._block(node.body), self._block(node.orelse)
        elif isinstance(node, (ast.Assign, ast.AugAssign, ast.Return, ast.Expr)) and node.value:
            deliver = _delivery(node)
            if deliver and self._is_inlined(node.value):
                assert isinstance(node.value, ast.Call)
                return self._in_place(node.value, None if deliver is _as_it_is else deliver)
            if not self._reads_its_place_first(node):
                before, node.value = self._hoisted(node.value)
        return [*before, node]

    def _reads_its_place_first(self, node: ast.stmt) -> bool:
        """Is it `s[i] += f(s)`, where f may write what was read before it was called?"""
        if not isinstance(node, ast.AugAssign) or not isinstance(node.target, ast.Subscript):
            return False
        callees = [callee(call) for call in calls(node.value, self._kernels)]
        return not all(_is_pure(self.flat(name)) for name in callees)

    def _is_inlined(self, node: ast.expr) -> bool:
        if not isinstance(node, ast.Call) or callee(node) not in self._kernels:
            return False
        passed = zip(kinds(self._kernels[callee(node)]).values(), node.args)
        arrays = [getattr(argument, "id", "") for kind, argument in passed if kind in POINTERS]
        return self._arrays.issuperset(arrays) and self._worth(callee(node))

    def _before_a_test(self, node: ast.If) -> list[ast.stmt]:
        """What must stand before an if whose condition calls; `a and f()` becomes two ifs."""
        test = node.test
        if isinstance(test, ast.BoolOp):
            *first, last = test.values
            if isinstance(test.op, ast.And) and not node.orelse and any(calls(last, self._kernels)):
                node.body = [ast.If(last, node.body, [])]
                node.test = first[0] if len(first) == 1 else ast.BoolOp(test.op, first)
                return self._before_a_test(node)
            if any(True for v in test.values[1:] for _ in calls(v, self._kernels)):
                return []
        before, node.test = self._hoisted(test)
        return before

    def _hoisted(self, value: ast.expr, count: int = 1) -> tuple[list[ast.stmt], ast.expr]:
        """The calls in `value` as statements before it, and what remains of it."""
        found = set(calls(value, self._kernels))
        for call in [n for n in _as_evaluated(value) if n in found]:
            assert isinstance(call, ast.Call)
            if not self._is_inlined(call):
                return [], value
            if _loads_before(value, call) and not _is_pure(self.flat(callee(call))):
                return [], value
            result = f"{self._prefix(callee(call))}_result" + (f"_{count}" if count > 1 else "")
            body = self._in_place(call, _kept_in(result))
            rest = _Replace(call, ast.Name(result, ast.Load())).visit(value)
            more, rest = self._hoisted(rest, count + 1)
            return [*body, *more], rest
        return [], value

    def _in_place(self, call: ast.Call, deliver: Deliver | None) -> list[ast.stmt]:
        """The callee's statements; deliver: None where its returns are the caller's own."""
        name = callee(call)
        function = copy.deepcopy(self.flat(name))
        prefix = self._prefix(name)
        self._grown += size(function)
        stored = names_stored(function)
        names: dict[str, ast.expr] = {n: ast.Name(f"{prefix}_{n}") for n in stored}
        bound: list[ast.stmt] = []
        for parameter, argument in zip(function.args.args, call.args):
            as_it_is = isinstance(argument, (ast.Name, ast.Constant))
            if as_it_is and parameter.arg not in stored:
                names[parameter.arg] = argument
            else:
                names[parameter.arg] = ast.Name(f"{prefix}_{parameter.arg}")
                bound.append(assigned(f"{prefix}_{parameter.arg}", argument))
        body = [_Rename(names).visit(statement) for statement in function.body]
        if deliver is not None:
            body = without_returns(body, deliver, f"{prefix}_left")
        return [*bound, *body]

    def _prefix(self, name: str) -> str:
        module, _, simple = name.rpartition(".")
        return simple if self._simple[simple] == 1 else f"{module}_{simple}"


def _as_it_is(value: ast.expr | None) -> list[ast.stmt]:
    return [ast.Return(value)]


def _delivery(node: ast.stmt) -> Deliver | None:
    """What becomes of a result that is all of a statement's value, where that is simple."""
    if isinstance(node, ast.Return):
        return _as_it_is
    if isinstance(node, ast.Expr):
        return lambda value: []
    if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
        target = node.targets[0].id
        return _kept_in(target)
    return None


def _kept_in(target: str) -> Deliver:
    return lambda value: [assigned(target, value)] if value else []


def _as_evaluated(node: ast.AST) -> Iterator[ast.AST]:
    """The parts of an expression, each behind those that it is made of."""
    for child in ast.iter_child_nodes(node):
        yield from _as_evaluated(child)
    yield node


def _loads_before(value: ast.expr, call: ast.AST) -> bool:
    """Is a word of an array read before the call, other than for its arguments?"""
    own = set(ast.walk(call))
    for node in _as_evaluated(value):
        if node is call:
            return False
        if isinstance(node, ast.Subscript) and node not in own:
            return True
    return False


def _is_pure(function: ast.FunctionDef) -> bool:
    stores = (n for n in ast.walk(function) if isinstance(n, ast.Subscript))
    return not any(isinstance(n.ctx, ast.Store) for n in stores) and not any(
        isinstance(n, ast.Call) for n in ast.walk(function)
    )


class _Replace(ast.NodeTransformer):
    def __init__(self, old: ast.AST, new: ast.expr) -> None:
        self._old, self._new = old, new

    def visit(self, node: ast.AST):
        return self._new if node is self._old else self.generic_visit(node)


class _Rename(ast.NodeTransformer):
    def __init__(self, names: Mapping[str, ast.expr]) -> None:
        self._names = names

    def visit_Name(self, node: ast.Name) -> ast.expr:
        if node.id not in self._names:
            return node
        made = copy.deepcopy(self._names[node.id])
        if isinstance(made, ast.Name):
            made.ctx = node.ctx
        return made
