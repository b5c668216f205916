"""What is known before a kernel runs: constants folded, short loops of known length unrolled."""

from __future__ import annotations

import ast
import copy
import operator

from .inlining import assigned, is_stored, names_stored, size

MOST_ROUNDS = 8
MOST_NODES = 2000

Known = dict[str, int]

_ARITHMETIC = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.LShift: operator.lshift,
    ast.RShift: operator.rshift,
    ast.BitAnd: operator.and_,
    ast.BitOr: operator.or_,
    ast.BitXor: operator.xor,
}
_COMPARED = {
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
}


def folded(function: ast.FunctionDef, unrolled: bool = True) -> ast.FunctionDef:
    """The function with what is known beforehand worked out; locals that nobody reads are gone."""
    made = copy.deepcopy(function)
    if unrolled:
        made.body = _block(made.body, {}) or [ast.Pass()]
    while unread := _unread(made):
        made.body = _without(made.body, unread) or [ast.Pass()]
    return made


def _block(statements: list[ast.stmt], known: Known) -> list[ast.stmt]:
    made: list[ast.stmt] = []
    for statement in statements:
        made += _statement(statement, known)
        if made and isinstance(made[-1], (ast.Return, ast.Break, ast.Continue)):
            break
    return made


def _statement(node: ast.stmt, known: Known) -> list[ast.stmt]:
    if isinstance(node, ast.If):
        return _if(node, known)
    if isinstance(node, (ast.While, ast.For)):
        return _loop(node, known)
    node = _Fold(known).visit(node)
    for name in names_stored(node):
        known.pop(name, None)
    if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
        if isinstance(node.value, ast.Constant):
            known[node.targets[0].id] = node.value.value  # type: ignore[assignment]
    return [node]


def _if(node: ast.If, known: Known) -> list[ast.stmt]:
    test = _Fold(known).visit(node.test)
    if isinstance(test, ast.Constant):
        return _block(node.body if test.value else node.orelse, known)
    yes, no = dict(known), dict(known)
    body, orelse = _block(node.body, yes), _block(node.orelse, no)
    for name in set(known) | set(yes) | set(no):
        known.pop(name, None)
        if name in yes and yes.get(name) == no.get(name):
            known[name] = yes[name]
    if not body and not orelse:
        return []
    return [ast.If(test, body or [ast.Pass()], orelse)]


def _loop(node: ast.While | ast.For, known: Known) -> list[ast.stmt]:
    rounds = _rounds(node, known)
    if rounds is not None:
        counter, values = rounds
        made: list[ast.stmt] = []
        for value in values[:-1]:
            known[counter] = value
            made += _block(copy.deepcopy(node.body[:-1]), known)
        known[counter] = values[-1]
        return [*made, assigned(counter, ast.Constant(values[-1]))]
    for name in names_stored(node):
        known.pop(name, None)
    if isinstance(node, ast.While):
        node.test = _Fold(known).visit(node.test)
    else:
        node.iter = _Fold(known).visit(node.iter)
    node.body = _block(node.body, dict(known))
    return [node]


def _rounds(node: ast.While | ast.For, known: Known) -> tuple[str, list[int]] | None:
    """The counter of a loop of known length and the values it takes, the last one behind it."""
    test = node.test if isinstance(node, ast.While) else None
    if not isinstance(test, ast.Compare) or not isinstance(test.left, ast.Name):
        return None
    counter, last = test.left.id, node.body[-1]
    stores = sum(is_stored(n) and n.id == counter for n in ast.walk(node))  # type: ignore
    by_one = isinstance(last, ast.AugAssign) and ast.unparse(last) == f"{counter} += 1"
    leaves = any(isinstance(n, (ast.Break, ast.Continue)) for n in ast.walk(node))
    if counter not in known or not by_one or stores != 1 or leaves:
        return None
    values = [known[counter]]
    while len(values) <= MOST_ROUNDS:
        go_on = _Fold({counter: values[-1]}).visit(copy.deepcopy(test))
        if not isinstance(go_on, ast.Constant):
            return None
        if not go_on.value:
            return (counter, values) if len(values) * size(node) <= MOST_NODES else None
        values.append(values[-1] + 1)
    return None


