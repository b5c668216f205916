"""Imports go one way: no module and no package comes back to itself, on a board or on a host."""

import ast
import sys
from pathlib import Path

import pytest
from vulture import Vulture

from ..mutant_trials import REPOSITORY, InPlaceOf, ends
from ..mutants import AREAS, mutants
from .census import layouts, several

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


FIRMWARE = Path(__file__).resolve().parents[2] / "firmware" / "zerorate"


def written():
    """The firmware's files, generated ones apart."""
    return [p for p in FIRMWARE.rglob("*.py") if p.parent.name != "native"]


def test_a_constant_has_one_value_in_all_files():
    assert several(written()) == set()


def test_no_file_of_a_board_but_the_headers_of_stores_says_where_a_word_is():
    own = {"store.py", "differing.py"}
    assert {path.name for path in layouts(written())} == own


def test_a_second_value_is_found(tmp_path):
    for name, value in (("a.py", 1), ("b.py", 2)):
        (tmp_path / name).write_text(f"_X = const({value})\n")
    assert several(tmp_path.glob("*.py")) == {"_X"}


CODE = (
    "firmware/zerorate",
    "drivers/zerorate_i2c",
    "tools/zerorate_tools",
    "tools/zerorate_bench",
    "host_tests",
    "examples",
)
GENERATED = ("*/zerorate/native/*",)
#: Called by others: pytest, Python, its import, a template of the report, a program sent as text,
#: whoever uses the fakes as if they were the real bus.
CALLED_BY_OTHERS = {
    *("pytest_configure", "pytest_terminal_summary", "pytest_runtest_protocol"),
    *("pytest_sessionfinish", "pytest_collection_modifyitems"),
    *("busio_i2c", "polled", "impatient"),
    *("__getattr__", "__dir__", "handle_starttag", "handle_data"),
    *("_constant", "_subscript", "_binop", "_unaryop", "_boolop", "_ifexp"),
    *("how_sure", "found_in_short", "write_device", "make_folders", "put_in_place"),
    *("unlock", "enable_pec", "block_process_call", "get_code", "generate_launch_description"),
}


def test_every_function_and_class_is_used(repository):
    """One walk of all files, about 8 s of CPU time."""
    # what the decorator registers is called by its list
    vulture = Vulture(ignore_decorators=["@log"])
    vulture.scavenge([str(repository / folder) for folder in CODE], exclude=GENERATED)
    kinds = ("function", "method", "class", "property", "unreachable_code")
    unused = {
        i.name: f"{i.filename}:{i.first_lineno}"
        for i in vulture.get_unused_code()
        if i.typ in kinds
    }
    assert {n: where for n, where in unused.items() if n not in CALLED_BY_OTHERS} == {}
    assert unused, "it finds nothing at all"


GUARD = "firmware/zerorate/rest/guard.py"


def test_annotations_and_written_constants_have_no_mutants():
    found = mutants([GUARD])
    lines = (REPOSITORY / GUARD).read_text(encoding="utf-8").splitlines()
    drawn = {lines[row - 1] for _, _, _, row in found}
    assert "    repeats = exchange(s, x)" not in drawn and len(found) > 250
    assert not any("const(" in line and "_MOST_US" not in line for line in drawn)
    assert not any(line.startswith("def ") for line in drawn)


def test_every_file_and_every_test_of_an_area_is_there():
    named = [name for files, tests in AREAS.values() for name in (*files, *tests)]
    assert [name for name in named if not (REPOSITORY / name.partition("::")[0]).is_file()] == []


def test_a_mutant_stands_in_the_place_of_its_module(tmp_path, monkeypatch):
    (tmp_path / "mutated.py").write_text("VALUE = 1")
    monkeypatch.syspath_prepend(tmp_path)
    place = InPlaceOf(tmp_path / "mutated.py", "VALUE = 2")
    monkeypatch.setattr(sys, "meta_path", [place, *sys.meta_path])
    import mutated

    assert mutated.VALUE == 2
    monkeypatch.undo()
    del sys.modules["mutated"]


def test_mutants_of_functions_and_of_modules_are_told_from_those_that_live(tmp_path, monkeypatch):
    source = "LIMIT = 3\n\n\ndef below(n):\n    return n < LIMIT\n"
    (tmp_path / "limits.py").write_text(source)
    (tmp_path / "test_it.py").write_text(
        "from limits import below\n\ndef test_it():\n    assert below(1) and not below(4)\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    changes = [("<", "<=", 5), ("<", ">", 5), ("3", "2", 1), ("3", "0", 1)]
    drawn = {
        number: (str(tmp_path / "limits.py"), row, source.replace(before, after))
        for number, (before, after, row) in enumerate(changes)
    }
    found = ends([str(tmp_path)], drawn)
    assert [found[number] for number in range(4)] == ["passed", "killed", "passed", "killed"]
