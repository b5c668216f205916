"""Imports go one way: no module and no package of the tools comes back to itself."""

import ast
from pathlib import Path

import pytest

_PACKAGE = "zerorate_tools"


def modules_of(root):
    """Name -> file of every module below a folder, except the `__main__` that nothing imports."""
    found = {}
    for path in sorted((root / _PACKAGE).rglob("*.py")):
        parts = path.relative_to(root).with_suffix("").parts
        if parts[-1] != "__main__":
            found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def imports_of(name, path, modules):
    """The modules that a module imports at any time; what only a type checker reads is left out."""
    package = name if path.name == "__init__.py" else name.rpartition(".")[0]
    tree = ast.parse(path.read_text(encoding="utf-8"))
    for block in [n for n in ast.walk(tree) if isinstance(n, ast.If)]:
        if "TYPE_CHECKING" in ast.unparse(block.test):
            block.body = []
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom):
            above = package.split(".")[: len(package.split(".")) + 1 - node.level]
            base = ".".join([*above * bool(node.level), *filter(None, [node.module])])
            for alias in node.names:
                whole = f"{base}.{alias.name}"
                yield whole if whole in modules else base
        elif isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)


def graph_of(root):
    """Module -> the modules of the tools that it imports."""
    modules = modules_of(root)
    found = {n: set(imports_of(n, p, modules)) & set(modules) - {n} for n, p in modules.items()}
    assert len(found) > 200 and sum(map(len, found.values())) > 500
    return found


def by_package(graph):
    """The same between packages, the folders below the tools; the package itself is left out."""
    found = {}
    for name, imported in graph.items():
        own = package_of(name)
        others = {package_of(other) for other in imported} - {own, _PACKAGE}
        found.setdefault(own, set()).update(others)
    return found


def package_of(name):
    """The folder of a module, or the module itself where it stands in none."""
    return ".".join(name.split(".")[:2])


def circles(graph):
    """Each set of nodes from every one of which every other is reached, if it is more than one."""
    reached = {node: reachable(graph, node) for node in graph}
    return {
        frozenset(other for other in reached[node] if node in reached.get(other, ()))
        for node in graph
        if node in reached[node]
    }


def reachable(graph, start):
    """What is reached from a node in one step or more."""
    found, waiting = set(), [start]
    while waiting:
        new = graph.get(waiting.pop(), set()) - found
        found |= new
        waiting += new
    return found


@pytest.fixture(scope="module")
def graph():
    return graph_of(Path(__file__).resolve().parents[2] / "tools")


def test_no_module_comes_back_to_itself(graph):
    assert circles(graph) == set()


def test_no_package_comes_back_to_itself(graph):
    assert circles(by_package(graph)) == set()


def test_a_circle_is_found():
    assert circles({"a": {"b"}, "b": {"c"}, "c": {"a"}, "d": {"a"}}) == {frozenset("abc")}
