"""Where a text's table begins, what parts its cells, and how its numbers are written."""

import csv
import re
from collections import Counter
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from ...errors import BadRecording
from ...recordings.text import head
from ..columns.guesses import counts_rows, only_grows
from ..columns.names import gyro_groups
from ..columns.units import without_unit
from .sentences import COLOUR, COMMENTS, Kind, Reader, Rows, columns_of, is_unit, kinds_in

_HEAD_BYTES = 262_144
#: What some programs write before the first line of UTF-8.
MARK = b"\xef\xbb\xbf"
#: Blackbox Explorer writes some 150 lines of settings above its table.
_LINES = 400
#: Cells of a row that can hold three rates; two are a setting and its value.
_CELLS = 3
#: Rows that are looked at for words, and how many words at most tell rows apart.
_SEEN, MOST_WORDS = 3000, 12
_ONE_LINE = "print each sample on a line of its own, as 0.8,-0.5,0.3 or gx:0.8 gy:-0.5 gz:0.3"
_DELIMITERS = (",", ";", "\t", "|", " ")
_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?$")
_WITH_UNIT = re.compile(r"([-+]?[\d.,]+(?:[eE][-+]?\d+)?)\s*([^\d\s.,]\S*)$")
_DECIMAL_COMMA = re.compile(r"[-+]?\d*(?:\.\d{3})*,\d+([eE][-+]?\d+)?$")
_ISO = r"\d{4}[-/]\d\d[-/]\d\d[T ]\d\d:\d\d|\d{8}T\d{6}"
#: Words of a day before a time of the day, in any order: 01-May-2026, May 1, 2026, 0 days.
DAY = rf"(?!{_ISO})(?:[a-z0-9]{{1,9}}[\s,./_-]+){{1,4}}(?=\d\d?:)"
#: A spreadsheet writes a time of the day as minutes and seconds: 17:54.1.
DATE = re.compile(
    rf"{_ISO}|(?:{DAY})?\d\d?:\d\d(?::\d\d)?(?:(?<=:\d\d:\d\d)|(?=\.))([.,:]\d+)?(\s*[ap]\.?m\.?)?$",
    re.I,
)
#: What monitors put before each line: 12:00:00.250 -> or [2026-05-01 12:00:00.250], and those of
#: CoolTerm, Tera Term, Zephyr, ESP-IDF, Segger and Nordic.
_CLOCK = re.compile(
    rb"""(?mx)^(?: ([\d:.]+)[ ]->[ ]
    | \[(?:\w{3}[ ]\w{3}[ ]\d\d[ ])? ((?:[\d/.-]+[ T])?\d\d?:\d\d:\d\d(?:[.,]\d+)*) (?:[ ]\d{4})?\]
      [ \t]*(?:<\w+>[ ][\w.-]+:[ ])?
    | (\d{4}-\d\d-\d\d[ ]\d\d:\d\d:\d\d(?:\.\d+)?)[ ](?=[-+.\d]+[,;\t])
    | [EWIDV][ ]\(([\d:.]+)\)[ ][\w.-]+:[ ]
    | (?:\d\d?>|<\w+>[ ][\w.-]+:)[ ] )
    (?=[^\r\n]*?([,;\t |]))"""
)
#: A line of such beneath the names says their units.
_UNIT = re.compile(
    r"[\[(]?(-|[mun]?s|sec|(m?deg|rad|°)/s|m?dps|m?g|m/s(\^?2|²)|m/\(s\^2\)|°?c|degc|k|lsb"
    r"|no units)[\])]?$",
    re.I,
)
#: What stands before names in a comment, and around each of YEI's: Data format: "%float(GyroX),...
_BEFORE_NAMES, _PRINTED = re.compile(r'^[\w ]+:\s+"?'), re.compile(r'%\w+\((\w+)\)"?')
_RATE = re.compile(
    r"\b(?:sample|sampling|acquisition|update|output|data)[ _]?(?:rate|frequency)\b"
    r"[^\d\n]{0,12}([\d.]*\d)\s*(k?)",
    re.I,
)
#: What evtest says of an axis: how many of its values are a deg/s, or a g.
_RESOLUTION = re.compile(r"\((ABS_R?[XYZ])\)(?:(?!Event).)*?Resolution\s+(\d+)")
#: What stands above Gyroflow's table: how many of a unit a count is.
_SCALE = re.compile(rf"([tga])scale\s*,\s*({_NUMBER.pattern[:-1]})\s*,*\s*$")
_SCALED = re.compile(r"t|[ga][xyz]")
_OF_COUNTS = {"t": "s", "g": "rad/s", "a": "g"}
#: What tells texts that are no tables, what they are, and what to do.
_NO_TABLES = tuple(
    (re.compile(told), problem, do)
    for told, problem, do in (
        (r"\Aversion https://git-lfs", "a pointer of Git LFS, not the file",
         "fetch the file itself: git lfs pull"),
        (r"\A\s*<\?xml", "XML, which is no table",
         "write its table as CSV by the program that made it"),
        (r"\A *\([\d.]+\) +\w+ +[\dA-F]+(?:#| +\[\d+\])(?!.*::)|\Adate .*\n+base (?:hex|dec)",
         "frames of a CAN bus",
         "write their signals: cantools decode --single-line FILE.dbc < LOG"),
        (r"\A[%#](?:RAW|CORR)IMU", "angles turned between lines, not rates",
         "write rates: angles times the lines of a second, in the unit of your IMU"),
        (r"<UBX\(ESF-", "values of 24 bits, each behind a number of its kind",
         "write kinds 14, 13, 5 as gx, gy, gz (4096 a deg/s), 16 to 18 as ax to az (1024 a m/s2)"),
    )
)  # fmt: skip
#: Numbers in the first row, the header's line or None, the first row's line, delimiter.
_Found = tuple[int, int | None, int, str]


