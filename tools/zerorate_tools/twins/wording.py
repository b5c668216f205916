"""The same said in the words that cost viper least; each was counted on x86.

`s[3] += x` works its place out again; a comparison makes 0 or 1 of its outcome before it is
tested, a difference or a shift is tested as it is; what is worked out first need not be put aside.
"""

from __future__ import annotations

import ast
import copy

_COMMUTE = (ast.Add, ast.Mult, ast.BitAnd, ast.BitOr, ast.BitXor)
_SIGN = 30


def in_cheap_words(function: ast.FunctionDef) -> ast.FunctionDef:
    """The function, saying the same."""
    return _Word().visit(copy.deepcopy(function))


class _Word(ast.NodeTransformer):
    def visit_AugAssign(self, node: ast.AugAssign) -> ast.stmt:
        self.generic_visit(node)
        target = node.target
        if isinstance(target, ast.Subscript) and not isinstance(
            target.slice, (ast.Constant, ast.Name)
        ):
            return node
        load = copy.deepcopy(target)
        load.ctx = ast.Load()
        value = _operation(load, node.op, node.value)
        return ast.Assign([target], value)

    def visit_BinOp(self, node: ast.BinOp) -> ast.expr:
        self.generic_visit(node)
        return _operation(node.left, node.op, node.right)

    def visit_If(self, node: ast.If) -> ast.stmt:
        self.generic_visit(node)
        node.test = _test(node.test)
        return node

    def visit_While(self, node: ast.While) -> ast.stmt:
        self.generic_visit(node)
        node.test = _test(node.test)
        return node


def _operation(left: ast.expr, op: ast.operator, right: ast.expr) -> ast.expr:
    """What is made of parts comes first, where the order is free."""
    calls = any(isinstance(n, ast.Call) for part in (left, right) for n in ast.walk(part))
    if isinstance(op, _COMMUTE) and not calls and _is_simple(left) and not _is_simple(right):
        left, right = right, left
    return ast.BinOp(left, op, right)


def _is_simple(node: ast.expr) -> bool:
    return isinstance(node, (ast.Name, ast.Subscript, ast.Constant))


def _test(node: ast.expr) -> ast.expr:
    if isinstance(node, ast.BoolOp):
        return ast.BoolOp(node.op, [_test(part) for part in node.values])
    if not isinstance(node, ast.Compare) or len(node.ops) > 1:
        return node
    op, left, right = node.ops[0], node.left, node.comparators[0]
    by_zero = isinstance(right, ast.Constant) and right.value == 0
    if isinstance(op, (ast.Eq, ast.NotEq)):
        differ = left if by_zero else ast.BinOp(left, ast.Sub(), right)
        return differ if isinstance(op, ast.NotEq) else ast.UnaryOp(ast.Not(), differ)
    if by_zero and isinstance(op, (ast.Lt, ast.GtE)):
        sign = ast.BinOp(left, ast.RShift(), ast.Constant(_SIGN))
        return sign if isinstance(op, ast.Lt) else ast.UnaryOp(ast.Not(), sign)
    return node
