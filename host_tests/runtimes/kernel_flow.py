"""The ways through a kernel: does each end with return, is each local set before it is read?

C checks neither and goes on with 0, or with whatever the register held.
"""

import ast
from collections.abc import Iterator, Sequence


def always_returns(statements: Sequence[ast.stmt]) -> bool:
    """Does every way through the statements end with return?"""
    last = statements[-1]
    if isinstance(last, ast.If):
        return bool(last.orelse) and always_returns(last.body) and always_returns(last.orelse)
    if isinstance(last, ast.While):
        return _is_endless(last) and not any(isinstance(n, ast.Break) for n in ast.walk(last))
    return isinstance(last, ast.Return)


def read_before_set(
    function: ast.FunctionDef, statements: Sequence[ast.stmt]
) -> Iterator[tuple[int, str]]:
    """Row and text for each local that some way reads before it sets it."""
    nodes = [node for statement in statements for node in ast.walk(statement)]
    stored = {n.id for n in nodes if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)}
    flow = _Flow(stored)
    flow.through(statements, {a.arg for a in function.args.args})
    for row, name in sorted(flow.early):
        yield row, f"{name} is read before it is set on some path"


def _is_endless(loop: ast.While) -> bool:
    return isinstance(loop.test, ast.Constant) and bool(loop.test.value)


class _Flow:
    """Follows which locals are set; a state is the set of their names, None where no way leads."""

    def __init__(self, local_names: set[str]) -> None:
        self.local_names = local_names
        self.early: set[tuple[int, str]] = set()
        self.at_breaks: list[set[str] | None] = []

    def through(self, statements: Sequence[ast.stmt], known: set[str] | None) -> set[str] | None:
        for statement in statements:
            if known is None:
                return None
            known = self.past(statement, known)
        return known

    def past(self, statement: ast.stmt, known: set[str]) -> set[str] | None:
        if isinstance(statement, ast.If):
            self.read(statement.test, known)
            yes = self.through(statement.body, known)
            return _both(yes, self.through(statement.orelse, known))
        if isinstance(statement, ast.While):
            return self.loop(statement, known)
        if isinstance(statement, ast.For):
            return self.counted(statement, known)
        self.read(statement, known)
        if isinstance(statement, ast.Break):
            self.at_breaks[-1] = _both(self.at_breaks[-1], known)
        if isinstance(statement, (ast.Break, ast.Continue, ast.Return)):
            return None
        return known | _set_in(statement)

    def loop(self, loop: ast.While, known: set[str]) -> set[str] | None:
        self.read(loop.test, known)
        self.at_breaks.append(None)
        self.through(loop.body, known)
        run_out = None if _is_endless(loop) else known
        return _both(self.at_breaks.pop(), self.through(loop.orelse, run_out))

    def counted(self, loop: ast.For, known: set[str]) -> set[str] | None:
        """Behind it the counter is another in C: it counts as not set."""
        self.read(loop.iter, known)
        counter = _set_in(loop.target)
        self.at_breaks.append(None)
        self.through(loop.body, known | counter)
        return _both(self.at_breaks.pop(), known) - counter

    def read(self, node: ast.AST, known: set[str]) -> None:
        for name in ast.walk(node):
            if isinstance(name, ast.Name) and name.id in self.local_names - known:
                if isinstance(name.ctx, ast.Load) or _is_augmented(node, name):
                    self.early.add((name.lineno, name.id))


def _both(one: set[str] | None, other: set[str] | None) -> set[str] | None:
    if one is None or other is None:
        return other if one is None else one
    return one & other


def _is_augmented(node: ast.AST, name: ast.Name) -> bool:
    return isinstance(node, ast.AugAssign) and node.target is name


def _set_in(node: ast.AST) -> set[str]:
    names = (n for n in ast.walk(node) if isinstance(n, ast.Name))
    return {n.id for n in names if isinstance(n.ctx, ast.Store)}
