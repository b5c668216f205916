"""Lines as $NAME,...*HH, each with the XOR of what stands between $ and *."""

from collections import Counter
from collections.abc import Callable, Iterator
from functools import reduce
from operator import xor
from pathlib import Path

import numpy as np

from ...recordings.text import head, line_blocks
from .table import Chunk, Table

_BLOCK_BYTES = 1_048_576
_LONGEST_LINE = 4096
#: What stands where in lines of VectorNav's, by its manual.
_KNOWN = {
    b"VNYMR": "ax=7:m/s2 ay=8:m/s2 az=9:m/s2 gx=10:rad/s gy=11:rad/s gz=12:rad/s",
    b"VNIMU": "ax=4:m/s2 ay=5:m/s2 az=6:m/s2 gx=7:rad/s gy=8:rad/s gz=9:rad/s temp=10:degc",
}


def checked_lines(path: Path, advance: Callable[[float], None] = lambda n: None) -> Table | None:
    """None where the first line is no such one. Columns are called 1, 2, 3, ... after the name;
    lines of other names are left out.

    Lines that fail their checksum are dropped and counted, and keep their place. Raises
    BadRecording.
    """
    first = head(path, _LONGEST_LINE)[0].split(b"\n")[0].strip()
    if not first.startswith(b"$") or first[-3:-2] != b"*":
        return None
    kind, *cells = first[1:-3].split(b",")
    names = [str(number) for number in range(1, len(cells) + 1)]

    def chunks(wanted: list[str]) -> Iterator[Chunk]:
        at = [int(name) for name in wanted]
        place = 0
        for lines in line_blocks(path, "utf-8", advance, _BLOCK_BYTES):
            ours = [line for line in lines.splitlines() if not _is_other(line, kind)]
            rows = [_row(line, kind, len(names), table.dropped) for line in ours]
            good = [number for number, row in enumerate(rows) if row is not None]
            cells = np.array([[row[i] for i in at] for row in rows if row is not None], float)
            by_name = dict(zip(wanted, cells.reshape(len(good), len(at)).T))
            yield Chunk(place + np.array(good, np.int64), by_name)
            place += len(ours)

    notes = [f"lines of ${kind.decode('ascii', 'replace')}"]
    table = Table(names, chunks, mapping=_KNOWN.get(kind, "").split(), notes=notes)
    return table


def _is_other(line: bytes, kind: bytes) -> bool:
    """Whether it is a whole line of another name."""
    text = line.strip()
    named = text[1:].split(b",")[0]
    return text[:1] == b"$" and named != kind and named.isalnum() and _checks(text)


def _checks(text: bytes) -> bool:
    try:
        return reduce(xor, text[1:-3], 0) == int(text[-2:], 16)
    except ValueError:
        return False


def _row(line: bytes, kind: bytes, cells: int, dropped: Counter[str]) -> list[float] | None:
    """A cell each with the name first, as NaN; None where the line is damaged."""
    text = line.strip(b"\r\n ")
    if text[:1] != b"$" or text[-3:-2] != b"*":
        dropped["no whole line"] += 1
    elif not _checks(text):
        dropped["the checksum fails"] += 1
    else:
        parts = text[1:-3].split(b",")
        if parts[0] == kind and len(parts) == cells + 1:
            return [_number(part) for part in parts]
        dropped["damaged (fields missing), though the checksum passes"] += 1
    return None


def _number(cell: bytes) -> float:
    try:
        return float(cell)
    except ValueError:
        return float("nan")
