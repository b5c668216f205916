"""Kernels as C: the text of which machine code, the library for hosts and the export are made."""

import ast
from collections.abc import Iterator

from .c_expressions import Expressions
from .reading import KernelFile, Kernels

_KINDS = {"int": "int32_t ", "ptr32": "int32_t *"}
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
    """Writes one kernel."""

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
        kinds = [_KINDS.get(getattr(a.annotation, "id", "int"), "int32_t ") for a in arguments]
        given = ", ".join(kind + a.arg for kind, a in zip(kinds, arguments))
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
