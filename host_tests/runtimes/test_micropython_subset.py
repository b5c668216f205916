"""What runs on a board uses only what a bare MicroPython has, and constants that fold there."""

import ast

import pytest

ABSENT_MODULES = {"typing", "dataclasses", "enum", "abc", "functools", "contextlib", "__future__"}
ABSENT_NAMES = {"bit_length", "cast", "__set_name__", "__init_subclass__"}


def breaches(tree):
    """Row and what for everything in a file that a board does not have."""
    plain = plain_names(tree)
    for node in walked(tree):
        found = [*imports(node), *attributes(node, plain), *syntax(node)]
        yield from ((getattr(node, "lineno", 0), what) for what in found)


def walked(tree):
    """Every node but those under `if TYPE_CHECKING:`, which no board runs."""
    left = [tree]
    while left:
        node = left.pop()
        yield node
        never = isinstance(node, ast.If) and getattr(node.test, "id", "") == "TYPE_CHECKING"
        left += node.orelse if never else ast.iter_child_nodes(node)


def imports(node):
    if isinstance(node, ast.ImportFrom):
        modules = [node.module or ""]
        folded = [alias.name for alias in node.names if is_folded(alias.name)]
        yield from (f"{name} is folded away where it is defined" for name in folded)
    else:
        modules = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
    yield from (f"{name} is absent" for name in modules if name.split(".")[0] in ABSENT_MODULES)


def attributes(node, plain):
    name = node.attr if isinstance(node, ast.Attribute) else getattr(node, "name", "")
    if name in ABSENT_NAMES:
        yield f"{name} is absent"
    if isinstance(node, ast.Attribute) and is_folded(node.attr) and node.attr not in plain:
        yield f"{node.attr} as an attribute: const(_X) leaves none on a board"
    if isinstance(node, ast.Call) and getattr(node.func, "attr", "") == "from_bytes":
        if any(keyword.arg == "signed" for keyword in node.keywords):
            yield "from_bytes has no signed"


def plain_names(tree):
    """Names that are given a value other than const(...), which stay on a board."""
    assignments = [node for node in ast.walk(tree) if isinstance(node, ast.Assign)]
    plain = [a for a in assignments if getattr(getattr(a.value, "func", None), "id", "") != "const"]
    return {target.id for a in plain for target in a.targets if isinstance(target, ast.Name)}


def syntax(node):
    if isinstance(node, ast.Match):
        yield "match is a SyntaxError"
    if isinstance(node, ast.arguments) and node.posonlyargs:
        yield "positional-only parameters are a SyntaxError"


def is_folded(name):
    return name.startswith("_") and not name.startswith("__") and name == name.upper() != "_"


def board_files(repository):
    firmware = (repository / "firmware").rglob("*.py")
    drivers = (repository / "drivers").rglob("*.py")
    # linux.py runs on a Linux board, under CPython.
    return sorted({*firmware, *drivers} - set(repository.glob("drivers/*/linux.py")))


@pytest.mark.parametrize(
    "text",
    [
        "class A:\n    _ERASE = 6\n    def f(self):\n        return self._ERASE",
        "TYPE_CHECKING = False\nif TYPE_CHECKING:\n    from typing import Any",
    ],
)
def test_what_a_board_has_or_never_runs_is_no_breach(text):
    assert list(breaches(ast.parse(text))) == []


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("import typing", "typing is absent"),
        ("from dataclasses import field", "dataclasses is absent"),
        ("from .parts import _WHO_AM_I", "folded away"),
        ("_ID = const(1)\nclass A:\n    def f(self):\n        return self._ID", "leaves none"),
        ("class A:\n    _ID = const(1)\n    def f(self):\n        return self._ID", "leaves none"),
        ("x = (5).bit_length()", "bit_length is absent"),
        ("class A:\n    def __set_name__(self, a, b):\n        pass", "__set_name__ is absent"),
        ("int.from_bytes(b'1', 'big', signed=True)", "no signed"),
        ("match x:\n    case 1:\n        pass", "match"),
        ("def f(a, /):\n    pass", "positional-only"),
    ],
)
def test_each_breach_is_found(text, what):
    assert any(what in found for _, found in breaches(ast.parse(text)))


def test_firmware_and_drivers_have_no_breach(repository):
    files = board_files(repository)
    assert {"zerorate", "zerorate_i2c"} <= {file.parent.name for file in files}
    found = [
        f"{file.relative_to(repository)}:{row}: {what}"
        for file in files
        for row, what in breaches(ast.parse(file.read_text(encoding="utf-8"), str(file)))
    ]
    assert found == []


def test_firmware_and_drivers_do_not_import_each_other(repository):
    for folder, other in (("firmware", "zerorate_i2c"), ("drivers", "zerorate")):
        files = sorted((repository / folder).rglob("*.py"))
        assert files
        trees = [ast.parse(file.read_text(encoding="utf-8")) for file in files]
        nodes = [node for tree in trees for node in ast.walk(tree)]
        modules = {n.module for n in nodes if isinstance(n, ast.ImportFrom) and not n.level}
        modules |= {a.name for n in nodes if isinstance(n, ast.Import) for a in n.names}
        assert other not in {(module or "").split(".")[0] for module in modules}
