"""How large the house is and how much of it is said twice, of a checkout or of any commit in it.

python -m host_tests.house.census [COMMIT]
"""

import ast
import re
import subprocess
import sys
import tempfile
import tokenize
from collections import Counter
from pathlib import Path

from .test_imports import by_package, circles, graph_of

_CONST = re.compile(r"^(_?[A-Z][A-Z0-9_]*) = const\((-?\w+)\)", re.MULTILINE)
_MADE = re.compile(r"^# layout: (?!end$).*?^# layout: end$", re.DOTALL | re.MULTILINE)


def census(root):
    """What is counted, in words -> how many."""
    python = [
        p
        for folder in ("firmware", "drivers", "tools", "host_tests")
        for p in (root / folder).rglob("*.py")
    ]
    made = [
        p
        for p in python
        if re.match(r"(thumb|rv32)_", p.name)
        or (p.parent.name == "viper" and "firmware" in p.parts)
    ]
    written = [p for p in python if p not in made]
    firmware = [p for p in written if p.is_relative_to(root / "firmware" / "zerorate")]
    graph = graph_of(root / "tools")
    own = {
        f"of these in {folder}": sum(lines(p) for p in written if p.is_relative_to(root / folder))
        for folder in ("firmware", "drivers", "tools", "host_tests")
    }
    return {
        "Python files": len(written),
        "lines in them": sum(map(lines, written)),
        **own,
        "code in firmware, without remarks and blank lines": sum(map(code_lines, firmware)),
        "generated files": len(made),
        "lines in them, and those that `make layout` writes": sum(
            [*(len(p.read_text("utf-8").splitlines()) for p in made), *map(made_lines, python)]
        ),
        "lines that make C and machine code of kernels": sum(map(lines, generator(root))),
        "files of more than 300 lines": sum(lines(p) > 300 for p in written),
        "files that say where a word of an array is": len(layouts(firmware)),
        "names of constants with several values in the firmware": len(several(firmware)),
        "circles of imports between modules": len(circles(graph)),
        "circles of imports between packages": len(circles(by_package(graph))),
        "words to learn": words(root / "docs" / "glossary.md"),
        **rooms(root / "tools" / "zerorate_tools" / "loop"),
    }


def generator(root):
    """The files that read kernels and write C, machine code and the export of them."""
    tools = root / "tools" / "zerorate_tools"
    back = ("reading", "c_expressions", "c_functions", "parts", "machine_code", "native_files")
    now = [tools / "kernels" / f"{name}.py" for name in (*back, "export")]
    return [
        p for p in [*now, *(tools / "twins").glob("*.py"), tools / "viper_twins.py"] if p.exists()
    ]


def lines(path):
    """Lines of a file that a person writes."""
    return len(path.read_text(encoding="utf-8").splitlines()) - made_lines(path)


def code_lines(path):
    """Lines of code of a file that a person writes: no remark, no docstring, none that is blank."""
    lines = set()
    for token in tokenize.generate_tokens(
        iter(_MADE.sub("", path.read_text("utf-8")).splitlines(True)).__next__
    ):
        text = token.type == tokenize.STRING and token.line.strip().startswith('"""')
        if (
            token.type in (tokenize.NAME, tokenize.NUMBER, tokenize.OP, tokenize.STRING)
            and not text
        ):
            lines.update(range(token.start[0], token.end[0] + 1))
    return len(lines)


def made_lines(path):
    """Lines of a file that `make layout` writes into it."""
    blocks = _MADE.findall(path.read_text(encoding="utf-8"))
    return sum(len(block.splitlines()) for block in blocks)


def layouts(firmware):
    """The files that themselves give a number to a name by which an array is read or written."""
    own = {p: dict(_CONST.findall(_MADE.sub("", p.read_text(encoding="utf-8")))) for p in firmware}
    found = {p for p in firmware if own[p].keys() & subscripts(p)}
    folder = {p.parent for p in firmware if p.parent.name == "layout"}
    return found | folder | {p for p in firmware if p.name == "layout.py"}


def subscripts(path):
    """The names in the subscripts of a file."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    inside = (n.slice for n in ast.walk(tree) if isinstance(n, ast.Subscript))
    return {name.id for part in inside for name in ast.walk(part) if isinstance(name, ast.Name)}


def several(firmware):
    """The names that stand for different numbers in different files."""
    pairs = {pair for p in firmware for pair in _CONST.findall(p.read_text(encoding="utf-8"))}
    return {name for name, times in Counter(name for name, _ in pairs).items() if times > 1}


def rooms(loop):
    """Files of the loop by room."""
    there = Counter(p.parent.name for p in loop.rglob("*.py") if p.name != "__init__.py")
    return {
        f"files in loop/{'' if name == 'loop' else name}": there[name] for name in sorted(there)
    }


def words(glossary):
    """Rows of the glossary."""
    if not glossary.exists():
        return 0
    return sum(line.startswith("|") for line in glossary.read_text().splitlines()) - 2


def main(arguments):
    root = Path(__file__).resolve().parents[2]
    if not arguments:
        found = census(root)
    else:
        with tempfile.TemporaryDirectory() as folder:
            archive = subprocess.run(
                ["git", "-C", root, "archive", *arguments], capture_output=True, check=True
            )
            subprocess.run(["tar", "-x", "-C", folder], input=archive.stdout, check=True)
            found = census(Path(folder))
    for what, number in found.items():
        print(f"| {what} | {number:,} |")


if __name__ == "__main__":
    main(sys.argv[1:])
