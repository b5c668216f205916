"""One file that holds several recordings, cut into a file for each."""

from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from os import PathLike
from pathlib import Path

import numpy as np

from ..errors import BadRecording
from ..recordings import open_recording, recording_writer
from ..recordings.atomic import written_together
from ..recordings.reading import OpenRecording
from ..recordings.text import lines_of
from .tables.sentences import Rows
from .tables.sniffing import MARK, Form, sniffed


def cut(
    source: str | PathLike[str], rows: Sequence[int], folder: str | PathLike[str]
) -> list[Path]:
    """Write the stretches of a recording, or of a table of text, between rows as files of a folder.

    rows: 1-based data rows at which a new stretch begins. A stretch of a table has the lines of
    names before it, unless it begins with names of its own. Returns the files, NAME-1, NAME-2, ...
    Raises BadRecording, InFile.
    """
    path = Path(source)
    starts = [1, *sorted(set(rows) - {1})]
    try:
        opened = open_recording(path, keep_gaps=True)
    except BadRecording:
        if path.suffix == ".parquet":  # no table of text
            raise
        opened = None
    with written_together(folder) as draft:
        parts = (
            _of_table(path, starts, draft)
            if opened is None
            else _of_recording(opened, starts, draft)
        )
    return [Path(folder) / part.name for part in parts]


def _of_recording(opened: OpenRecording, starts: list[int], draft: Path) -> list[Path]:
    parts = [draft / f"{opened.name}-{number}.parquet" for number in range(1, len(starts) + 1)]
    done, counts = 0, np.zeros(len(parts), int)
    with ExitStack() as files:
        writers = [
            files.enter_context(recording_writer(p, opened.column_names, opened.scales))
            for p in parts
        ]
        for batch in opened.batches():
            rows = done + 1 + np.arange(len(batch["t_us"]))
            part = np.searchsorted(starts, rows, "right") - 1
            for number in np.unique(part):
                writers[number].append({n: v[part == number] for n, v in batch.items()})
            counts += np.bincount(part, minlength=len(parts))
            done += len(rows)
        _check_all(counts.tolist(), starts, opened.path)
    return parts


def _of_table(path: Path, starts: list[int], draft: Path) -> list[Path]:
    form = sniffed(path)
    head, lines = [], _lines(path, form)
    for _ in range(form.skip):
        head.append(next(lines, b""))
    stem = Path(path.name.removesuffix(".gz"))
    parts = [draft / f"{stem.stem}-{n}{stem.suffix or '.csv'}" for n in range(1, len(starts) + 1)]
    counts, row = [0] * len(parts), 0
    rows = Rows(form.kinds) if form.kinds else None
    with ExitStack() as files:
        out = [files.enter_context(open(part, "wb")) for part in parts]
        number = -1
        for line in lines:
            row = rows.begun(line) if rows else row + bool(line.strip())
            if number + 1 < len(starts) and row == starts[number + 1]:
                number += 1
                if not _is_names(line, form):
                    out[number].writelines(head)
            out[max(number, 0)].write(line)
            counts[max(number, 0)] += bool(line.strip())
    _check_all(counts, starts, path)
    return parts


def _is_names(line: bytes, form: Form) -> bool:
    """Whether a line of as many cells holds a name in each."""
    cells = [cell.strip() for cell in line.decode(errors="replace").split(form.delimiter)]
    return len(cells) == len(form.names) and all(cell[:1].isalpha() for cell in cells)


def _check_all(counts: list[int], starts: list[int], path: Path) -> None:
    """Raise BadRecording where a stretch has no row."""
    empty = next((at for at, count in zip(starts, counts) if not count), None)
    if empty is not None:
        do = f"name rows from 2 to {sum(counts)}"
        raise BadRecording(path, f"it has no row {empty}", do=do)


def _lines(path: Path, form: Form) -> Iterator[bytes]:
    """The lines as UTF-8, each with its end, without the mark before the first."""
    lines = lines_of(path, form.encoding)
    yield next(lines).removeprefix(MARK)
    yield from lines
