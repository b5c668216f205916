"""The whole way from a foreign file to a recording, in one pass over it and one over what it held.

At no time is more than some thousand rows in memory.
"""

import errno
import stat
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

import numpy as np

from ..errors import BadRecording, refuse_odd_name
from ..recordings import Recording, Scales, check_output, open_recording, recording_writer
from ..recordings.atomic import check_apart
from ..recordings.reading import recording_name, whole
from ..recordings.recording import ACCEL, COLUMNS
from .columns.mapping import Mapped
from .columns.plan import left_aside, planned
from .kinds import table_of
from .report import Options, Report
from .samples.conversion import absent, fitting_scales, integer_batches
from .samples.doubts import FASTEST_DPS, doubts
from .samples.gather import Gathered, gathered

Advance = Callable[[float], None]


@dataclass
class _Import:
    """A source that was read once: batches as a recording has them."""

    scales: Scales
    names: list[str]
    batches: Iterator[dict[str, np.ndarray]]
    report: Report


def import_recording(
    source: str | PathLike[str],
    out: str | PathLike[str],
    *,
    options: Options | None = None,
    mapping: Sequence[Mapped] = (),
    units: Mapping[str, str] | None = None,
    instance: int = 0,
    advance: Advance = lambda n: None,
) -> Report:
    """Convert a foreign file and write it as `out` (.parquet, .csv, .csv.gz); say what was lost.

    Takes at most 600 MB of memory, however large the file is. advance: called with the bytes of it
    that were read since it was called last. The other arguments are those of `read_foreign`.
    Raises BadRecording, MissingLibrary.
    """
    _require(Path(source))
    check_output(out)
    check_apart([out], [source])
    folder = Path(out).resolve().parent
    with _opened(Path(source), options, mapping, units, instance, advance, folder) as one:
        with recording_writer(out, one.names, one.scales) as writer:
            for batch in one.batches:
                writer.append(batch)
    return one.report


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
    with _opened(path, options, mapping, units, instance, lambda n: None, None) as one:
        columns = whole(one.batches, one.names, path)
    return Recording(columns, one.scales, recording_name(path)), one.report


def _require(path: Path) -> None:
    """Raise BadRecording for what is neither a file nor a folder: a pipe would be waited for."""
    refuse_odd_name(path)
    try:
        kind = path.stat().st_mode
    except OSError as error:
        problem = "no such file" if error.errno == errno.ENOENT else error.strerror or str(error)
        raise BadRecording(path, problem, do="name a file to import") from error
    if not stat.S_ISREG(kind) and not stat.S_ISDIR(kind):
        raise BadRecording(path, "neither a file nor a folder", do="copy it into a file first")


@contextmanager
def _opened(path, options, mapping, units, instance, advance: Advance, folder) -> Iterator[_Import]:
    _require(path)
    if path.is_file() and path.stat().st_size == 0:
        raise BadRecording(path, "empty file", do="name another file")
    own = None if mapping else _own_form(path)
    if own is not None:
        yield own
        return
    with table_of(path, instance, advance) as table:
        found, one = _converted(table, path, options or Options(), mapping, units, instance, folder)
        try:
            yield one
        finally:
            found.spool.close()


def _converted(table, path, options: Options, mapping, units, instance, folder):
    plan = planned(
        table, mapping, path, units=units, instance=instance, without_time=options.hz is not None
    )
    raw = "gyro" in plan.raw
    fast_dps = np.inf if raw or options.gyro_lsb_per_dps else FASTEST_DPS
    found = gathered(table, plan, path, hz=options.hz, fast_dps=fast_dps, folder=folder)
    try:
        report = Report(found.rows, dropped=found.dropped, notes=found.notes)
        _leave_out_unread(found, plan, report)
        report.doubts += doubts(found, plan)
        scales = fitting_scales(found, plan, table, options, path, report.notes)
        report.notes += [*absent(plan, table.names), *left_aside(plan, table)]
        names = [n for n in COLUMNS if n in found.spool.names]
        names += [n for n in plan.wanted if n not in COLUMNS]
        batches = integer_batches(found, plan, scales, path, report)
    except BaseException:
        found.spool.close()
        raise
    return found, _Import(scales, names, batches, report)


def _leave_out_unread(found: Gathered, plan, report: Report) -> None:
    """Take columns away in which no cell is a number."""
    read = {name for piece in found.spool.pieces for name in piece.ends}
    unread = [name for name in plan.wanted if name in found.own and name not in read]
    if any(name in ACCEL for name in unread):
        unread = [*dict.fromkeys([*unread, *ACCEL])]
    for name in unread:
        column = plan.wanted.pop(name).column
        found.spool.names.remove(name)
        report.notes.append(f"column {column!r} left out: no number is in it")


def _own_form(path: Path) -> _Import | None:
    try:
        opened = open_recording(path, keep_gaps=True)
    except BadRecording:
        return None
    report = Report(notes=["a recording in this form already"], odr_hz=opened.scales.odr_hz)

    def batches() -> Iterator[dict[str, np.ndarray]]:
        first = last = None
        for batch in opened.batches():
            first, last = batch["t_us"][0] if first is None else first, batch["t_us"][-1]
            report.rows_read += len(batch["t_us"])
            yield batch
        report.rows_written = report.rows_read
        report.duration_s = 0.0 if first is None else float(last - first) * 1e-6

    return _Import(opened.scales, opened.column_names, batches(), report)
