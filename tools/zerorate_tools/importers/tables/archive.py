"""Several files as one recording: a zip, or a folder, with a table for each sensor of a phone."""

import re
import tempfile
import zipfile
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from itertools import zip_longest
from pathlib import Path

import numpy as np

from ...errors import BadRecording
from ...numbers import listed
from ..columns import names as usual
from ..columns.guesses import likely_columns, only_grows
from .table import Chunk, Table

_TABLES = (".csv", ".txt", ".tsv", ".dat", ".mat")
#: No log packs so well: deflate takes 1,032 bytes to one at its best, a table 20.
_MOST_UNPACKED = 300
_TOLD = 8
_PER_SENSOR = re.compile("gyro|acc(?!ur)|angular|rotation|temp", re.I)


@contextmanager
def archive(path: Path) -> Iterator[Path]:
    """The unpacked folder of a zip, or its only file. Raises BadRecording."""
    with tempfile.TemporaryDirectory() as folder:
        try:
            found = _unpacked(path, folder)
        except BadRecording:
            raise
        except Exception as error:  # of a damaged one, whatever its parser stumbles over
            do = "unpack it, and import what is in it"
            raise BadRecording(path, f"it cannot be unpacked ({error})", do=do) from error
        if not found:
            raise BadRecording(path, "an empty zip", do="name another file")
        yield found[0] if len(found) == 1 else Path(folder)


def _unpacked(path: Path, folder: str) -> list[Path]:
    with zipfile.ZipFile(path) as packed:
        members = [m for m in packed.infolist() if not m.is_dir() and not _is_hidden(m.filename)]
        if any(member.filename == "[Content_Types].xml" for member in members):
            raise BadRecording(path, "a spreadsheet", do="save its table as CSV")
        if sum(m.file_size for m in members) > _MOST_UNPACKED * max(1, path.stat().st_size):
            problem = f"it unpacks to more than {_MOST_UNPACKED} times its size, as no log does"
            raise BadRecording(path, problem, do="unpack it, and import what is in it")
        return [Path(packed.extract(member, folder)) for member in members]


def _is_hidden(name: str) -> bool:
    """What a Mac or an editor puts beside files."""
    return any(part.startswith((".", "__MACOSX")) for part in Path(name).parts)


def folder_of_tables(
    path: Path, opened: Callable[[Path], Table], said: Path | None = None
) -> Table:
    """The tables of a folder beside each other, by the time that they share. Raises BadRecording.

    Columns get the name of their file before their own: `Gyroscope x`. A chunk holds rows of each
    file. opened: reads a file; said: the file that the folder was unpacked from.
    """
    found = list(_tables_in(path, opened))
    tables = {file.stem: table for file, table in found if _is_of_sensors(table, file)}
    path = said or path
    if not _hold_rates(tables):
        rates = [one for one in found if usual.gyro_groups(one[1].names)]
        rates += [one for one in found if usual.unnamed(one[1].names) and likely_columns(one[1])]
        if len(rates) == 1:
            (file, table), *_ = rates
            table.notes.append(f"of the table {file.name} alone")
            return table
    if not tables:
        held = ", ".join(file.name for file, _ in (rates or found)[:_TOLD])
        problem = "several tables that may hold rates" if rates else "no table with rates in it"
        one_of = f" in {held}" if held else ""
        if len(rates) > _TOLD and all(_is_row(table) for _, table in rates[:_TOLD]):
            problem = f"{len(rates)} files of one row, as KITTI writes"
            do = f"write the rows into one file: cat FOLDER/*{rates[0][0].suffix} > all.txt"
            raise BadRecording(path, problem, do=do)
        do = f"name a file{one_of}, or the folder of a ROS 2 bag or of a phone's tables"
        raise BadRecording(path, problem, do=do)
    return _by_shared_time(tables, path)


def tables_of_sensors(files: Sequence[Path], opened: Callable[[Path], Table]) -> Table:
    """As `folder_of_tables`, of these files and no others. Raises BadRecording."""
    tables: dict[str, Table] = {}
    for file in files:
        if file.stem in tables:
            raise BadRecording(file, "two files of that name", do="give one of them another name")
        tables[file.stem] = opened(file)
    if not _hold_rates(tables):
        bare = next((f for f in files if usual.unnamed(tables[f.stem].names)), None)
        if bare:
            do = "write a line of names above each table, as time_s,x,y,z"
            raise BadRecording(bare, "its columns have no names", do=do)
        do = "name the file with the rates, too; or a folder after --out: each is a recording then"
        raise BadRecording(files[0], "no table with rates in it, nor in the others", do=do)
    return _by_shared_time(tables, files[0])


