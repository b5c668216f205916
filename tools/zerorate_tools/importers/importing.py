"""Which reader a file needs, and the whole way from it to a recording on disk."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from os import PathLike
from pathlib import Path

from ..errors import BadRecording
from ..recordings import Recording, check_output, open_recording, read_recording, write_recording
from ..recordings.reading import recording_name
from . import layouts
from .conversion import Options, Report, converted
from .mapping import Mapped, foreign_from_table
from .table import read_table


def import_recording(
    source: str | PathLike[str],
    out: str | PathLike[str],
    *,
    options: Options | None = None,
    mapping: Sequence[Mapped] = (),
    units: Mapping[str, str] | None = None,
    layout: str | None = None,
    instance: int = 0,
) -> Report:
    """Convert a foreign file and write it as `out` (.parquet, .csv, .csv.gz); say what was lost.

    The arguments are those of `read_foreign`. Raises BadRecording, MissingLibrary.
    """
    check_output(out)
    recording, report = read_foreign(
        source, options=options, mapping=mapping, units=units, layout=layout, instance=instance
    )
    write_recording(recording, out)
    return report


def read_foreign(
    source: str | PathLike[str],
    *,
    options: Options | None = None,
    mapping: Sequence[Mapped] = (),
    units: Mapping[str, str] | None = None,
    layout: str | None = None,
    instance: int = 0,
) -> tuple[Recording, Report]:
    """Read ULog (.ulg), DataFlash (.bin, .log), a table with a mapping, or this form itself.

    mapping: columns of a table and their units; units: by kind (time, gyro, accel, temp) where the
    mapping has none; layout: one of `layouts.NAMES` instead of recognising it, or "table" to
    recognise none; instance: which of several sensors in a flight log.
    An extra channel is `recordings.checks.GAP` where the source has no value.
    Raises BadRecording, MissingLibrary.
    """
    path = Path(source)
    if not path.is_file():
        what = "is a folder" if path.is_dir() else "no such file"
        raise BadRecording(path, what, do="name a file to import")
    if path.stat().st_size == 0:
        raise BadRecording(path, "empty file", do="name another file")
    if layout is None and not mapping and (own := _own_form(path)) is not None:
        return own, Report(len(own), len(own), notes=["a recording in this form already"])
    foreign = _read(path, mapping, units, layout, instance)
    recording, report = converted(foreign, options or Options(), path)
    recording.name = recording_name(path)
    return recording, report


def _own_form(path: Path) -> Recording | None:
    try:
        open_recording(path)
    except BadRecording:
        return None
    return read_recording(path, keep_gaps=True)


def _read(path: Path, mapping, units, layout: str | None, instance: int):
    if layout is None and not mapping:
        layout = layouts.recognised(path)
    if layout not in (None, "table", *layouts.NAMES):
        do = f"choose of table, {', '.join(layouts.NAMES)}"
        raise BadRecording(path, f"there is no layout {layout!r}", do=do)
    if layout not in (None, "table"):
        if not layouts.layout(layout).recognises(path):
            raise BadRecording(path, f"not of layout {layout}", do="leave --layout out")
        foreign = layouts.layout(layout).read(path)
        foreign.notes.insert(0, f"recognised as {layout}")
        return foreign
    suffix = path.suffix.lower()
    if suffix in (".ulg", ".ulog"):
        from .ulog import read_ulog

        return read_ulog(path, instance)
    if suffix in (".bin", ".log"):
        from .dataflash import read_dataflash

        return read_dataflash(path, instance)
    return foreign_from_table(read_table(path), mapping, path, units)
