"""Imports go one way, nothing is left unused, what is installed is pinned, pages read easily."""

import ast
import re
import sys
from pathlib import Path

import pytest
import textstat
from markdown_it import MarkdownIt
from packaging.requirements import Requirement
from vulture import Vulture

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

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


def test_firmware_and_drivers_import_neither_each_other_nor_the_tools(graph):
    for name, imported in graph.items():
        package = name.partition(".")[0]
        if package in ("zerorate", "zerorate_i2c"):
            assert {other.partition(".")[0] for other in imported} <= {package}, name


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
    *("pytest_configure", "pytest_terminal_summary", "pytest_runtestloop"),
    *("pytest_collection_modifyitems", "own_folder", "everything_in_time"),
    *("busio_i2c", "polled", "impatient"),
    *("__getattr__", "__dir__", "handle_starttag", "handle_data"),
    *("_constant", "_subscript", "_binop", "_unaryop", "_boolop", "_ifexp", "_call"),
    *("how_sure", "found_in_short", "write_device", "make_folders", "put_in_place"),
    *("unlock", "enable_pec", "block_process_call", "get_code", "generate_launch_description"),
}


def test_every_function_and_class_is_used(repository):
    """One walk of all files, about 8 s of CPU time."""
    # what a decorator registers is called by its list
    vulture = Vulture(ignore_decorators=["@command"])
    vulture.scavenge([str(repository / folder) for folder in CODE], exclude=GENERATED)
    kinds = ("function", "method", "class", "property", "unreachable_code")
    unused = {
        i.name: f"{i.filename}:{i.first_lineno}"
        for i in vulture.get_unused_code()
        if i.typ in kinds
    }
    assert {n: where for n, where in unused.items() if n not in CALLED_BY_OTHERS} == {}
    assert unused, "it finds nothing at all"


def pins(path):
    """Name -> its pins, one for each marker."""
    lines = path.read_text(encoding="utf-8").splitlines()
    pinned = {}
    for line in lines:
        if line and not line.lstrip().startswith("#"):
            requirement = Requirement(line)
            pinned.setdefault(requirement.name, set()).add(line)
    return pinned


@pytest.fixture
def requirements(repository):
    return repository / "requirements"


@pytest.fixture
def extras(repository):
    project = tomllib.loads((repository / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    return {
        extra: [Requirement(line) for line in lines]
        for extra, lines in project["optional-dependencies"].items()
    }


@pytest.mark.parametrize("lock", ["tools.txt", "dev.txt", "node.txt"])
def test_every_line_of_a_lock_is_an_exact_pin(requirements, lock):
    pinned = pins(requirements / lock)
    assert pinned
    for line in (line for lines in pinned.values() for line in lines):
        assert re.match(r"[a-z0-9.-]+==[^ *]+( ;|$)", line)


def test_no_lock_names_a_host(repository):
    locks = [*repository.glob("requirements/*"), *repository.rglob("tools/**/package-lock.json")]
    assert len(locks) > 4
    assert [lock.name for lock in locks if "://" in lock.read_text(encoding="utf-8")] == []


def test_the_two_locks_agree(requirements):
    tools, dev = pins(requirements / "tools.txt"), pins(requirements / "dev.txt")
    differing = [name for name in tools.keys() & dev.keys() if tools[name] != dev[name]]
    assert differing == []


@pytest.mark.parametrize("extra", ["tools", "linux", "fleet", "bench", "dev"])
def test_every_need_is_locked_in_a_version_that_satisfies_it(requirements, extras, extra):
    locked = pins(requirements / ("tools.txt" if extra == "tools" else "dev.txt"))
    for need in extras[extra]:
        assert need.name in locked, f"`make lock` adds {need.name}"
        versions = [line.split("==")[1].split(" ")[0] for line in locked[need.name]]
        assert all(need.specifier.contains(version) for version in versions), need


#: Beside those of docs.
PAGES = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md")
#: Tables and lists of names.
_NO_PROSE = {"api.md", "glossary.md", "layout.md"}
MOST_WORDS_A_SENTENCE = 16
LEAST_READING_EASE = 55  # Flesch: 50 to 60 is "fairly difficult", 60 to 70 "plain English"

_NOT_PROSE = ("heading", "th", "td")


def pages(root):
    """Every page that is read as prose, below the folder `root`."""
    docs = sorted(p.relative_to(root).as_posix() for p in (root / "docs").glob("*.md"))
    names = (page for page in docs if Path(page).name not in _NO_PROSE and "figures" not in page)
    return [*PAGES, *names]


def prose(markdown):
    """The sentences of a page, one paragraph or list item a line.

    Headings, tables, code blocks and pictures are left out. A piece of code in a sentence counts as
    one short word. A full stop inside a word or a number is no end of a sentence.
    """
    lines, inside = [], ""
    for token in MarkdownIt().enable("table").parse(markdown):
        if token.type == "inline" and inside not in _NOT_PROSE:
            lines.append("".join(map(_text, token.children)))
        inside = token.type.removesuffix("_open") if token.nesting == 1 else ""
    ended = (re.sub(r"(?<=\w)\.(?=\w)", "", line).rstrip(" :;,") for line in lines)
    return "\n".join(line if line[-1] in ".!?)" else f"{line}." for line in ended if line)


def _text(token):
    """What a reader sees of a part of a line."""
    return {"text": token.content, "code_inline": "code", "softbreak": " "}.get(token.type, "")


def readability(markdown):
    """(mean words a sentence, Flesch reading ease) of a page's prose."""
    text = prose(markdown)
    return textstat.words_per_sentence(text), textstat.flesch_reading_ease(text)


def test_every_page_reads_easily(repository):
    found = {p: readability((repository / p).read_text("utf-8")) for p in pages(repository)}
    assert len(found) > 25
    hard = {
        page: (words, ease)
        for page, (words, ease) in found.items()
        if words > MOST_WORDS_A_SENTENCE or ease < LEAST_READING_EASE
    }
    assert hard == {}
