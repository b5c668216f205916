"""A recording while it is made: a CSV beside, whole to its last row whatever ends the program.

Of `run.parquet` it is `run.partial.csv` with its scales in `run.partial.json`, an ordinary
recording that any command reads. Nobody removes it but who wrote it, when `run.parquet` is there,
and `recover`, which does the same for one whose writer was killed.
"""

import json
import os
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager, suppress
from io import FileIO
from os import PathLike
from pathlib import Path

from ..ending import undisturbed
from ..errors import BadRecording, InFile
from . import csv_format
from .atomic import check_name
from .csv_format import is_unfinished, names_for, stem, unfinished_of
from .drafts import lock
from .reading import open_recording
from .recording import Columns
from .scales import Scales, check_whole
from .writing import check_output, recording_writer

_BLOCK = 65_536


@contextmanager
def growing_recording(
    out: str | PathLike[str], names: list[str], scales: Scales
) -> Iterator["GrowingRecording"]:
    """Yield a recording to append to; when the block ends, however it does, `out` is made of it.

    An older `out` stays where no row came. Raises BadRecording as recording_writer does; InFile
    where there is no more room, which says where the rows are.
    """
    out = Path(out)
    try:
        growing = GrowingRecording(out, names, scales)
    except OSError as error:
        why = os.strerror(error.errno) if error.errno else error
        do = "name another folder, or make room"
        raise InFile(out, f"cannot be written: {why}", do=do) from error
    try:
        yield growing
    finally:
        growing.finish()


class GrowingRecording:
    """Rows in a file of their own: path; rows: how many are in it."""

    def __init__(self, out: Path, names: list[str], scales: Scales) -> None:
        _check_name(out)
        check_whole(scales.to_json(), names, out)
        self._out, self._names = out, names
        self.path, self._file = _created(out, json.dumps(scales.to_json(), indent=2) + "\n")
        self.rows = self._whole = 0
        self._disk = ThreadPoolExecutor(1)
        self._synced: Future[None] | None = None
        lock(self._file.fileno())
        try:
            self._write(",".join(names) + "\n")
        except OSError:
            self.finish()
            raise

    def append(self, columns: Columns) -> None:
        """Write one batch of equally long columns at once. Raises InFile, and none is written."""
        rows = list(zip(*(columns[name].tolist() for name in self._names)))
        try:
            self._write("".join(",".join(map(str, row)) + "\n" for row in rows))
        except OSError as error:
            problem = f"no more can be written: {os.strerror(error.errno or 0)}"
            do = f"the {self.rows} samples before are kept" if self.rows else "make room"
            raise InFile(self._out, problem, do=do) from error
        self.rows += len(rows)

    def _write(self, text: str) -> None:
        data = memoryview(text.encode())
        self._whole += len(data)
        try:
            while data:
                data = data[self._file.write(data) :]
            self._sync()
        except OSError:
            # what is whole stays
            self._whole -= len(text)
            self._file.truncate(self._whole)
            self._file.seek(self._whole)
            raise

    def _sync(self) -> None:
        """To the disk, in case the power goes; not waited for, as the chip does not wait."""
        if self._synced is None or self._synced.done():
            if self._synced is not None:
                self._synced.result()
            self._synced = self._disk.submit(os.fsync, self._file.fileno())

    def finish(self) -> bool:
        """Whether there were rows: the recording is then under its name, and nothing beside.

        Signals wait for it. Raises InFile, and the rows stay where they are, without room for it.
        """
        self._disk.shutdown()
        with undisturbed():
            try:
                if self.rows:
                    _written(self.path, self._out)
            except InFile as error:
                self._file.close()
                raise _not_finished(self.path, self._out, error) from error
            self._file.close()
            _remove(self.path)
        return bool(self.rows)


def recover(partial: str | PathLike[str], out: str | PathLike[str] | None = None) -> Path:
    """Finish what a killed recorder left, as `out` or under the name it was to have; that name.

    A last row that was cut off is left out. Without `out` nothing is written over.
    Raises BadRecording for what is none of them, or is still being written; InFile.
    """
    partial = Path(partial)
    with _taken(partial) as file:
        target = Path(out) if out is not None else _target(partial)
        _check_name(target)
        file.truncate(_end_of_last_row(file))
        file.seek(0)
        if not file.read(_BLOCK).partition(b"\n")[2]:
            raise BadRecording(partial, "no sample was recorded", do="delete it")
        try:
            _written(partial, target)
        except InFile as error:
            raise _not_finished(partial, target, error) from error
    _remove(partial)
    return target


def left_over(out: Path) -> list[Path]:
    """What killed recorders left of `out`, the newest last. Raises BadRecording for its name."""
    _check_name(out)
    found = []
    for path in unfinished_of(out):
        with suppress(BadRecording), _taken(path):
            found.append(path)
    return found


def _check_name(out: Path) -> None:
    check_output(out)
    if is_unfinished(out):
        problem = "this name is kept for recordings that are not finished"
        raise BadRecording(out, problem, do="leave out .partial")


def _created(out: Path, scales: str) -> tuple[Path, FileIO]:
    """A partial file of the first name that is free, its scales beside."""
    for path in names_for(out):
        check_name(path)
        beside = csv_format.scales_path(path)
        if path.exists():
            continue
        try:
            with beside.open("x", encoding="utf-8") as file:
                file.write(scales)
            return path, FileIO(path, "x")
        except FileExistsError:
            continue
        except OSError:
            beside.unlink(missing_ok=True)
            raise
    raise AssertionError


def _written(partial: Path, out: Path) -> None:
    recording = open_recording(partial)
    with recording_writer(out, recording.column_names, recording.scales) as writer:
        for columns in recording.batches():
            writer.append(columns)


def _remove(partial: Path) -> None:
    with suppress(OSError):
        partial.unlink()
        csv_format.scales_path(partial).unlink()


def _not_finished(partial: Path, out: Path, error: InFile) -> InFile:
    problem = f"is all that was recorded, for {out} {error.problem}"
    do = f"make room, then zerorate record --recover {partial} --out FILE"
    return InFile(partial, problem, do=do)


def _target(partial: Path) -> Path:
    target = partial.with_name(f"{stem(partial)}.parquet")
    if target.exists():
        raise BadRecording(partial, f"{target} is there already", do="name another by --out")
    return target


@contextmanager
def _taken(partial: Path) -> Iterator[FileIO]:
    """The partial file, opened and locked."""
    if not is_unfinished(partial):
        do = "name a file as run.partial.csv; zerorate import converts others"
        raise BadRecording(partial, "nothing that `zerorate record` leaves behind", do=do)
    try:
        file = FileIO(partial, "r+")
    except OSError as error:
        problem = f"cannot be opened: {os.strerror(error.errno or 0)}"
        raise BadRecording(partial, problem, do="name the file that was left") from error
    with file:
        try:
            lock(file.fileno())
        except BlockingIOError as error:
            do = "end that first, by Ctrl-C or SIGTERM"
            raise BadRecording(partial, "is still being recorded", do=do) from error
        yield file


def _end_of_last_row(file: FileIO) -> int:
    end = file.seek(0, os.SEEK_END)
    while end:
        start = max(0, end - _BLOCK)
        file.seek(start)
        at = file.read(end - start).rfind(b"\n")
        if at >= 0:
            return start + at + 1
        end = start
    return 0
