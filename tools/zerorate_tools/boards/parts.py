"""Which files of the packages a board needs, found by following their imports from a few roots."""

import ast
import json
from collections.abc import Iterable, Iterator
from functools import cache
from importlib.resources import files
from importlib.util import find_spec
from itertools import accumulate, chain
from pathlib import Path, PurePosixPath

from ..errors import ZerorateError

PACKAGES = ("zerorate", "zerorate_i2c")
REST = "rest"
#: Part -> the modules that a program imports for it; all else follows. `rest` is in every choice.
PARTS = {
    REST: (
        *("zerorate", "zerorate.checked", "zerorate.explain", "zerorate.storage.learned_store"),
        *("zerorate.storage.save_schedule", "zerorate.storage.places"),
        *("zerorate.storage.block_device", "zerorate_i2c.board", "zerorate_i2c.data_ready"),
        "zerorate_i2c.fifo",
    ),
    "motion": (
        *("zerorate.motion", "zerorate.others", "zerorate.native.motion"),
        *("zerorate.motion.motion_settings", "zerorate.motion.orientation"),
        "zerorate.explain_sources",
    ),
    "gravity": (
        *("zerorate.gravity", "zerorate.others", "zerorate.native.gravity"),
        *("zerorate.gravity.gravity_settings", "zerorate.explain_sources"),
    ),
    "effects": (
        *("zerorate.model", "zerorate.others", "zerorate.native.effects"),
        "zerorate.storage.kept_model",
    ),
    "refine": (
        *("zerorate.model", "zerorate.others", "zerorate.native.effects"),
        *("zerorate.native.refine", "zerorate.storage.kept_model"),
    ),
    "bursts": ("zerorate.bursts",),
    "self-test": ("zerorate_i2c.self_test",),
    "differing": ("zerorate.storage.differing",),
}
_NATIVE = "zerorate.native"
#: Kinds of machine code, as zerorate/native names its files -> how mpy-cross calls the processor.
CODES = {"thumb": "armv6m", "rv32": "rv32imc"}
_EXTRA_ROOTS = frozenset(root for part in PARTS if part != REST for root in PARTS[part])
BOTH = "motion, gravity"
_PARTS_OF_BOTH = frozenset(BOTH.split(", "))
_TABLE = "needs.json"


class UnknownPart(ZerorateError):
    """A part that the firmware does not have."""


def chosen_parts(named: Iterable[str]) -> tuple[str, ...]:
    """The parts in their own order, `rest` first; `all` is every one. Raises UnknownPart."""
    wanted = set(named)
    unknown = sorted(wanted - set(PARTS) - {"all"})
    if unknown:
        raise UnknownPart(f"no such part: {unknown[0]}; these are: {', '.join(PARTS)}, all")
    return tuple(part for part in PARTS if part == REST or part in wanted or "all" in wanted)


def parts_there(files: Iterable[PurePosixPath]) -> set[str]:
    """The parts of which a board has every module that a program imports, by its files in lib."""
    there = {".".join(file.with_suffix("").parts) for file in files}
    # of a package that does nothing a board gets no file
    there |= {root for root in chain(*PARTS.values()) if module_file(root).name == "__init__.py"}
    return {part for part, roots in PARTS.items() if there.issuperset(roots)}


def part_files(parts: Iterable[str], code: str = "") -> dict[PurePosixPath, Path]:
    """Path below lib on the board -> file, for all that these parts import, in order of name.

    code: the kind of machine code that stands in for the kernels' bytecode, see CODES.
    """
    roots = [root for part in parts for root in PARTS[part]]
    stops = _EXTRA_ROOTS.difference(roots)
    found: dict[str, Path] = {}
    waiting = list(roots)
    while waiting:
        module = waiting.pop()
        if module not in found and module not in stops:
            found[module] = module_file(module)
            waiting += _imports(found[module], module, code)
    return dict(sorted((_on_board(module, path), path) for module, path in found.items()))


def module_file(module: str) -> Path:
    """The file of a module of the packages. Raises ModuleNotFoundError."""
    if module not in _files():
        raise ModuleNotFoundError(f"{module} is not installed beside zerorate_tools")
    return _files()[module]


@cache
def _files() -> dict[str, Path]:
    """Module -> file, of all modules of the packages."""
    found = {}
    for package in PACKAGES:
        spec = find_spec(package)
        for root in map(Path, (spec and spec.submodule_search_locations) or ()):
            for path in root.rglob("*.py"):
                words = path.relative_to(root.parent).with_suffix("").parts
                found[".".join(words).removesuffix(".__init__")] = path
    return found


def _on_board(module: str, path: Path) -> PurePosixPath:
    place = PurePosixPath(*module.split("."))
    return place / path.name if path.name == "__init__.py" else place.with_suffix(".py")


def _imports(path: Path, module: str, code: str) -> Iterator[str]:
    """Modules of the packages that a file imports anywhere in it, and the packages they are in."""
    package = module if path.name == "__init__.py" else module.rpartition(".")[0]
    tree = ast.parse(path.read_text(encoding="utf-8"))
    machine_code = f"{_NATIVE}.{code}_{module.rpartition('.')[2]}"
    if code and package == _NATIVE and machine_code in _files():
        yield machine_code
        for choice in tree.body:  # what is imported only where there is none
            if isinstance(choice, ast.If):
                choice.orelse = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from _with_packages(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = _base(node, package)
            yield from _with_packages([base, *(f"{base}.{alias.name}" for alias in node.names)])


def _base(node: ast.ImportFrom, package: str) -> str:
    if not node.level:
        return node.module or ""
    above = package.split(".")[: len(package.split(".")) - node.level + 1]
    return ".".join([*above, *([node.module] if node.module else [])])


def _with_packages(names: Iterable[str]) -> Iterator[str]:
    for name in names:
        for module in accumulate(name.split("."), "{}.{}".format):
            if module in _files():
                yield module


def needs() -> dict[str, dict[str, int]]:
    """`native`, `bytecode` -> part -> heap, `rest` with driver and Corrector; `cycles`, `heap`.

    BOTH stands for the two parts of its name, which share some of what each takes alone.
    """
    return json.loads(files(__package__).joinpath(_TABLE).read_text(encoding="utf-8"))


def heap_needed(parts: Iterable[str], code: str) -> int:
    """Bytes of heap that these parts take with that kind of machine code, "" for bytecode."""
    table = needs()["native" if code else "bytecode"]
    parts = set(parts)
    if BOTH in table and parts.issuperset(_PARTS_OF_BOTH):
        parts = parts.difference(_PARTS_OF_BOTH) | {BOTH}
    return sum(table.get(part, 0) for part in parts)
