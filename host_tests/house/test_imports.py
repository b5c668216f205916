"""Imports go one way: no module and no package comes back to itself, on a board or on a host."""

import ast
from pathlib import Path

import pytest

_PACKAGES = {
    "zerorate_tools": "tools",
    "zerorate_bench": "tools",
    "zerorate": "firmware",
    "zerorate_i2c": "drivers",
}


def modules_of(root):
    """Name -> file of every module of the project, except the `__main__` that nothing imports."""
    found = {}
    for package, folder in _PACKAGES.items():
        for path in sorted((root / folder / package).rglob("*.py")):
            parts = path.relative_to(root / folder).with_suffix("").parts
            if parts[-1] != "__main__":
                found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def imports_of(name, path, modules):
    """The modules that a module names in imports: at its head, in functions, for type checkers."""
    package = name if path.name == "__init__.py" else name.rpartition(".")[0]
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom):
            above = package.split(".")[: len(package.split(".")) + 1 - node.level]
            base = ".".join([*above * bool(node.level), *filter(None, [node.module])])
            for alias in node.names:
                whole = f"{base}.{alias.name}"
                yield whole if whole in modules else base
        elif isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)


def graph_of(root):
    """Module -> the modules of the project that it imports."""
    modules = modules_of(root)
    return {n: set(imports_of(n, p, modules)) & set(modules) - {n} for n, p in modules.items()}


def of_tools(graph):
    """The tools alone: firmware's `native` has machine code of all folders, and they ask it."""
    return {name: imported for name, imported in graph.items() if name.startswith("zerorate_tools")}


def by_package(graph):
    """The same between the folders below each package; the packages themselves are left out."""
    found = {}
    for name, imported in graph.items():
        own = package_of(name)
        others = {package_of(other) for other in imported} - {own, *_PACKAGES}
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
    return graph_of(Path(__file__).resolve().parents[2])


def test_the_whole_project_is_looked_at(graph):
    assert {name.partition(".")[0] for name in graph} == set(_PACKAGES)
    assert len(graph) > 250 and sum(map(len, graph.values())) > 600


def test_no_module_comes_back_to_itself(graph):
    assert circles(graph) == set()


def test_no_package_of_the_tools_comes_back_to_itself(graph):
    assert circles(by_package(of_tools(graph))) == set()


def test_a_circle_is_found():
    assert circles({"a": {"b"}, "b": {"c"}, "c": {"a"}, "d": {"a"}}) == {frozenset("abc")}


@pytest.mark.parametrize(
    "back",
    [
        "from .one import f",
        "def g():\n    from .one import f",
        "if TYPE_CHECKING:\n    from .one import f",
        "def g():\n    import zerorate.one",
    ],
)
def test_a_circle_is_found_wherever_the_import_hides(tmp_path, back):
    folder = tmp_path / "firmware" / "zerorate"
    folder.mkdir(parents=True)
    (folder / "one.py").write_text("from . import two\n")
    (folder / "two.py").write_text(back + "\n")
    assert circles(graph_of(tmp_path)) == {frozenset({"zerorate.one", "zerorate.two"})}
