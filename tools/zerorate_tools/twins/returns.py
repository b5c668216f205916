"""A function's body as statements within another function: each return becomes a way to its end."""

from __future__ import annotations

import ast
from collections.abc import Callable

from ..kernel_flow import always_returns

Deliver = Callable[[ast.expr | None], list[ast.stmt]]


def without_returns(body: list[ast.stmt], deliver: Deliver, flag: str) -> list[ast.stmt]:
    """The statements without return; `deliver` makes of each value the statements that keep it.

    flag: name of a local, free to use, for returns out of a loop.
    """
    if any(_loop_returns(statement) for statement in body):
        return [_once(_by_break(body, deliver, flag, inside=False))]
    return _by_branches(body, deliver)


def _returns(node: ast.stmt) -> bool:
    return any(isinstance(n, ast.Return) for n in ast.walk(node))


def _loop_returns(node: ast.stmt) -> bool:
    loops = [n for n in ast.walk(node) if isinstance(n, (ast.While, ast.For))]
    return any(_returns(loop) for loop in loops) or _may_go_on(node)


def _may_go_on(node: ast.stmt) -> bool:
    """Does an if within return on some ways through a branch and go on on others?"""
    ifs = [n for n in ast.walk(node) if isinstance(n, ast.If) and _returns(n)]
    return any(not _decided(branch) for n in ifs for branch in (n.body, n.orelse))


def _decided(branch: list[ast.stmt]) -> bool:
    return always_returns(branch) if branch and any(map(_returns, branch)) else True


def _by_branches(body: list[ast.stmt], deliver: Deliver) -> list[ast.stmt]:
    made: list[ast.stmt] = []
    for at, statement in enumerate(body):
        if isinstance(statement, ast.Return):
            return made + deliver(statement.value)
        if isinstance(statement, ast.If) and _returns(statement):
            rest = body[at + 1 :]
            yes, no = statement.body, statement.orelse
            if always_returns(yes):
                no = [*no, *rest]
            elif always_returns(no):
                yes = [*yes, *rest]
            made.append(_if(statement.test, _by_branches(yes, deliver), _by_branches(no, deliver)))
            return made
        made.append(statement)
    return made


def _if(test: ast.expr, yes: list[ast.stmt], no: list[ast.stmt]) -> ast.stmt:
    return ast.If(test, yes or [ast.Pass()], no)


def _once(body: list[ast.stmt]) -> ast.While:
    return ast.While(ast.Constant(True), [*body, ast.Break()], [])


def _by_break(body, deliver: Deliver, flag: str, inside: bool) -> list[ast.stmt]:
    made: list[ast.stmt] = []
    for statement in body:
        if isinstance(statement, ast.Return):
            leave = [_set(flag, 1)] if inside else []
            return [*made, *deliver(statement.value), *leave, ast.Break()]
        if isinstance(statement, ast.If):
            yes = _by_break(statement.body, deliver, flag, inside)
            made.append(
                _if(statement.test, yes, _by_break(statement.orelse, deliver, flag, inside))
            )
        elif isinstance(statement, (ast.While, ast.For)) and _returns(statement):
            statement.body = _by_break(statement.body, deliver, flag, inside=True)
            made += [_set(flag, 0), statement]
            made.append(ast.If(ast.Name(flag, ast.Load()), [ast.Break()], []))
        else:
            made.append(statement)
    return made


def _set(name: str, value: int) -> ast.stmt:
    return ast.Assign([ast.Name(name, ast.Store())], ast.Constant(value))