def with_axes(table: Table, file: Path) -> Table:
    """A sensor's table of a time and three axes, or a temperature, with names if it has none."""
    if not usual.unnamed(table.names) or not _PER_SENSOR.search(file.stem):
        return table
    times = [name for name, values in table.first_rows(table.names).items() if only_grows(values)]
    axes = ("temp",) if "temp" in file.stem.lower() else "xyz"
    own = dict(zip(("time", *axes), [*times, *(n for n in table.names if n not in times)]))
    if len(times) != 1 or len(table.names) != len(own):
        return table

    def chunks(wanted: list[str]) -> Iterator[Chunk]:
        for chunk in table.chunks([own[name] for name in wanted]):
            yield Chunk(chunk.place, {name: chunk.columns[own[name]] for name in wanted})

    calendar = frozenset(name for name in own if own[name] in table.calendar)
    return replace(table, names=[*own], chunks=chunks, calendar=calendar, notes=[])


def _is_row(table: Table) -> bool:
    return len(table.first_rows(table.names[:1]).get(table.names[0], ())) == 1


def _hold_rates(tables: dict[str, Table]) -> bool:
    named = (table.names for stem, table in tables.items() if "gyro" in stem.lower())
    by_file = any(map(usual.bare_axes, named))
    return by_file or any(usual.gyro_groups(table.names) for table in tables.values())


def _by_shared_time(tables: dict[str, Table], path: Path) -> Table:
    rates = [stem for stem, table in tables.items() if usual.gyro_groups(table.names)]
    if len(rates) > 1 and not any("gyro" in stem.lower() for stem in rates):
        problem = f"several recordings ({listed(rates, _TOLD)})"
        do = "import them together: zerorate import FILE FILE ... --out FOLDER"
        raise BadRecording(path, problem, do=do)
    times = Counter(name for t in tables.values() for name in usual.time_columns(t.names))
    shared = [name for name, count in times.items() if count == len(tables)]
    if times and not shared:
        do = "name their times alike; or, if each row is one sample, take the times out: --hz N"
        raise BadRecording(path, f"the tables {', '.join(tables)} share no time", do=do)
    return _together(tables, shared)


def _tables_in(path: Path, opened: Callable[[Path], Table]) -> Iterator[tuple[Path, Table]]:
    for file in sorted(path.rglob("*")):
        hidden = _is_hidden(str(file.relative_to(path)))
        if file.suffix.lower() in _TABLES and not hidden and file.is_file():  # a pipe has no end
            try:
                yield file, opened(file)
            except BadRecording:  # a note, a setting
                continue


def _is_of_sensors(table: Table, file: Path) -> bool:
    named = any(map(_PER_SENSOR.search, [file.stem, *table.names]))
    return bool(usual.time_columns(table.names)) and (named or bool(usual.gyro_groups(table.names)))


def _together(tables: dict[str, Table], shared: list[str]) -> Table:
    """shared: columns of times; where there are none, rows of one number are of one time."""
    own = {
        (stem, name): name if usual.spelled(stem) in usual.spelled(name) else f"{stem} {name}"
        for stem, table in tables.items()
        for name in table.names
        if name not in shared
    }

    def of_one(stem: str, table: Table, wanted: list[str]) -> Iterator[Chunk]:
        ours = {n: own[stem, n] for n in table.names if own.get((stem, n)) in wanted}
        times = [n for n in wanted if n in shared]
        with table.looked_at() as read:
            for chunk in read([*times, *ours]) if ours or times == wanted else ():
                out = dict.fromkeys(wanted, np.full(len(chunk.place), np.nan))
                out |= {n: chunk.columns[n] for n in times}
                yield Chunk(chunk.place, out | {said: chunk.columns[n] for n, said in ours.items()})
            both.dropped.update(table.dropped)

    def chunks(wanted: list[str]) -> Iterator[Chunk]:
        turns = [of_one(stem, table, wanted) for stem, table in tables.items()]
        for some in zip_longest(*turns):
            of = [one for one in some if one]
            columns = {n: np.concatenate([one.columns[n] for one in of]) for n in wanted}
            yield Chunk(np.concatenate([one.place for one in of]), columns)

    calendar = frozenset(
        own.get((stem, name), name) for stem, table in tables.items() for name in table.calendar
    )
    note = f"of the tables {', '.join(tables)}"
    both = Table(
        [*shared, *own.values()], chunks, calendar=calendar, notes=[note], parts=len(tables)
    )
    return both
