"""Lines of words and numbers, as sketches, brokers and `ros2 topic echo` print them.

The words before a number name it: `gx: 0.8 | gy: -0.5`, `Gyro X:0.01, Y: 0.02 radians/s`,
`imu/gyro 0.8,-0.5,0.3`. Lines of the same names are of one kind. Kinds that take turns make a row.
"""

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from functools import lru_cache

from ..columns.units import unit_in_name

Kind = tuple[str, ...]

COMMENTS = ("#", "//", "%", "*")
_MARKS = tuple(mark.encode() for mark in COMMENTS)
#: A message of ROS has 15.
_MOST_KINDS = 40
#: Numbers of a line that may be a row without a word.
_OF_A_ROW = 3
_CLOCK = (
    r"(?:\d{4}[-/]\d\d[-/]\d\d[T ]|\d\d?[./-]\d\d?[./-]\d{4},?\s+)?\d\d?:\d\d:\d\d(?:[.,:]\d+)?"
    r"(?:\s*[ap]\.?m\b\.?|Z|[+-]\d\d:?\d\d)?"
)
_NUMBER = r"[-+]?(?:(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?|nan\b)"
_EACH = re.compile(rf"(?=[-+.\dn])(?<![\w./^])(?<!\w-)({_CLOCK}|{_NUMBER})(?!\d)".encode(), re.I)
COLOUR = re.compile(rb"\x1b\[[\d;]*m")
_HEADING = re.compile(rb"([ \t]*)([A-Za-z][^:={]*?) ?[:{]\s*$")
_ITEM = re.compile(rb"\s*- [-\d.]")
#: What ends a label; and a topic, which needs no colon.
_LABEL = re.compile(
    r"""[:=][\s"'\[({]*$|\w\s+\[\s*$|^\W*[\w.]*[A-Za-z]\w*/[\w./]*[A-Za-z]\w*\s+$"""
)
_WORDS = re.compile(r"[A-Za-z_][\w./]*(?:[ -][A-Za-z_][\w./]*)*")
#: Whose names follow in brackets: dev/gyro {"ts": or sensor_gyro(now:
_OWNER = re.compile(r"\s*([A-Za-z][\w./-]*)\s*[({].*\w")
#: A pair whose value is a word.
_WORDED = re.compile(r"\w+=[^\s=:,]*[^\W\d][^\s=:,]*[\s,]+")
#: A name and its unit: [gyro/mdps].
_NAMED_UNIT = re.compile(r"[\[(]([A-Za-z]+)/([^\[\]()\s]+)[\])]")
#: What evtest prints of an input device, and how many of an axis' value are a deg/s or a g.
_EVENT = re.compile(rb"Event: time ([\d.]+), type \d+ .*code \d+ \((\w+)\), value (-?\d+)")
#: What cantools prints before the signals of a frame.
_FRAME = re.compile(rb"\s*\(([\d.]+)\) .* :: ")
_IN_BRACKETS = re.compile(r"\s*[\[(]([^\[\]()]+)[\])]")
_BEHIND = re.compile(r"[\s\])}]*([^\s,;|\])}]+)(?!\s*[:=])")
#: ESP-IDF's log: I (320) imu: gx=0.8, in milliseconds.
_ESP = re.compile(r"^\W*[EWIDV] \($")
_AXIS = re.compile("[xyz]", re.I)


def kinds_in(lines: Iterable[bytes]) -> tuple[Kind, ...]:
    """The kinds of lines that a text is made of; none where it is another table."""
    counts: Counter[Kind] = Counter()
    others = 0
    for names, numbers in map(Reader().read, lines):
        if names:
            counts[names] += 1
        elif len(numbers) >= _OF_A_ROW:
            others += 1
    most = max(counts.values(), default=0)
    kinds = tuple(kind for kind, count in counts.items() if count > 1 or count == most)
    held, every = sum(counts[kind] for kind in kinds), sum(counts.values()) + others
    good = 2 * held > every and len(columns_of(kinds)) >= _OF_A_ROW and len(kinds) <= _MOST_KINDS
    return kinds if good else ()


def columns_of(kinds: Iterable[Kind]) -> list[str]:
    return list(dict.fromkeys(name for kind in kinds for name in kind))


class Reader:
    """Reads lines, one after another: what stands in one may be beneath another's heading."""

    def __init__(self) -> None:
        self._heading, self._indent = "", 1 << 30

    def read(self, line: bytes) -> tuple[Kind, list[bytes]]:
        """The names of a line's numbers, and these; none of a comment, or an item of a list."""
        line = COLOUR.sub(b"", line) if b"\x1b" in line else line
        line = _EVENT.sub(rb"Event time: \1, \2: \3", line)
        line = _FRAME.sub(rb"time: \1 ", line) if b" :: " in line else line
        indent = len(line) - len(line.lstrip(b" \t"))
        if heading := _HEADING.match(line):
            self._heading, self._indent = heading[2].decode("utf-8", "replace"), indent
        if line.startswith(_MARKS, indent) or _ITEM.match(line):
            return (), []
        parts = _EACH.split(line.strip())
        if len(parts) == 3 and not parts[0] + parts[2] and b":" in parts[1]:  # a clock alone
            return ("time",), parts[1:2]
        return _named(self._heading, indent > self._indent, tuple(parts[::2])), parts[1::2]


