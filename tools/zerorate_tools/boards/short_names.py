"""What boards get, with private names made short: MicroPython keeps each name in its heap for good.

Short are names that begin with `_`, what modules have that only the packages import, and parameters
of both. What a program may call or name stays. Numbers of other modules stand for their names.
"""

import ast
from collections.abc import Iterable, Iterator
from functools import cache
from itertools import chain, product
from pathlib import Path
from string import ascii_letters

from .parts import PARTS, part_files

# Modules that no program imports: most are let go as soon as an object is made.
_INNER = frozenset(
    "making settings trying identity parts bus_recovery machine_code crc32 plain_crc32 soundness "
    "explain explain_sources differing ratio data_registers bias block copying estimators fit "
    "fixed histogram recent stillness".split()
)
# Modules that are read once and let go: what they call the words of a user is to go with them.
_LET_GO = ("settings",)
_WORDS = "_words"
# A string that is no longer becomes a name that MicroPython keeps.
_LONGEST_KEPT = 10
# Names that every MicroPython has in its own tables: as parameters they cost nothing.
_PARAMETERS = (
    *("key", "value", "index", "items", "args", "sep", "id", "main", "keys", "values", "lower"),
    *("upper", "little", "bytecode", "strip", "split", "join", "find", "replace", "remove"),
)
# What every MicroPython has: nothing stands in for it there.
_ON_EVERY_BOARD = frozenset(("time", "uarray", "utime"))
# The fields in which a node holds a name.
_FIELDS: dict[type, tuple[str, ...]] = {
    ast.Name: ("id",),
    ast.Attribute: ("attr",),
    ast.arg: ("arg",),
    ast.keyword: ("arg",),
    ast.FunctionDef: ("name",),
    ast.ClassDef: ("name",),
    ast.alias: ("name", "asname"),
}


def shortened(path: Path, text: str) -> str:
    """The text of a module of the packages with its private names short, for a compiler to read."""
    tree = ast.parse(text)
    tree.body = [*chain.from_iterable(map(_without_stand_in, tree.body))]
    _put_in_constants(tree, path)
    own = {name for node in ast.walk(tree) for name in _identifiers(node)}
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef) and _is_inner(node.name, path):
            _rename(node, _parameters(node, own), ast.Name, ast.arg)
    _rename(tree, short_names())
    if path.stem in _LET_GO:
        _set_words_apart(tree)
    return ast.unparse(tree)


@cache
def short_names() -> dict[str, str]:
    """Private name -> short one; two that meet in one file, or in one object, differ."""
    trees = _trees()
    nodes = {path: [*ast.walk(tree)] for path, tree in trees.items()}
    everything = [*chain(*nodes.values())]
    wanted = {name for node in everything for name in _defined(node) if _is_private(name)}
    wanted |= {name for path, tree in trees.items() for name in _inner_names(path, tree)}
    wanted -= _fixed(everything) | {path.stem for path in trees}
    meets = _meeting_places(nodes)
    words = (f"_{''.join(w)}" for size in (1, 2) for w in product(ascii_letters, repeat=size))
    taken: dict[str, set[str]] = {word: set() for word in words if word not in meets}
    found = {}
    for name in sorted(wanted, key=lambda name: (-len(meets[name]), name)):
        found[name] = next(word for word in taken if not taken[word] & meets[name])
        taken[found[name]] |= meets[name]
    return found


@cache
def _trees() -> dict[Path, ast.Module]:
    return {path: ast.parse(path.read_text("utf-8")) for path in part_files(PARTS).values()}


def _without_stand_in(node: ast.stmt) -> list[ast.stmt]:
    """An import that is tried, where a board has what is imported, or else the node itself."""
    if isinstance(node, ast.Try):
        (tried,) = node.body
        if ast.unparse(tried).split()[1] in _ON_EVERY_BOARD:
            return [tried]
    return [node]


def _put_in_constants(tree: ast.Module, path: Path) -> None:
    """Numbers in the place of other modules' names for them, which need no import then."""
    values: dict[str, int] = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.level:
            there = _constants().get(_imported(path, node), {})
            values |= {alias.name: there[alias.name] for alias in node.names if alias.name in there}
            node.names = [alias for alias in node.names if alias.name not in there]
    _PutIn(values).visit(tree)


def _set_words_apart(tree: ast.Module) -> None:
    """Short strings as parts of one long one: MicroPython keeps each short string for good."""
    apart = _Apart()
    tree.body[1:] = [apart.visit(node) for node in tree.body[1:]]
    text = ast.Constant(" ".join(apart.words))
    split = ast.Call(ast.Attribute(text, "split", ast.Load()), [], [])
    tree.body.insert(1, ast.Assign([ast.Name(_WORDS, ast.Store())], split, lineno=0))
    ast.fix_missing_locations(tree)