@dataclass(frozen=True)
class Form:
    """How a text holds its table. names: of the columns, as numbers from 1 where nothing names
    them; skip: lines before the first row; words: by column, where its cells are few words;
    arrows: a clock stands before lines; kinds: of lines of words and numbers;
    scales: by column, what its numbers are multiplied by; units: what stands behind them;
    lone: columns of one word, as far as was looked."""

    names: list[str]
    skip: int
    delimiter: str
    encoding: str
    decimal_comma: bool = False
    dates: frozenset[str] = frozenset()
    words: dict[str, list[str]] = field(default_factory=dict)
    note: str = ""
    said_hz: float | None = None
    arrows: bool = False
    kinds: tuple[Kind, ...] = ()
    scales: dict[str, float] = field(default_factory=dict)
    units: dict[str, str] = field(default_factory=dict)
    lone: frozenset[str] = frozenset()


def sniffed(path: Path) -> Form:
    """The form of a text, told from its first lines. Raises BadRecording."""
    content, encoding = head(path, _HEAD_BYTES)
    whole = len(content) < _HEAD_BYTES
    plain = without_arrows(content)
    text = plain.decode(encoding, errors="replace").lstrip("\ufeff")
    if "\x00" in text[:1000] and not text[:20].isprintable():
        do = "name a table, or a log of a kind that `zerorate import --help` lists"
        raise BadRecording(path, "neither text nor a log of a known kind", do=do)
    for told, problem, do in _NO_TABLES:
        if told.search(text):
            raise BadRecording(path, problem, do=do)
    lines = text.splitlines()
    if not whole:
        lines = lines[:-1]
    if not any(line.strip() for line in lines):
        if whole:
            raise BadRecording(path, "empty file", do="name another file")
        problem = f"no line ends within the first {_HEAD_BYTES >> 10} KiB"
        raise BadRecording(path, problem, do="name a table with a sample on each line")
    ends = [n for n, line in enumerate(lines) if line.startswith("***End_of_Header***")]
    if ends:  # LabVIEW names a column of comments that rows do not have
        lines = [""] * ends[-1] + [line.removesuffix("\tComment") for line in lines[ends[-1] :]]
    spoken = [line.encode() for line in content.decode(encoding, "replace").splitlines()]
    if kinds := kinds_in(spoken[: len(lines)]):
        return _of_sentences(kinds, spoken, encoding)
    form = _table_in(lines[:_LINES], lines, encoding, path)
    if lines[0].startswith("GYROFLOW IMU LOG"):
        form = _scaled(form, _of_gyroflow(form.names, lines[: form.skip]))
    return replace(form, arrows=plain != content)