@lru_cache(4096)
def _named(heading: str, beneath: bool, texts: tuple[bytes, ...]) -> Kind:
    """The name of each number between texts; `2` is that of the second if no word names it. None
    where more than half have none, as in a table behind a word, or a comma is in each number.

    beneath: the line is indented beneath the heading.
    """
    whose, unit = _without_unit(heading)
    words = [_WORDED.sub("", text.decode("utf-8", "replace")) for text in texts]
    if not heading and (owner := _OWNER.match(words[0])):
        whose = owner[1]
    names, units = [], []
    for at in range(len(words) - 1):
        text, own = _without_unit(words[at])
        name, whose = _name(text, whose, beneath and not at)
        behind = _BEHIND.match(words[at + 1])
        if behind and is_unit(behind[1].strip("[]()")):
            own, words[at + 1] = behind[1].strip("[]()"), words[at + 1][behind.end() :]
        names.append(name)
        units.append(own or (unit if not at and name.startswith(whose) else ""))
    names = _with_axes(names)
    pairs = zip(names, names[1:], [*names[2:], "end"], texts[1:])
    if any(a and c and not b and text == b"," for a, b, c, text in pairs):
        return ()
    if 2 * names.count("") > len(names):
        return ()
    for order in (range(1, len(names)), range(len(names) - 2, -1, -1)):
        for at in order:  # a unit is that of the other axes, too
            fellow = at - (1 if order.step > 0 else -1)
            if _stem(names[at]) == _stem(names[fellow]):
                units[at] = units[at] or units[fellow]
    out: list[str] = []
    for at, (name, unit) in enumerate(zip(names, units)):
        name = f"{name} [{unit}]" if name and unit else name or f"{at + 1}"
        out.append(f"{name}.{at}" if name in out else name)
    return tuple(out)


def _name(text: str, whose: str, beneath: bool) -> tuple[str, str]:
    """The name of a number behind a text, and whose axis the next one may be."""
    if _ESP.search(text):
        return "esp_log_ms", whose
    found = _WORDS.findall(text) if _LABEL.search(text) else []
    if not found:
        return "", whose
    name = found[-1]
    if _AXIS.fullmatch(name):
        whose = found[-2] if len(found) > 1 else whose
        return f"{whose} {name}".strip(), whose
    first, _, last = name.rpartition(" ")
    return (f"{whose} {name}" if beneath else name), (first if _AXIS.fullmatch(last) else whose)


def _without_unit(text: str) -> tuple[str, str]:
    """A text without what is in brackets, and the unit that is."""
    found = _NAMED_UNIT.search(text)
    if found and is_unit(found[2]) and not is_unit(f"{found[1]}/{found[2]}"):
        text = _NAMED_UNIT.sub(r"\1 [\2]", text)
    units = [found for found in _IN_BRACKETS.findall(text) if is_unit(found)]
    return _IN_BRACKETS.sub("", text), units[-1] if units else ""


def is_unit(text: str) -> bool:
    """Whether a text is a unit of anything that a recording has."""
    return any(unit_in_name(target, f"x [{text}]") for target in ("t_us", "gx", "ax", "temp"))


def _stem(name: str) -> str:
    return re.sub("[xyz]$", "", name, flags=re.I)


def _with_axes(names: list[str]) -> list[str]:
    """Names for the numbers behind a name: x, y, z of `gyro`; of `a/g` those of a and of g."""
    out = list(names)
    starts = [at for at, name in enumerate(names) if name] + [len(names)]
    for start, end in zip(starts, starts[1:]):
        parts = names[start].split("/") if end - start > _OF_A_ROW else [names[start]]
        if end - start == _OF_A_ROW * len(parts):
            out[start:end] = [f"{part} {axis}" for part in parts for axis in "xyz"]
    return out


class Rows:
    """Makes rows of lines: the columns of all kinds, parted by commas."""

    def __init__(self, kinds: tuple[Kind, ...]) -> None:
        self._reader, self._kinds = Reader(), dict.fromkeys(kinds)
        self._columns, self._first = columns_of(kinds), kinds[0]
        self._row: dict[str, bytes] = {}
        # an input device is silent of an axis that does not change
        self._before: dict[str, bytes] | None = {} if "ABS_RX" in self._columns else None
        self._held: set[Kind] = set()
        self._begun, self._ended = False, 0

    def of(self, blocks: Iterable[bytes]) -> Iterator[bytes]:
        """Blocks of lines as blocks of rows; the last may lack its end, as the last line does."""
        end = b"\n"
        for block in blocks:
            end = b"\n" if block.endswith((b"\n", b"\r")) else b""
            lines = [row for line in block.splitlines() for row in self._taken(line, end)]
            yield from [b"".join(lines)] if end else lines
        if self._held:
            yield self._written(end)

    def begun(self, line: bytes) -> int:
        """How many rows have begun with a line, which is taken."""
        self._ended += len([*self._taken(line, b"")])
        return self._ended + bool(self._held)

    def _taken(self, line: bytes, end: bytes) -> Iterator[bytes]:
        """The rows that end with a line: before the first kind, or one that is there; or whole.
        A line of other names is one of one cell, and so is any where each line is a row."""
        names, numbers = self._reader.read(line)
        if names not in self._kinds:
            text = line.strip(b" \t\r\0")
            if self._begun and text and not text.startswith(_MARKS):
                if len(self._kinds) == 1 or names:
                    yield b"-" + end
            return
        self._begun = True
        if self._held and (names == self._first or names in self._held):
            yield self._written(b"\n")
        self._held.add(names)
        for name, number in zip(names, numbers):
            self._row.setdefault(name, number)
        if len(self._held) == len(self._kinds):
            yield self._written(end)

    def _written(self, end: bytes) -> bytes:
        if self._before is not None:
            self._before = self._row = {**self._before, **self._row}
        cells = [self._row.get(name, b"") for name in self._columns]
        self._row, self._held = {}, set()
        return b",".join(b'"%b"' % cell if b"," in cell else cell for cell in cells) + end