class _Apart(ast.NodeTransformer):
    def __init__(self) -> None:
        self.words: list[str] = []

    def visit_Constant(self, node: ast.Constant) -> ast.expr:
        word = node.value
        if not isinstance(word, str) or not word.isidentifier() or len(word) > _LONGEST_KEPT:
            return node
        if word not in self.words:
            self.words.append(word)
        place = ast.Constant(self.words.index(word))
        return ast.Subscript(ast.Name(_WORDS, ast.Load()), place, ast.Load())


class _PutIn(ast.NodeTransformer):
    def __init__(self, values: dict[str, int]) -> None:
        self._values = values

    def visit_Name(self, node: ast.Name) -> ast.expr:
        return ast.Constant(self._values[node.id]) if node.id in self._values else node

    def visit_ImportFrom(self, node: ast.ImportFrom) -> ast.ImportFrom | None:
        return node if node.names else None


def _imported(path: Path, node: ast.ImportFrom) -> Path:
    return path.parents[node.level - 1].joinpath(*(node.module or "").split(".")).with_suffix(".py")


@cache
def _constants() -> dict[Path, dict[str, int]]:
    """File -> the numbers that it has by public names."""
    return {
        path: {
            name: value
            for node in tree.body
            for name, value in _const(node)
            if not name.startswith("_")
        }
        for path, tree in _trees().items()
    }


def _const(node: ast.AST) -> Iterator[tuple[str, int]]:
    """Name and value of `NAME = const(value)`."""
    if isinstance(node, ast.Assign) and isinstance(node.value, ast.Call):
        if _identifiers(node.value.func) == ["const"]:
            [[name]], [value] = map(_identifiers, node.targets), node.value.args
            yield name, ast.literal_eval(value)


def _is_private(name: str) -> bool:
    return name.startswith("_") and not name.endswith("__")


def _is_inner(function: str, path: Path) -> bool:
    return _is_private(function) or path.stem in _INNER or path.parent.name == "native"


def _inner_names(path: Path, tree: ast.Module) -> Iterator[str]:
    """Functions and constants of a module that no program imports."""
    for node in tree.body if path.stem in _INNER else ():
        if isinstance(node, ast.FunctionDef):
            yield node.name
        elif isinstance(node, ast.Assign):
            yield from filter(str.isupper, chain(*map(_identifiers, node.targets)))


def _fixed(nodes: Iterable[ast.AST]) -> set[str]:
    """Names that stay: what mpy-cross folds away, what is in a string, public attributes."""
    fixed = {"const", "TYPE_CHECKING"}
    for node in nodes:
        fixed |= {name for name, _ in _const(node) if _is_private(name)}
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            fixed.add(node.value)
        elif isinstance(node, ast.Attribute | ast.keyword | ast.arg):
            fixed |= {name for name in _identifiers(node) if not _is_private(name)}
    return fixed


def _meeting_places(nodes: dict[Path, list[ast.AST]]) -> dict[str, set[str]]:
    """Name -> the files where it is, a class' file being one with that of the class it is of."""
    places = {path: str(path) for path in nodes}
    classes = [(n, path) for path, some in nodes.items() for n in some if type(n) is ast.ClassDef]
    files = {node.name: path for node, path in classes}
    for node, path in classes:
        for base in chain(*map(_identifiers, node.bases)):
            places[path] = places[files.get(base, path)]
    meets: dict[str, set[str]] = {}
    for path, some in nodes.items():
        for n in some:
            # what is another object's meets whatever that object has
            of_another = isinstance(n, ast.Attribute) and _identifiers(n.value) != ["self"]
            for name in _identifiers(n):
                here = places.values() if of_another else [places[path]]
                meets.setdefault(name, set()).update(here)
    return meets


def _parameters(function: ast.FunctionDef, own: set[str]) -> dict[str, str]:
    """Parameter -> a name that is not in the file, of those that no call names."""
    given = _given_by_name()
    names = [arg.arg for arg in function.args.args if arg.arg != "self"]
    free = (name for name in _PARAMETERS if name not in own)
    return dict(zip((name for name in names if (function.name, name) not in given), free))


@cache
def _given_by_name() -> frozenset[tuple[str, str]]:
    """(function, parameter) of the calls that name a parameter."""
    nodes = chain(*map(ast.walk, _trees().values()))
    return frozenset(
        (name, keyword.arg)
        for node in nodes
        if isinstance(node, ast.Call)
        for name in _identifiers(node.func)
        for keyword in node.keywords
        if keyword.arg
    )


def _identifiers(node: ast.AST) -> list[str]:
    names = [getattr(node, field) for field in _FIELDS.get(type(node), ())]
    return [name for name in names if name]


def _defined(node: ast.AST) -> list[str]:
    is_read = isinstance(getattr(node, "ctx", None), ast.Load) or isinstance(node, ast.keyword)
    return [] if is_read else _identifiers(node)


def _rename(tree: ast.AST, names: dict[str, str], *kinds: type) -> None:
    for node in ast.walk(tree):
        for field in _FIELDS.get(type(node), ()):
            if not kinds or isinstance(node, kinds):
                name = getattr(node, field)
                setattr(node, field, names.get(name, name))