def _of_gyroflow(names: list[str], above: list[str]) -> dict[str, tuple[str, float]]:
    """By column of counts, the unit and the scale that Gyroflow says above them."""
    said = {one[1]: float(one[2]) for one in map(_SCALE.match, above) if one}
    counts = [name for name in names if _SCALED.fullmatch(name) and name[0] in said]
    return {name: (_OF_COUNTS[name[0]], said[name[0]]) for name in counts}


def _of_evtest(above: list[str]) -> dict[str, tuple[str, float]]:
    """By column of an input device, its unit and the scale that evtest says of it."""
    said = {at[1]: int(at[2]) for at in _RESOLUTION.finditer("".join(above)) if int(at[2])}
    axes = {name: ("deg/s" if "R" in name else "g", 1.0 / size) for name, size in said.items()}
    return {**axes, "MSC_TIMESTAMP": ("us", 1.0)}


def _scaled(form: Form, said: dict[str, tuple[str, float]]) -> Form:
    """Columns in the units and the scales that a file says of them."""
    own = {name: f"{name} ({said[name][0]})" for name in form.names if name in said}
    scales = {named: said[name][1] for name, named in own.items()}
    return replace(form, names=[own.get(name, name) for name in form.names], scales=scales)


def without_arrows(content: bytes) -> bytes:
    """What a monitor puts before a line as a cell of its own: its clock, or nothing."""
    return _CLOCK.sub(_clock_alone, COLOUR.sub(b"", content))


def _clock_alone(at: re.Match[bytes]) -> bytes:
    clock = next(filter(None, at.groups()[:-1]), b"").replace(b" ", b"T")
    if clock.isdigit():  # ESP-IDF's milliseconds
        minutes, ms = divmod(int(clock), 60_000)
        clock = b"%d:%02d:%06.3f" % (*divmod(minutes, 60), ms / 1e3)
    return (clock.replace(b",", b"") if b"." in clock else clock) + at[5] if clock else b""


def _of_sentences(kinds: tuple[Kind, ...], lines: list[bytes], encoding: str) -> Form:
    """The form of lines of words; a number without one that goes on, and counts no rows, is the
    time."""
    names = columns_of(kinds)
    seen = b"\n".join(lines[:_SEEN])
    rows = b"".join(Rows(kinds).of([seen + b"\n"])).decode().splitlines()
    cells = [*csv.reader(row for row in rows if row != "-")]
    ends = {kind[at] for kind in kinds for at in (0, -1)}
    own = [at for at, name in enumerate(names) if name.isdigit() and name in ends]
    at = next((at for at in own if _goes_on([row[at] for row in cells if row[at]])), None)
    if at is not None and "time" not in names:
        names[at] = "time"
    dates = frozenset(n for n, cell in zip(names, cells[0]) if DATE.match(cell))
    above = [line.decode() for line in lines[:_LINES] if Reader().read(line)[0] not in kinds]
    said_hz = _rate_said(above)
    form = Form(names, 0, ",", encoding, dates=dates, said_hz=said_hz, kinds=kinds)
    return _scaled(form, _of_evtest(above))


