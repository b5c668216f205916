"""docs/layout.md: every word of every array, made from firmware/zerorate/layout.py."""

from zerorate import layout

_HEAD = """# The words of the firmware's arrays

Made from `firmware/zerorate/layout.py` by `make layout`; edit that file. A kernel writes a word as
its letter and its name: `s[_REST]`, `s[a + _OFFSET_Q8]`, `c[_WINDOW]`. A number behind `_Q` is how
many bits stand for the fraction: 256 in a word of `_Q8` is 1. A real is two words, mantissa and
exponent of 2; a packed one is one word. Words that take the place of others have a line that says
when they are there.
"""


def page():
    """Return the page's text."""
    parts = [_HEAD]
    for array in layout.ARRAYS:
        parts.append(f"## {array.title}\n\n`{array.letter}`: {array.base}{size_of(array)}.\n")
        parts.append(table([word for word in array.words if not word.while_text]))
        for text in dict.fromkeys(w.while_text for w in array.words if w.while_text):
            parts.append(f"While {text}:\n")
            parts.append(table([word for word in array.words if word.while_text == text]))
    parts.append("## Codes\n")
    for codes in layout.CODES:
        numbers = ", ".join(f"{number} `{name}`" for name, number in codes.numbers.items())
        parts.append(f"{codes.title}: {numbers}.\n")
    return "\n".join(parts)


def size_of(array):
    """Return how many words an array has, where that does not depend on settings."""
    return f", {array.size} words" if array.size > 1 else ""


def table(words):
    """Return the words as a table."""
    rows = ["| word | name | unit | what |", "|---|---|---|---|", *map(row, words)]
    return "\n".join(rows) + "\n"


def row(word):
    """Return a word as a row: its index, or first and last."""
    last = word.index + word.count - 1 if isinstance(word.count, int) else word.count
    index = f"{word.index}" if last == word.index else f"{word.index}..{last}"
    if isinstance(word.count, str):
        index = f"{word.index}.."
    what = word.meaning if isinstance(word.count, int) else f"{word.meaning} ({word.count} words)"
    return f"| {index} | `{word.name}` | {word.unit} | {what} |"
