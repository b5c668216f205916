"""What `make layout` writes: constants where they are used, and the tables of layout.md."""

import ast
import io
import re
import tokenize
from pathlib import Path

from zerorate.settings import DEFAULTS, LEAST, MOST, OF_THE_DOCUMENT
from zerorate_tools import layout
from zerorate_tools.layout.words import Codes

BEGIN = "# layout: "
END = "# layout: end"
_BLOCK = re.compile(r"(?:^# layout: (?!end$).*?)?^# layout: end$", re.DOTALL | re.MULTILINE)


def files(repository):
    """The files that have such lines: the firmware's, and the scripts that run beside it."""
    for folder in ("firmware", "tools", "host_tests"):
        for path in sorted((repository / folder).rglob("*.py")):
            if f"\n{END}\n" in path.read_text(encoding="utf-8"):
                yield path


def refreshed(path):
    """The text of a file with its lines made anew. Raises ValueError where it has two blocks."""
    text = path.read_text(encoding="utf-8")
    outside, blocks = _BLOCK.subn("", text)
    if blocks != 1:
        raise ValueError(f"{path.name}: one block from '{BEGIN}...' to '{END}', not {blocks}")
    used = names_in(outside)
    made = "\n".join([*for_the_host(outside, used), *lines(path.stem, used), END])
    return _BLOCK.sub(lambda _: made, text)


def for_the_host(outside, used):
    """The lines for names that a board's own compiler reads, where the file has none for them."""
    if "import const" not in outside:
        yield f"{BEGIN}names that a board's own compiler reads"
        yield "const = int"
        if "ptr32" in used:
            yield "ptr32 = None"


def names_in(text):
    """The names in a Python text."""
    tokens = tokenize.generate_tokens(io.StringIO(text).readline)
    return {token.string for token in tokens if token.type == tokenize.NAME}


def lines(stem, used):
    """The lines for the file of that name, which uses those names; its own codes are public."""
    for array in layout.ARRAYS:
        words = [(f"_{word.name}", word.index) for word in array.words]
        if array.size_name:
            words.append((f"_{array.size_name}", array.size))
        yield from group(array.title, words, used)
    for name, array in vars(layout).items():
        if f"_{name}_BITS" in used:
            yield f"{BEGIN}{array.title}: bits of each word, 64 more, or 96 where it has a sign"
            text = array.bits().decode().replace("\\", "\\\\")
            yield f'_{name}_BITS = b"{text}"'
    for codes in layout.CODES:
        own = codes.owner == stem
        pairs = [(name if own else f"_{name}", codes.numbers[name]) for name in codes.numbers]
        yield from group(codes.title, pairs, {name for name, _ in pairs} if own else used)
        used = used - {name for name, _ in pairs}  # another list's name has the same number there
        if codes.said and codes.said_in[0] == stem:
            yield f"{BEGIN}{codes.title}, in words"
            yield from (f"{codes.said_in[1]} = (", *spoken(codes.said.values()), ")")


def group(title, pairs, used):
    """The lines of one array or list of codes; none where none of its names is used."""
    pairs = [(name, number) for name, number in pairs if name in used]
    if pairs:
        yield BEGIN + title
    for name, number in pairs:
        yield f"{name} = const({hexadecimal(number)})"


def spoken(texts):
    """Texts as lines of a tuple."""
    return [f'    "{text}",' for text in texts]


def hexadecimal(number):
    """A number as it is written: from 16 bits on in hexadecimal."""
    if abs(number) < 1 << 16:
        return str(number)
    return f"{'-' if number < 0 else ''}0x{abs(number):X}"


_HEAD = """# The words of the firmware's arrays

Made from `tools/zerorate_tools/layout` by `make layout`; edit it there. A kernel writes a word as
its letter and its name: `s[_REST]`, `s[a + _OFFSET_Q8]`, `c[_WINDOW]`. A number behind `_Q` is how
many bits stand for the fraction: 256 in a word of `_Q8` is 1. A real is two words, mantissa and
exponent of 2; a packed one is one word. Three words of one name are x, y, z. Behind what a word is
stands what it can be, where that is less than 31 bits: a stored state with anything else is not
loaded.

Some words are shared: below "While ..." stands who else has them, and when. A name is one word's
alone, so `grep -rw _OFFSET_Q8 firmware` tells who writes and reads it. `loop/verify` of the tools
reads a replay's state by these names.
"""


def page():
    """Return the page's text."""
    parts = [_HEAD]
    for array in layout.ARRAYS:
        parts.append(f"## {array.title}\n\n`{array.letter}`: {array.base}{size_of(array)}.\n")
        shared = set().union(*(places(word) for word in array.words if word.while_text))
        parts.append(table([word for word in array.words if not word.while_text], shared))
        for text in dict.fromkeys(w.while_text for w in array.words if w.while_text):
            parts.append(f"While {text}:\n")
            parts.append(table([word for word in array.words if word.while_text == text]))
    parts.append("## Codes\n")
    for called, codes in vars(layout).items():
        if not isinstance(codes, Codes):
            continue
        title = f"`{called}`: {codes.title[0].lower()}{codes.title[1:]}"
        numbers = [f"{number} `{name}`" for name, number in codes.numbers.items()]
        if codes.said:
            said = zip(numbers, codes.said.values(), strict=True)
            parts.append("\n".join([f"{title}:\n", *(f'- {n} "{text}"' for n, text in said), ""]))
        else:
            parts.append(f"{title}: {', '.join(numbers)}.\n")
    return "\n".join(parts)