def _goes_on(cells: list[str]) -> bool:
    if any(map(DATE.match, cells[:1])):
        return True
    values = np.array([float(cell) if _NUMBER.match(cell) else np.nan for cell in cells])
    values[np.isinf(values)] = np.nan
    return only_grows(values) and not counts_rows(values)


def _table_in(lines: list[str], every: list[str], encoding: str, path: Path) -> Form:
    found = [_of_rates(delimiter, lines) for delimiter in _DELIMITERS]
    if not any(found):
        found = [_with(delimiter, lines, 1) for delimiter in _DELIMITERS]
    best = max((one for one in found if one), key=lambda one: one[0], default=None)
    if best is None:
        header = next(line for line in lines if line.strip())
        if all(line.startswith(COMMENTS) for line in lines if line.strip()):
            problem = f"each line begins with {header[0]!r}, as comments do: {header[:40]}"
            raise BadRecording(path, problem, row=1, do="take it away before each sample")
        if not any(delimiter in header for delimiter in _DELIMITERS):
            raise BadRecording(path, "no table", do="name a CSV with a row for each sample")
        raise BadRecording(path, "no data row", do=_ONE_LINE)
    _, at, skip, delimiter = best
    if at is not None and _says_its_names(lines[at], lines[skip:], delimiter):
        problem = f"each line has words around its numbers: {lines[at].strip()[:60]}"
        raise BadRecording(path, problem, row=at + 1, do=_ONE_LINE)
    first = (
        _cells(lines[skip], delimiter) if at is not None else _whole_row(lines[skip:], delimiter)
    )
    names, note = _names(lines, at, skip, first, delimiter)
    behind = _units_behind(lines[skip:], len(names), delimiter)
    names = [f"{name} [{unit}]" if unit else name for name, unit in zip(names, behind)]
    units = {name: unit for name, unit in zip(names, behind) if unit}
    first = [cell.strip().removesuffix(unit) for cell, unit in zip(first, behind)]
    dates = frozenset(name for name, cell in zip(names, first) if DATE.match(cell.strip()))
    words = _words(every[skip:], names, delimiter, dates | {*units})
    return Form(
        names,
        skip,
        delimiter,
        encoding,
        decimal_comma=any(_DECIMAL_COMMA.match(c.strip()) for c in first),
        dates=dates,
        words={name: of for name, of in words.items() if len(of) > 1},
        units=units,
        lone=frozenset(name for name, of in words.items() if len(of) == 1),
        note=note,
        said_hz=_rate_said(lines[:skip]),
    )


def _of_rates(delimiter: str, lines: list[str]) -> _Found | None:
    """As `_with`, of the first table whose line of names has rates, where settings and their names
    stand above it."""
    found = _with(delimiter, lines)
    begins_with_rows = found is not None and found[1] is None
    for at, line in enumerate(lines if not begins_with_rows else ()):
        cells = _cells(line, delimiter)
        if len(cells) >= _CELLS and not _numbers(cells) and gyro_groups(cells):
            named = _with(delimiter, lines[at:])
            if named and named[1] is not None:
                return named[0], at + named[1], at + named[2], delimiter
    return found


def _says_its_names(line: str, lines: list[str], delimiter: str) -> bool:
    """Whether a line that may be one of names is such as come again with other numbers."""
    names = _cells(line, delimiter)
    if not _numbers(names):
        return False  # the words of its rows may be letters that mark their ends
    for other in lines:
        cells = _cells(other, delimiter)
        same = sum(name == cell and bool(name) for name, cell in zip(names, cells))
        if len(cells) == len(names) and 1 < same < len(names):
            return True
    return False


