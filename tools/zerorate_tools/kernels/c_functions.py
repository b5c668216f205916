"""Kernels as C: the text of which machine code, the library for hosts and the export are made."""

import ast
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

from .reading import KernelFile, Kernels, NotKernel

ARITHMETIC = """\
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
        problem = f"{type(node).__name__} is not in the kernel subset"
        return NotKernel(self._path, problem, row=getattr(node, "lineno", None))

    def problem(self, what: str) -> NotKernel:
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
        if type(node.op) not in _UNARY:
            raise self.refused(node)
        return f"({_UNARY[type(node.op)]}{self.text(node.operand)})"

    def _boolop(self, node: ast.BoolOp) -> str:
        word = " && " if isinstance(node.op, ast.And) else " || "
        return f"({word.join(self.text(value) for value in node.values)})"

    def _compare(self, node: ast.Compare) -> str:
        if any(type(op) not in _COMPARED for op in node.ops):
            raise self.refused(node)
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


def kernels_in_c(
    kernels: Kernels,
    *entries: tuple[str, str],
    arithmetic: str = ARITHMETIC,
    expressions: type[Expressions] = Expressions,
) -> str:
    """C text of `entries` (file, function) and all they call, as `static ... FILE_FUNCTION(...)`.

    arithmetic: defines floor_div, floor_mod and shift_left. expressions: what writes expressions.
    Raises NotKernel for text outside the subset.
    """
    order = kernels.behind(*entries)
    written = [_Function(kernels.files[file], name, expressions).text() for file, name in order]
    return "\n".join(["#include <stdint.h>\n", arithmetic, *written])


class _Function:
    def __init__(
        self, file: KernelFile, name: str, expressions: type[Expressions] = Expressions
    ) -> None:
        self._file, self._name, self._node = file, name, file.kernels[name]
        self._write = expressions(file.path, file.constants, self._name_in_c)

    def _name_in_c(self, name: str) -> str:
        if name not in self._file.homes:
            raise self._write.problem(f"calls {name}, which is no kernel")
        return "_".join(self._file.homes[name])

    def head(self) -> str:
        arguments = self._node.args.args
        stars = ["*" * (getattr(a.annotation, "id", "") == "ptr32") for a in arguments]
        given = ", ".join(f"int32_t {star}{a.arg}" for star, a in zip(stars, arguments))
        return (
            f"{'int32_t' if self._node.returns else 'void'} {self._file.name}_{self._name}({given})"
        )

    def text(self) -> str:
        """The function."""
        node = self._node
        names = [n for n in ast.walk(node) if isinstance(n, ast.Name)]
        stored = {n.id for n in names if isinstance(n.ctx, ast.Store)}
        own = sorted(stored - {a.arg for a in node.args.args})
        body = node.body[1 if ast.get_docstring(node) else 0 :]
        used = {n.id for n in names}
        lines = [f"    (void){arg.arg};" for arg in node.args.args if arg.arg not in used]
        lines += [f"    int32_t {local} = 0;" for local in own]
        lines += [line for statement in body for line in self._statement(statement, "    ")]
        return "\n".join([f"static {self.head()} {{", *lines, "}", ""])

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
        elif isinstance(node, ast.For):
            yield f"{indent}for ({self._counted(node)}) {{"
            yield from self._body(node.body, indent)
            yield f"{indent}}}"
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

    def _counted(self, node: ast.For) -> str:
        """The head of `for i in range([first,] end[, step])`; what `end` says stays so in it."""
        call = node.iter
        if (
            not (isinstance(call, ast.Call) and isinstance(node.target, ast.Name))
            or (getattr(call.func, "id", ""), len(call.args) in (1, 2, 3)) != ("range", True)
            or node.orelse
        ):
            raise self._write.refused(node)
        i = node.target.id
        numbers = [self._write.text(a) for a in call.args]
        first, end, step = (["0"] * (len(numbers) == 1) + numbers + ["1"])[:3]
        return f"{i} = {first}; {i} < {end}; {i} += {step}"

    def _body(self, statements: list[ast.stmt], indent: str) -> Iterator[str]:
        for statement in statements:
            yield from self._statement(statement, indent + "    ")
