"""docs/layout.md: every word of every array, made from firmware/zerorate/layout."""

import ast
from pathlib import Path

from zerorate import layout

_HEAD = """# The words of the firmware's arrays

Made from `firmware/zerorate/layout` by `make layout`; edit it there. A kernel writes a word as
its letter and its name: `s[_REST]`, `s[a + _OFFSET_Q8]`, `c[_WINDOW]`. A number behind `_Q` is how
many bits stand for the fraction: 256 in a word of `_Q8` is 1. A real is two words, mantissa and
exponent of 2; a packed one is one word. Words that take the place of others have a line that says
when they are there. The files that write a word into its array by name stand first, `|`, then those
that use it otherwise.
"""


def page():
    """Return the page's text."""
    parts, uses = [_HEAD], used_in(Path(layout.__file__).parents[1])
    for array in layout.ARRAYS:
        parts.append(f"## {array.title}\n\n`{array.letter}`: {array.base}{size_of(array)}.\n")
        parts.append(table([word for word in array.words if not word.while_text], uses))
        for text in dict.fromkeys(w.while_text for w in array.words if w.while_text):
            parts.append(f"While {text}:\n")
            parts.append(table([word for word in array.words if word.while_text == text], uses))
    parts.append("## Codes\n")
    for codes in layout.CODES:
        numbers = ", ".join(f"{number} `{name}`" for name, number in codes.numbers.items())
        parts.append(f"{codes.title}: {numbers}.\n")
    return "\n".join(parts)


def size_of(array):
    """Return how many words an array has, where that does not depend on settings."""
    return f", {array.size} words" if array.size > 1 else ""


def table(words, uses):
    """Return the words as a table."""
    head = ["| word | name | unit | what | written, used in |", "|---|---|---|---|---|"]
    return "\n".join([*head, *(row(word, *uses.get(word.name, ((), ()))) for word in words), ""])


def row(word, writers, users):
    """Return a word as a row: its index, or first and last; who writes it and who else uses it."""
    last = word.index + word.count - 1 if isinstance(word.count, int) else word.count
    index = f"{word.index}" if last == word.index else f"{word.index}..{last}"
    if isinstance(word.count, str):
        index = f"{word.index}.."
    what = word.meaning if isinstance(word.count, int) else f"{word.meaning} ({word.count} words)"
    where = f"{' '.join(sorted(writers))} \\| {' '.join(sorted(users))}"
    return f"| {index} | `{word.name}` | {word.unit} | {what} | {where} |"


def used_in(firmware):
    """Return name -> the files that write it into an array, those that use it otherwise."""
    found = {}
    for path in sorted(firmware.rglob("*.py")):
        if path.parent.name in ("native", "layout"):
            continue
        tree = ast.parse(path.read_text(encoding="utf-8"))
        written = [n for n in ast.walk(tree) if is_written(n)]
        stored = [id(name) for node in written for name in ast.walk(node.slice)]
        for node in ast.walk(tree):
            if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load):
                writers, users = found.setdefault(node.id[1:], (set(), set()))
                (writers if id(node) in stored else users).add(path.stem)
    return found


def is_written(node):
    """Whether a node is an element of an array that is given a value."""
    return isinstance(node, ast.Subscript) and isinstance(node.ctx, ast.Store)