def _words(
    lines: list[str], names: list[str], delimiter: str, dates: frozenset[str]
) -> dict[str, list[str]]:
    """The words of those columns that have few, in the order in which they come first.

    dates: columns of other texts.
    """
    rows = [_cells(line, delimiter) for line in lines[:_SEEN]]
    rows = [[cell.strip() for cell in row] for row in rows if len(row) == len(names)]
    out: dict[str, list[str]] = {}
    for name, cells in zip(names, zip(*rows)):
        counts = Counter(cells)
        most = 0.8 * len(cells)
        if sum(count for _, count in counts.most_common(MOST_WORDS + 1)) <= most:
            continue  # with the empty one, so many words at most
        kinds = [cell for cell in counts if cell and not _numbers([cell])]
        found = sum(counts[kind] for kind in kinds)
        if name not in dates and found > most and 1 <= len(kinds) <= MOST_WORDS:
            out[name] = kinds
    return out


def _whole_row(lines: list[str], delimiter: str) -> list[str]:
    """The first row as wide as most: a log of a serial port may begin in the middle of one."""
    every = (_cells(line, delimiter) for line in lines if not line.lstrip().startswith(COMMENTS))
    rows = [cells for cells in every if len(cells) >= _CELLS] or [_cells(lines[0], delimiter)]
    [(usual, _)] = Counter(map(len, rows)).most_common(1)
    return next(cells for cells in rows if len(cells) == usual)


def _rate_said(lines: list[str]) -> float | None:
    """Samples a second, where a line above the table says them."""
    found = next((said for said in map(_RATE.search, lines) if said), None)
    return float(found[1]) * (1000.0 if found[2].lower() == "k" else 1.0) if found else None


def _with(delimiter: str, lines: list[str], least: int = _CELLS) -> _Found | None:
    """What the first two lines tell of as many cells, at least so many, of which the second has
    numbers; or None. A comment of as many cells without numbers is a header, too."""
    above: tuple[int, list[str]] | None = None
    comment: list[str] = []
    for number, line in enumerate(lines):
        if line.lstrip().startswith(COMMENTS):
            comment = _cells(line, delimiter)
        if not line.strip() or line.lstrip().startswith(COMMENTS):
            continue
        cells = _cells(line, delimiter)
        if len(cells) < least:
            continue
        numbers = _numbers(cells)
        if numbers > 1 and above is None and _as_many(comment, cells):
            if not _numbers(comment):
                return numbers, None, number, delimiter
        if numbers == len([c for c in cells if c.strip()]) and numbers > 1 and above is None:
            return numbers, None, number, delimiter
        if numbers and above is not None and _as_many(above[1], cells):
            if numbers == _numbers(above[1]) >= _CELLS:  # a row itself, with a word
                return numbers, None, above[0], delimiter
            return numbers, above[0], number, delimiter
        if not numbers or above is None or not _as_many(above[1], cells):
            above = number, cells
    return None


def _as_many(names: list[str], cells: list[str]) -> bool:
    """Whether two lines have as many cells; one may end with a delimiter."""
    fewer, more = sorted((names, cells), key=len)
    return len(more) - len(fewer) == (1 if len(more) > len(fewer) and not more[-1].strip() else 0)


def _cells(line: str, delimiter: str) -> list[str]:
    # the parser of rows takes no cell that is longer than csv's limit either
    text = " ".join(line.split()) if delimiter == " " else line
    text = text.rstrip().removesuffix(";") if delimiter == "," else text
    return next(csv.reader([text[:100_000]], delimiter=delimiter, skipinitialspace=True), [])


def _numbers(cells: list[str]) -> int:
    def is_one(cell: str) -> bool:
        is_number = any(form.match(cell) for form in (_NUMBER, _DECIMAL_COMMA, DATE))
        return is_number or bool(_unit_behind(cell))

    return sum(is_one(cell.strip()) for cell in cells)


def _units_behind(lines: list[str], width: int, delimiter: str) -> list[str]:
    """By column, the unit that stands behind each of its numbers; "" where none does."""
    rows = [cells for cells in (_cells(line, delimiter) for line in lines) if len(cells) == width]
    units = [{_unit_behind(cell) for cell in cells if cell.strip()} for cells in zip(*rows)]
    return [of.pop() if len(of) == 1 else "" for of in units] or [""] * width


