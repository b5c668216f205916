"""The whole way from a foreign file to a recording, in one pass over it and one over what it held.

At no time is more than some thousand rows in memory.
"""

import stat
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

import numpy as np

from ..errors import BadRecording, refuse_odd_name
from ..recordings import Recording, Scales, check_output, open_recording, recording_writer
from ..recordings.atomic import check_apart, no_room_said, written_together
from ..recordings.reading import recording_name, whole
from ..recordings.recording import ACCEL, COLUMNS, TIME
from .columns.guesses import FASTEST_DPS
from .columns.mapping import Mapped
from .columns.plan import Plan, left_aside, planned
from .kinds import table_of, table_of_files
from .report import Options, Report
from .samples import conversion
from .samples.between import refuse_two_recordings
from .samples.doubts import doubts
from .samples.gather import Gathered, gathered
from .tables.sensors import by_own_times, told_apart
from .tables.table import Table

Advance = Callable[[float], None]


@dataclass(frozen=True)
class _How:
    """What the user says of the sources beforehand."""

    options: Options
    mapping: Sequence[Mapped]
    units: Mapping[str, str] | None
    instance: int


@dataclass
class _Import:
    """A source that was read once: batches as a recording has them."""

    scales: Scales
    names: list[str]
    batches: Iterator[dict[str, np.ndarray]]
    report: Report


@dataclass
class _Source:
    """A foreign file whose rows lie in a spool, with all that is needed to make them integers."""

    path: Path
    table: Table
    plan: Plan
    found: Gathered
    options: Options


def import_recording(
    source: str | PathLike[str] | Sequence[str | PathLike[str]],
    out: str | PathLike[str],
    *,
    options: Options | None = None,
    mapping: Sequence[Mapped] = (),
    units: Mapping[str, str] | None = None,
    instance: int = 0,
    advance: Advance = lambda n: None,
) -> Report:
    """Convert a foreign file and write it as `out` (.parquet, .csv, .csv.gz); say what was lost.

    source: a file; or several, each with sensors of the one recording, by the time that they share.
    Takes at most 600 MB of memory, however large the file is. advance: called with the bytes of it
    that were read since it was called last. The other arguments are those of `read_foreign`.
    Raises BadRecording, MissingLibrary.
    """
    how = _How(options or Options(), mapping, units, instance)
    sources = [source] if isinstance(source, (str, PathLike)) else source
    return _imported([[Path(one) for one in sources]], [Path(out)], how, advance)[0]


def import_together(
    sources: Sequence[str | PathLike[str]],
    folder: str | PathLike[str],
    *,
    options: Options | None = None,
    mapping: Sequence[Mapped] = (),
    units: Mapping[str, str] | None = None,
    instance: int = 0,
    advance: Advance = lambda n: None,
) -> dict[Path, Report]:
    """Convert foreign files of one device, each to NAME.parquet in a folder, all in one scale.

    The arguments are those of `import_recording`. Raises BadRecording, MissingLibrary, and InFile
    where the folder cannot be written; then none is written.
    """
    paths = [Path(source) for source in sources]
    names = [f"{Path(path.name.removesuffix('.gz')).stem}.parquet" for path in paths]
    how = _How(options or Options(), mapping, units, instance)
    check_apart([Path(folder) / name for name in names], paths)
    with written_together(folder) as draft:
        outs = [draft / name for name in names]
        reports = _imported([[path] for path in paths], outs, how, advance)
    return {Path(folder) / name: report for name, report in zip(names, reports)}


def read_foreign(
    source: str | PathLike[str],
    *,
    options: Options | None = None,
    mapping: Sequence[Mapped] = (),
    units: Mapping[str, str] | None = None,
    instance: int = 0,
) -> tuple[Recording, Report]:
    """Read a foreign file into memory: a table, a flight log, a ROS bag, or this form itself.

    mapping: columns of a table and their units; units: by kind (time, gyro, accel, temp) where the
    mapping has none; instance: which of several sensors in a log.
    An extra channel is `recordings.checks.GAP` where the source has no value.
    Raises BadRecording, MissingLibrary.
    """
    path = Path(source)
    how = _How(options or Options(), mapping, units, instance)
    with ExitStack() as files:
        one = _ready([_opened([path], how, lambda n: None, None, files)])[0]
        columns = whole(one.batches, one.names, path)
    return Recording(columns, one.scales, recording_name(path)), one.report


def _require(path: Path) -> None:
    """Raise BadRecording for what is neither a file nor a folder: a pipe would be waited for."""
    refuse_odd_name(path)
    try:
        kind = path.stat().st_mode
    except OSError as error:
        problem = error.strerror or str(error)
        problem = "no such file" if isinstance(error, FileNotFoundError) else problem
        raise BadRecording(path, problem, do="name a file to import") from error
    if not stat.S_ISREG(kind) and not stat.S_ISDIR(kind):
        raise BadRecording(path, "neither a file nor a folder", do="copy it into a file first")


