"""The constants of layout as lines in the files that a board runs, each those that it uses."""

import io
import re
import tokenize

from zerorate_tools import layout

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
