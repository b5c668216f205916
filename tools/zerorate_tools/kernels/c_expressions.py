"""The expressions of the kernel subset in C: 32-bit integers with Python's meaning."""

import ast
from collections.abc import Callable, Mapping
from pathlib import Path

from .reading import NotKernel

_PLAIN = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.BitAnd: "&", ast.BitOr: "|"}
_PLAIN |= {ast.BitXor: "^", ast.RShift: ">>"}
_CALLED = {ast.FloorDiv: "floor_div", ast.Mod: "floor_mod", ast.LShift: "shift_left"}
_COMPARED = {ast.Eq: "==", ast.NotEq: "!=", ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">="}
_UNARY = {ast.USub: "-", ast.Invert: "~", ast.Not: "!"}


class Expressions:
    """Writes expressions; constants: names folded to numbers; function: a kernel's name in C."""

    def __init__(
        self, path: Path, constants: Mapping[str, int], function: Callable[[str], str]
    ) -> None:
        self._path, self._constants, self._function = path, constants, function

    def text(self, node: ast.expr) -> str:
        """The expression in C, in brackets where it has parts. Raises NotKernel."""
        writer = getattr(self, f"_{type(node).__name__.lower()}", None)
        if writer is None:
            raise self.refused(node)
        return writer(node)

    def test(self, node: ast.expr) -> str:
        """The expression as the condition of a statement, in one pair of brackets."""
        text = self.text(node)
        return text if isinstance(node, (ast.Compare, ast.BoolOp)) else f"({text})"

    def refused(self, node: ast.AST) -> NotKernel:
        """The error that says which line is outside the subset."""
        problem = f"{type(node).__name__} is not in the kernel subset"
        return NotKernel(self._path, problem, row=getattr(node, "lineno", None))

    def problem(self, what: str) -> NotKernel:
        """The error that says what is wrong with a kernel of this file."""
        return NotKernel(self._path, what)

    def binary(self, operator: ast.operator, left: str, right: str, node: ast.AST) -> str:
        if type(operator) in _CALLED:
            return f"{_CALLED[type(operator)]}({left}, {right})"
        if type(operator) in _PLAIN:
            return f"({left} {_PLAIN[type(operator)]} {right})"
        raise self.refused(node)

    def _constant(self, node: ast.Constant) -> str:
        if type(node.value) is not int:
            raise self.refused(node)
        return str(node.value)

    def _name(self, node: ast.Name) -> str:
        if node.id in self._constants:
            number = self._constants[node.id]
            return str(number) if number >= 0 else f"({number})"
        return node.id

    def _subscript(self, node: ast.Subscript) -> str:
        return f"{self.text(node.value)}[{self.text(node.slice)}]"

    def _binop(self, node: ast.BinOp) -> str:
        return self.binary(node.op, self.text(node.left), self.text(node.right), node)

    def _unaryop(self, node: ast.UnaryOp) -> str:
        return f"({_UNARY[type(node.op)]}{self.text(node.operand)})"

    def _boolop(self, node: ast.BoolOp) -> str:
        word = " && " if isinstance(node.op, ast.And) else " || "
        return f"({word.join(self.text(value) for value in node.values)})"

    def _compare(self, node: ast.Compare) -> str:
        operands = [self.text(part) for part in (node.left, *node.comparators)]
        pairs = zip(operands, node.ops, operands[1:])
        tests = [f"({a} {_COMPARED[type(op)]} {b})" for a, op, b in pairs]
        return tests[0] if len(tests) == 1 else f"({' && '.join(tests)})"

    def _ifexp(self, node: ast.IfExp) -> str:
        return f"({self.text(node.test)} ? {self.text(node.body)} : {self.text(node.orelse)})"

    def _call(self, node: ast.Call) -> str:
        if not isinstance(node.func, ast.Name) or node.keywords:
            raise self.refused(node)
        arguments = ", ".join(self.text(argument) for argument in node.args)
        return f"{self._function(node.func.id)}({arguments})"