def _unit_behind(cell: str) -> str:
    """The unit that stands behind a number; "" where none does."""
    found = _WITH_UNIT.match(cell.strip())
    return found[2] if found and is_unit(found[2]) else ""


def _names(
    lines: list[str], at: int | None, skip: int, first: list[str], delimiter: str
) -> tuple[list[str], str]:
    if at is not None:
        names = [name.strip() for name in _cells(lines[at], delimiter)]
        above = next((line for line in reversed(lines[:at]) if line.strip()), "")
        named = [name.strip() for name in _cells(above, delimiter)]
        comments = [line.strip() for line in (above, *lines[at + 1 : at + 2])]
        said = [_in_comment(line, delimiter) for line in comments if line.startswith(COMMENTS)]
        for of, units in ((named, names), *((names, units) for units in said)):
            are_units = (_UNIT.match(unit) or not (unit or name) for unit, name in zip(units, of))
            if len(of) == len(units) and all(are_units) and any(units):
                units = [unit.strip("[()]").replace("(s^2", "s^2") for unit in units]
                names = [f"{name} [{unit}]" if name else "" for name, unit in zip(of, units)]
                break
        else:
            names = _with_those_above(names, lines[:at], delimiter)
        return _as_wide(names, first), ""
    for line in reversed([*lines[skip:], *lines[:skip]]):
        text = line.strip()
        if text.startswith(COMMENTS):
            names = _in_comment(text, delimiter)
            if _as_many(names, first) and not _numbers(names):
                return _as_wide(names, first), ""
    numbered = [str(number) for number in range(1, len(first) + 1)]
    cells = _cells(lines[skip - 1], delimiter) if skip else []
    if len(cells) < _CELLS or _numbers(cells) or cells[0].startswith(COMMENTS):
        return numbered, "no line names the columns: they are called 1, 2, 3, ..."
    why = f"line {skip} names {len(cells)} columns, but rows have {len(first)}"
    return numbered, f"{why}: they are called 1, 2, 3, ..."


def _in_comment(comment: str, delimiter: str) -> list[str]:
    """The cells of a comment, without what it says before them."""
    text = _PRINTED.sub(r"\1", _BEFORE_NAMES.sub("", comment.lstrip("#/%* ")))
    return [cell.strip() for cell in _cells(text, delimiter)]


def _with_those_above(names: list[str], lines: list[str], delimiter: str) -> list[str]:
    """Names that are empty or come twice, behind those of the lines above: gyro over x, y and z."""
    for line in reversed([line for line in lines if not line.lstrip().startswith(COMMENTS)]):
        above = [cell.strip() for cell in _cells(line, delimiter)]
        if len(set(names)) == len(names) and all(names) or not _as_many(names, above):
            return names
        if _numbers(above) or not any(above):
            return names
        for at in range(1, len(above)):  # one cell over several columns
            if not above[at] and names[at]:
                above[at] = above[at - 1]
        names = [_joined(*both) for both in zip(above, names)]
    return names


def _joined(above: str, name: str) -> str:
    """`gyro (rad/s)` over `x` is `gyro x (rad/s)`."""
    stem = without_unit(above.lower())
    return " ".join(filter(None, (above[: len(stem)], name))) + above[len(stem) :]


def _as_wide(names: list[str], first: list[str]) -> list[str]:
    """A name for each cell of the first row."""
    return _single((names + [""] * (len(first) - len(names)))[: len(first)])


def _single(names: list[str]) -> list[str]:
    """Names of which none comes twice: `x` and `x` become `x` and `x.1`."""
    seen: dict[str, int] = {}
    out = []
    for name in names:
        count = seen[name] = seen.get(name, -1) + 1
        out.append(f"{name}.{count}" if count else name)
    return out