def _unread(function: ast.FunctionDef) -> set[str]:
    names = [n for n in ast.walk(function) if isinstance(n, ast.Name)]
    read = {n.id for n in names if isinstance(n.ctx, ast.Load)}
    plain = {t.id for n in ast.walk(function) if _is_plain(n) for t in n.targets}  # type: ignore
    return plain - read - {a.arg for a in function.args.args}


def _is_plain(node: ast.AST) -> bool:
    if not isinstance(node, ast.Assign) or not isinstance(node.targets[0], ast.Name):
        return False
    return not any(isinstance(n, ast.Call) for n in ast.walk(node.value))


def _without(statements: list[ast.stmt], unread: set[str]) -> list[ast.stmt]:
    made: list[ast.stmt] = []
    for node in statements:
        for part in ("body", "orelse"):
            if getattr(node, part, None):
                left = _without(getattr(node, part), unread)
                setattr(node, part, left or ([ast.Pass()] if part == "body" else []))
        if _is_plain(node) and node.targets[0].id in unread:  # type: ignore[attr-defined]
            continue
        if isinstance(node, ast.AugAssign) and getattr(node.target, "id", "") in unread:
            continue
        made.append(node)
    return made


class _Fold(ast.NodeTransformer):
    """Puts numbers for names that are known and for operations on numbers."""

    def __init__(self, known: Known) -> None:
        self._known = known

    def visit_Name(self, node: ast.Name) -> ast.expr:
        if isinstance(node.ctx, ast.Load) and node.id in self._known:
            return ast.Constant(self._known[node.id])
        return node

    def visit_UnaryOp(self, node: ast.UnaryOp) -> ast.expr:
        node.operand = self.visit(node.operand)
        number = _number(node.operand)
        if number is not None and isinstance(node.op, ast.USub):
            return ast.Constant(-number)
        if number is not None and isinstance(node.op, ast.Not):
            return ast.Constant(int(not number))
        return node

    def visit_BinOp(self, node: ast.BinOp) -> ast.expr:
        node.left, node.right = self.visit(node.left), self.visit(node.right)
        left, right = _number(node.left), _number(node.right)
        if left is not None and right is not None and type(node.op) in _ARITHMETIC:
            return ast.Constant(_ARITHMETIC[type(node.op)](left, right))
        return _reassociated(node)

    def visit_Compare(self, node: ast.Compare) -> ast.expr:
        node.left = self.visit(node.left)
        node.comparators = [self.visit(part) for part in node.comparators]
        left, right = _number(node.left), _number(node.comparators[0])
        if left is None or right is None or len(node.ops) > 1:
            return node
        return ast.Constant(int(_COMPARED[type(node.ops[0])](left, right)))

    def visit_BoolOp(self, node: ast.BoolOp) -> ast.expr:
        decides = isinstance(node.op, ast.Or)
        parts: list[ast.expr] = []
        for part in map(self.visit, node.values):
            number = _number(part)
            if number is None:
                parts.append(part)
            elif bool(number) == decides:
                parts.append(ast.Constant(int(decides)))
                break
        if not parts:
            return ast.Constant(int(not decides))
        return parts[0] if len(parts) == 1 else ast.BoolOp(node.op, parts)


def _number(node: ast.expr) -> int | None:
    return node.value if isinstance(node, ast.Constant) and type(node.value) is int else None


def _reassociated(node: ast.BinOp) -> ast.expr:
    """x + 0 is x; (x + 1) + 2 is x + 3; 1 + x is x + 1."""
    if isinstance(node.op, ast.Add) and _number(node.left) is not None:
        node.left, node.right = node.right, node.left
    right = _number(node.right)
    if right is None or not isinstance(node.op, (ast.Add, ast.Sub)):
        return node
    by = right if isinstance(node.op, ast.Add) else -right
    inner = node.left
    if isinstance(inner, ast.BinOp) and isinstance(inner.op, (ast.Add, ast.Sub)):
        own = _number(inner.right)
        if own is not None:
            by += own if isinstance(inner.op, ast.Add) else -own
            node.left = inner.left
    if by == 0:
        return node.left
    node.op = ast.Add() if by > 0 else ast.Sub()
    node.right = ast.Constant(abs(by))
    return node
