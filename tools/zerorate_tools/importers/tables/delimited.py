"""CSV, TSV and their kin, packed or not, read block by block."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.csv

from ...errors import BadRecording
from ...recordings.text import line_blocks, rows_of
from ..columns.names import gyro_groups
from ..report import cut_words
from .sentences import COMMENTS, Rows
from .sniffing import DAY, MOST_WORDS, Form, sniffed, without_arrows
from .table import Chunk, Table

if TYPE_CHECKING:
    import pandas

_BLOCK_BYTES = 4_194_304
_HALF_DAY_S = 43_200.0
_A_NAME = re.compile(r"[^\W\d]")
#: Where a program fills a file before it writes, zeros stand behind the last line.
_ENDS = (b"\n", b"\r", b"\0")


def delimited(path: Path, advance: Callable[[float], None] = lambda n: None) -> Table:
    """The table of a text file. Raises BadRecording.

    advance: called with the bytes of the file that were read since it was called last.
    """
    form = sniffed(path)
    if form.lone and not gyro_groups(form.names):
        form = replace(form, words={**form.words, **_all_words(path, form)})

    def chunks(names: list[str]) -> Iterator[Chunk]:
        yield from _chunks(path, form, names, table.dropped, advance)

    notes = [form.note] if form.note else []
    table = Table(
        *(form.names, chunks),
        calendar=form.dates,
        words=form.words,
        notes=notes,
        said_hz=form.said_hz,
    )
    return table


def _all_words(path: Path, form: Form) -> dict[str, list[str]]:
    """Of columns of one word, as far as was looked, those with more in all, and these."""
    found: dict[str, dict[str, None]] = {name: {} for name in form.lone}
    skip = form.skip
    for lines in line_blocks(path, form.encoding, lambda n: None, _BLOCK_BYTES):
        odd = _OddLines(skip)
        rows = _rows(path, _changed(lines, form), form, [*form.lone], odd)
        for name in form.lone:
            words = _decoded(pc.unique(rows.column(name).combine_chunks()))
            found[name].update(dict.fromkeys(word.strip() for word in words if word))
        skip = 0
    names_again = {name: of for name, of in found.items() if not of.pop(name, None)}
    return {n: [*of] for n, of in names_again.items() if 2 <= len(of) <= MOST_WORDS}


def _chunks(
    path: Path,
    form: Form,
    names: list[str],
    dropped: Counter[str],
    advance: Callable[[float], None],
) -> Iterator[Chunk]:
    start, skip, why = 0, form.skip, ""
    blocks = line_blocks(path, form.encoding, advance, _BLOCK_BYTES)
    for lines in Rows(form.kinds).of(blocks) if form.kinds else blocks:
        odd = _OddLines(skip)
        rows = _rows(path, _changed(lines, form), form, names, odd)
        place = odd.places(start, rows.num_rows)
        if odd.rows:
            row, (expected, cells) = start + odd.rows[0] + 1, odd.cells
            why = why or f"not {expected} cells (the first, row {row}, has {cells})"
            dropped[why] += len(odd.rows)
        start, skip = start + rows.num_rows + len(odd.rows), 0
        if rows.num_rows and not lines.endswith(_ENDS):
            dropped["the last line does not end, so a digit may be missing"] += 1
            break
        for name in form.units:
            _refuse_another_unit(rows, name, form, place, path)
        columns = {n: _numbers(rows.column(n).combine_chunks(), n, form) for n in names}
        columns |= {n: columns[n] * form.scales[n] for n in names if n in form.scales}
        chunk = Chunk(place, columns)
        _refuse_other_names(rows, chunk, path, dropped)
        yield chunk


def _rows(path: Path, lines: bytes, form: Form, names: list[str], odd: _OddLines) -> pa.Table:
    try:
        kind, skip = pa.string(), odd.before
        return rows_of(lines, form.names, kind, skip, odd.take, form.delimiter, names)
    except pa.ArrowInvalid as error:
        problem = f"no table: {str(error)[:120]}"
        do = "name a CSV with a row for each sample"
        raise BadRecording(path, problem, do=do) from error


def _refuse_another_unit(
    rows: pa.Table, name: str, form: Form, place: np.ndarray, path: Path
) -> None:
    """Raise BadRecording where another unit stands behind a number than behind the first ones."""
    if name not in rows.column_names:
        return
    unit = re.escape(form.units[name])
    other = r"\d\s*[^\d\s.,eE+-]\S*\s*$"
    cells = pc.replace_substring_regex(rows.column(name), rf"\s*{unit}\s*$", "")
    at = pc.index(pc.match_substring_regex(cells, other), True).as_py()
    if at >= 0:
        problem = f"{rows.column(name)[at]} is in another unit than column {name!r}"
        do = "write all of its cells in one unit"
        raise BadRecording(path, problem, row=int(place[at]) + 1, do=do)


def _refuse_other_names(rows: pa.Table, chunk: Chunk, path: Path, dropped: Counter[str]) -> None:
    """Raise BadRecording where a line of other names stands among the rows: what follows may be
    anything. The same names again are counted, and their row taken away."""
    unread = np.isnan(np.array(list(chunk.columns.values()), ndmin=2)).all(axis=0)
    same = []
    for at in np.flatnonzero(unread)[:100].tolist():
        cells = _decoded(pa.array([column[at].as_py() for column in rows.columns], pa.string()))
        words = [(cell or "").strip() for cell in cells]
        if not all(map(_A_NAME.match, words)) or len(set(words)) < max(len(words), len("xyz")):
            continue
        if words != list(chunk.columns):
            problem = f"another line of names stands there ({', '.join(words)[:60]})"
            row = int(chunk.place[at]) + 1
            raise BadRecording(path, problem, row=row, do=cut_words(path, row))
        same.append(at)
    if same:
        chunk.place = np.delete(chunk.place, same)
        chunk.columns = {n: np.delete(values, same) for n, values in chunk.columns.items()}
        dropped["the line of names again"] += len(same)


def _changed(lines: bytes, form: Form) -> bytes:
    """Lines told apart as the form says: one blank parts cells in columns, with none at either end,
    and a clock before an arrow is a cell."""
    lines = without_arrows(lines) if form.arrows else lines
    if not lines.endswith(_ENDS):  # a letter may be cut in two
        lines = lines.decode(errors="replace").encode()
    if form.delimiter == "," and b";" in lines:
        lines = re.sub(rb"(?m);[ \t]*(?=\r?$)", b"", lines)
    if form.delimiter == " ":
        lines = re.sub(rb"(?m)^ | (?=\r?$)", b"", re.sub(rb"[ \t]+", b" ", lines))
    return lines


class _OddLines:
    """Lines of a block that are no row: comments, and those with too many or too few cells.

    rows: which the latter are; cells: those that a row has and those of the first of them.
    """

    def __init__(self, before: int) -> None:
        self.before = before
        self.rows: list[int] = []
        self.cells = 0, 0

    def take(self, row: pyarrow.csv.InvalidRow) -> str:
        """Arrow's handler of such a line."""
        text = str(row.text).lstrip()
        if not text or text.startswith(COMMENTS):
            self.before += 1
        else:
            self.rows.append(row.number - self.before - 1)
            self.cells = self.cells if self.cells[0] else row[:2]
        return "skip"

    def places(self, start: int, size: int) -> np.ndarray:
        """(size,) numbers of the rows of a block, of which the first may be `start`."""
        every = np.arange(size + len(self.rows))
        return start + np.setdiff1d(every, self.rows, assume_unique=True)[:size]