def size_of(array):
    """Return how many words an array has, where that does not depend on settings."""
    return f", {array.size} words" if array.size > 1 else ""


def places(word):
    """Return the indices of a word's words, those of a known number of them."""
    return set(range(word.index, word.index + word.count)) if isinstance(word.count, int) else set()


def table(words, shared=frozenset()):
    """Return the words as a table; `shared`: the indices that other words have at times."""
    head = ["| word | name | unit | what |", "|---|---|---|---|"]
    return "\n".join([*head, *(row(word, shared) for word in words), ""])


def row(word, shared):
    """Return a word as a row: its index, or first and last."""
    last = word.index + word.count - 1 if isinstance(word.count, int) else word.count
    index = f"{word.index}" if last == word.index else f"{word.index}..{last}"
    if isinstance(word.count, str):
        index = f"{word.index}.."
    what = word.meaning if isinstance(word.count, int) else f"{word.meaning} ({word.count} words)"
    what += " (shared)" if places(word) & shared else ""
    what += f"; {word.least}..{word.most}" if word.limited else ""
    return f"| {index} | `{word.name}` | {word.unit} | {what} |"


_ENTRY = re.compile(r'^    "(\w+)": [-\w.]+,  # (.+)$', re.MULTILINE)
_CONSTANT = re.compile(r"^_(\w+) = const\((\w+)\)  # (.+)$", re.MULTILINE)

_HEAD_SETTINGS_PAGE = """# What a user may set

Made from `firmware/zerorate/settings.py` by `make layout`; edit that file. Give any of them by
name: `Corrector(sensor, still_dps=0.5)`. A name ends with its unit. A time of readings, such as
`promote_s`, is as many readings as the output data rate gives in it. `Corrector` raises ValueError
outside of a range. Within all ranges, and those of `Sensor`, no number needs more than 31 bits
(`make sweep`). A window has a power of two samples, 4 to 256, as near to `window_s` as possible. A
segment has at most eight windows: at 100 Hz one of 2.5 s is 2.56 s long. The last column names the
words of [layout.md](layout.md) that a setting makes.

To change a default, edit `DEFAULTS` there and run `make layout`.

`zerorate close` ignores your settings: it computes with the defaults below.
`zerorate_tools.replay` takes any of them by name.
"""
_FIXED = """## Fixed constants

These stand in `firmware/zerorate/rest/stillness.py`, beside the rules by which a window is still
and its temperature is followed. A mean is that of a window; its variance is that of a sample over
the number of samples, three axes added.
"""


def settings_page(repository):
    """Return the page's text."""
    firmware = repository / "firmware" / "zerorate"
    source = (firmware / "settings.py").read_text(encoding="utf-8")
    meanings, words = dict(_ENTRY.findall(source)), words_made(source)
    rows = [
        "| setting | default | by the document | at least | at most | meaning | words |",
        "|---|---|---|---|---|---|---|",
    ]
    for name, value in DEFAULTS.items():
        made = ", ".join(f"`{word}`" for word in words.get(name, ()))
        literal = OF_THE_DOCUMENT.get(name, "")
        least, most = LEAST.get(name, 0), MOST[name.split("_")[-1]]
        limits = f"{least:g} | {most:g}"
        rows.append(f"| `{name}` | {value} | {literal} | {limits} | {meanings[name]} | {made} |")
    fixed = ["| constant | value | what |", "|---|---|---|"]
    stillness = (firmware / "rest" / "stillness.py").read_text(encoding="utf-8")
    white = re.search(r"([\d.]+ to [\d.]+) times is taken for noise", stillness)
    fixed.append(
        f"| in `white` | {white[1]} | mean squared step of the samples over their variance: noise |"
    )
    tilt = re.search(r"# (.+)\n_TILT_NOISE = const\((\d+)\)", source)
    fixed.append(f"| `TILT_NOISE` in settings.py | {tilt[2]} | {tilt[1]} |")
    for name, value, meaning in _CONSTANT.findall(stillness):
        fixed.append(f"| `{name}` | {value} | {meaning.rstrip(':')} |")
    return "\n".join([_HEAD_SETTINGS_PAGE, *rows, "", _FIXED, *fixed, ""])


def words_made(source):
    """Return setting -> the words of the kernels' settings that it makes, by way of locals too."""
    found, through = {}, {}
    for node in ast.walk(ast.parse(source)):
        if not isinstance(node, ast.Assign):
            continue
        value = ast.unparse(node.value)
        names = re.findall(r"limits\['(\w+)'\]", value)
        for local in set(re.findall(r"\w+", value)) & set(through):
            names += through[local]
        for target in node.targets:
            if isinstance(target, ast.Name) and names and target.id != "c":
                through[target.id] = names
            if isinstance(target, ast.Subscript):
                for name in names:
                    found.setdefault(name, []).append(target.slice.id[1:])
    return found


def main(repository):
    """Write the constants where they are used, docs/layout.md and settings.md."""
    for path in files(repository):
        path.write_text(refreshed(path), encoding="utf-8")
    docs = repository / "docs"
    (docs / "layout.md").write_text(page(), encoding="utf-8")
    (docs / "settings.md").write_text(settings_page(repository), encoding="utf-8")


if __name__ == "__main__":
    main(Path(__file__).resolve().parents[2])