def _imported(
    sources: list[list[Path]], outs: list[Path], how: _How, advance: Advance
) -> list[Report]:
    """sources: the files of each recording."""
    every = [path for files in sources for path in files]
    for source in every:
        _require(source)
    for out in outs:
        check_output(out)
    check_apart(outs, every)
    folder = outs[0].absolute().parent
    with no_room_said(outs[0], "make room, or name another folder"), ExitStack() as files:
        opened = [_opened(source, how, advance, folder, files) for source in sources]
        ready = _ready(opened)
        writers = [
            files.enter_context(recording_writer(out, one.names, one.scales))
            for out, one in zip(outs, ready)
        ]
        for writer, one in zip(writers, ready):
            for batch in one.batches:
                writer.append(batch)
    return [one.report for one in ready]


def _opened(
    paths: list[Path], how: _How, advance: Advance, folder: Path | None, files: ExitStack
) -> _Import | _Source:
    """files: closes what lies in a spool."""
    for path in paths:
        _require(path)
        if path.is_file() and path.stat().st_size == 0:
            raise BadRecording(path, "empty file", do="name another file")
    path, *others = paths
    own = None if how.mapping or others else _own_form(path, how)
    if own is not None:
        return own
    read = table_of_files(paths, advance) if others else table_of(path, how.instance, advance)
    with read as table:
        source = _gathered(table, path, how, folder)
    files.callback(source.found.spool.close)
    return source


def _gathered(table: Table, path: Path, how: _How, folder: Path | None) -> _Source:
    table, instance = told_apart(by_own_times(table), how.instance, path)
    options = how.options
    plan = planned(
        *(table, how.mapping, path),
        units=how.units,
        instance=instance,
        without_time=options.hz is not None,
    )
    options = conversion.without_wide_counts(plan, options)
    raw = "gyro" in plan.raw
    fast_dps = np.inf if raw or options.gyro_lsb_per_dps else FASTEST_DPS
    found = gathered(table, plan, path, hz=options.hz, fast_dps=fast_dps, folder=folder)
    if table.parts > 1:
        refuse_two_recordings(found.spool, path, found.counted)
    return _Source(path, table, plan, found, options)


def _ready(opened: list[_Import | _Source]) -> list[_Import]:
    """Each as integers, all that were read in one scale."""
    common = conversion.Common([one.found for one in opened if isinstance(one, _Source)])
    return [one if isinstance(one, _Import) else _converted(one, common) for one in opened]


def _converted(source: _Source, common: conversion.Common) -> _Import:
    path, table, plan, found = source.path, source.table, source.plan, source.found
    report = Report(found.rows, dropped=found.dropped, notes=found.notes)
    _leave_out_unread(found, plan, report)
    scales = conversion.fitting_scales(
        found, common, plan, table, source.options, path, report.notes
    )
    report.doubts += doubts(found, plan, table, scales, path)
    report.notes += [*conversion.absent(plan, table.names, path), *left_aside(plan, table)]
    names = [n for n in COLUMNS if n in found.spool.names]
    names += [n for n in plan.wanted if n not in COLUMNS]
    batches = conversion.integer_batches(found, plan, scales, path, report)
    return _Import(scales, names, batches, report)


def _leave_out_unread(found: Gathered, plan: Plan, report: Report) -> None:
    """Take columns away in which no cell is a number."""
    read = {TIME, *(name for piece in found.spool.pieces for name in piece.ends)}
    unread = [name for name in plan.wanted if name not in read]
    if any(name in ACCEL for name in unread):
        unread = [*dict.fromkeys([*unread, *ACCEL])]
    for name in unread:
        column = plan.wanted.pop(name).column
        found.spool.names.remove(name)
        report.notes.append(f"column {column!r} left out: no number is in it")


def _own_form(path: Path, how: _How) -> _Import | None:
    try:
        opened = open_recording(path, keep_gaps=True)
    except BadRecording:
        return None
    note = "a recording in this form already"
    note += ": its own scales and times are kept" if how.options != Options() or how.units else ""
    report = Report(notes=[note], odr_hz=opened.scales.odr_hz)

    def batches() -> Iterator[dict[str, np.ndarray]]:
        ends_us: list[int] = []
        for batch in opened.batches():
            ends_us += batch["t_us"][[0, -1]].tolist()
            report.rows_read += len(batch["t_us"])
            yield batch
        report.rows_written = report.rows_read
        report.duration_s = (ends_us[-1] - ends_us[0]) * 1e-6

    return _Import(opened.scales, opened.column_names, batches(), report)
