"""Words at `array[at + 3]` through a pointer to `array[at]`, made once for each value of `at`.

In viper an index that is not a constant is worked out at every use, in some eight instructions.
"""

from __future__ import annotations

import ast
import copy
from collections import Counter

from .inlining import assigned, is_stored, kinds

# uses of a pointer that make up for making it once
_WORTH = 2
_SHIFTS = {"ptr8": 0, "ptr32": 2}

Pair = tuple[str, str]


def with_pointers(function: ast.FunctionDef) -> ast.FunctionDef:
    """The function with such a pointer, `array_at`, wherever it is used often enough."""
    made = copy.deepcopy(function)
    arrays = {name: kind for name, kind in kinds(made).items() if kind in _SHIFTS}
    uses = Counter(pair for n in ast.walk(made) if (pair := _based(n, arrays)))
    stores = Counter(n.id for n in ast.walk(made) if is_stored(n))  # type: ignore[attr-defined]
    stores.update(a.arg for a in made.args.args)
    chosen = {p for p, count in uses.items() if count >= _WORTH * stores[p[1]] and stores[p[1]]}
    if not chosen:
        return made
    put = _Put(chosen, arrays)
    first = [s for a in made.args.args for s in put.pointers(a.arg)]
    made.body = [*first, *put.block(made.body)]
    return made


def _based(node: ast.AST, arrays) -> Pair | None:
    """(array, at) of an index that is a local, or a local and a number."""
    if not isinstance(node, ast.Subscript) or not isinstance(node.value, ast.Name):
        return None
    index = node.slice
    if isinstance(index, ast.BinOp) and isinstance(index.op, ast.Add):
        if not isinstance(index.right, ast.Constant):
            return None
        index = index.left
    if node.value.id in arrays and isinstance(index, ast.Name):
        return node.value.id, index.id
    return None


class _Put:
    def __init__(self, chosen: set[Pair], arrays: dict[str, str]) -> None:
        self._chosen, self._arrays = chosen, arrays

    def pointers(self, at: str) -> list[ast.stmt]:
        """The statements that make the pointers behind a new value of `at`."""
        made: list[ast.stmt] = []
        for array, name in sorted(self._chosen):
            if name == at:
                kind = self._arrays[array]
                by = f"({at} << {_SHIFTS[kind]})" if _SHIFTS[kind] else at
                value = ast.parse(f"{kind}(int({array}) + {by})", mode="eval").body
                made.append(assigned(f"{array}_{at}", value))
        return made

    def _moved(self, at: str, by: int) -> list[ast.stmt]:
        """The statements that move the pointers on with `at`."""
        made: list[ast.stmt] = []
        for array, name in sorted(self._chosen):
            if name == at:
                kind = self._arrays[array]
                to = f"{kind}(int({array}_{at}) + {by << _SHIFTS[kind]})"
                made.append(assigned(f"{array}_{at}", ast.parse(to, mode="eval").body))
        return made

    def block(self, statements: list[ast.stmt]) -> list[ast.stmt]:
        made: list[ast.stmt] = []
        for node in statements:
            if isinstance(node, (ast.If, ast.While, ast.For)):
                made.append(self._compound(node))
                continue
            node = self._used(node)
            made += [node, *self._behind(node)]
        return made

    def _behind(self, node: ast.stmt | ast.expr) -> list[ast.stmt]:
        if isinstance(node, ast.AugAssign) and isinstance(node.target, ast.Name):
            if isinstance(node.op, ast.Add) and isinstance(node.value, ast.Constant):
                return self._moved(node.target.id, node.value.value)  # type: ignore[arg-type]
        stored = [n.id for n in ast.walk(node) if is_stored(n)]  # type: ignore[attr-defined]
        return [pointer for name in stored for pointer in self.pointers(name)]

    def _compound(self, node: ast.If | ast.While | ast.For) -> ast.stmt:
        node.body, node.orelse = self.block(node.body), self.block(node.orelse)
        if isinstance(node, ast.For):
            node.iter = self._used(node.iter)
            node.body = [*self._behind(node.target), *node.body]
        else:
            node.test = self._used(node.test)
        return node

    def _used(self, node):
        chosen, arrays = self._chosen, self._arrays

        class Use(ast.NodeTransformer):
            def visit_Subscript(self, found: ast.Subscript) -> ast.expr:
                pair = _based(found, arrays)
                if pair not in chosen or pair is None:
                    return self.generic_visit(found)  # type: ignore[return-value]
                right = getattr(found.slice, "right", ast.Constant(0))
                return ast.Subscript(ast.Name("_".join(pair), ast.Load()), right, found.ctx)

        return Use().visit(node)