def _numbers(cells: pa.Array, name: str, form: Form) -> np.ndarray:
    """(n,) float64, NaN where a cell is no number; of a column of words each one's number."""
    if name in form.words:
        words = pa.array(form.words[name], cells.type)
        codes = pc.index_in(pc.utf8_trim_whitespace(cells), value_set=words)
        return pc.cast(codes, pa.float64()).to_numpy(zero_copy_only=False)
    if name in form.dates:
        return seconds_of(cells)
    if name in form.units:
        cells = pc.replace_substring_regex(cells, rf"\s*{re.escape(form.units[name])}\s*$", "")
    if form.decimal_comma:
        whole = pc.match_substring_regex(cells, r"\.\d{3},")  # 1.234,5 is one number
        cells = pc.if_else(whole, pc.replace_substring(cells, ".", ""), cells)
        cells = pc.replace_substring(cells, ",", ".")
    try:
        return pc.cast(cells, pa.float64()).to_numpy(zero_copy_only=False)
    except pa.ArrowInvalid:
        return _some_numbers(cells)


def _some_numbers(cells: pa.Array) -> np.ndarray:
    import pandas

    text = pandas.Series(_decoded(cells), dtype=object).str.strip().str.replace("−", "-")
    text = text.str.replace(r"(?<=\d)['’\u00a0\u202f](?=\d{3})", "", regex=True)
    return pandas.to_numeric(text, errors="coerce").to_numpy(dtype=float)


def seconds_of(cells: pa.Array) -> np.ndarray:
    """(n,) seconds since 1970 of ISO-8601 texts, without a zone in UTC, or since midnight of times
    of the day, whose day may stand before them in any order."""
    import pandas

    text = pandas.Series(_decoded(cells), dtype=object).str.strip()
    text = text.str.replace(rf"(?i)^{DAY}|\[\w+]$|\s+(?:utc|gmt)$", "", regex=True).str.replace(
        ",", "."
    )
    text = text.str.replace(r"(\d\d?:\d\d:\d\d):(\d+)", r"\1.\2", regex=True)
    text = text.str.replace(r"^(\d\d?:\d\d\.)", r"0:\1", regex=True)
    text = text.str.replace(r"\s+([+-]\d\d:?\d\d)$", r"\1", regex=True)
    if text.str.match(r"\d\d?:").any():
        return _since_midnight(text)
    text = text.str.replace(r"^(\d{4})/(\d\d)/", r"\1-\2-", regex=True)
    stamps = pandas.to_datetime(text, format="ISO8601", utc=True, errors="coerce")
    # nanoseconds would not hold a torn year
    since = stamps.dt.as_unit("us").to_numpy("datetime64[us]")
    return np.where(np.isnat(since), np.nan, since.astype(float) * 1e-6)


def _since_midnight(text: pandas.Series) -> np.ndarray:
    """(n,) seconds of times of the day, of which an hour may end with AM or PM."""
    import pandas

    half = text.str.extract(r"\s*([ap])\.?m\.?$", flags=re.I)[0].str.lower()
    clock = text.str.replace(r"(?i)\s*[ap]\.?m\.?$", "", regex=True)
    of_day_s = pandas.to_timedelta(clock, errors="coerce").dt.total_seconds().to_numpy(float)
    of_half_s = of_day_s % _HALF_DAY_S + _HALF_DAY_S * (half == "p").to_numpy()
    return np.where(half.isna(), of_day_s, of_half_s)


def _decoded(cells: pa.Array) -> list[str | None]:
    raw = cells.cast(pa.binary()).to_pylist()
    return [None if cell is None else cell.decode("utf-8", "replace") for cell in raw]
