"""`watch`: follow a growing CSV, or what a board or a Linux bus streams, until told to end."""

import io
import re
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.csv

from ..boards.recorder import COLUMNS, Recorder
from ..boards.recording import FAKE, stream
from ..errors import BadRecording
from ..recordings import Scales, csv_format, open_recording
from ..recordings.checks import check_names
from ..recordings.csv_format import unfinished_of
from ..recordings.recording import Columns
from .live import Live, watch_own
from .screen import Screen, Shown, WatchOptions, screen

_MOST_BYTES = 1_048_576
#: What is read only when it is finished -> why.
_WHOLE_ALONE = {
    ".parquet": "a Parquet file has its index at its end, so it cannot be read while it grows",
    ".gz": "gzip holds rows back until a block of them is full",
}


def growing_file(path: Path) -> Path:
    """The file to follow for a recording of this name.

    While `zerorate record` makes it, it is the CSV beside (recordings.growing). Raises BadRecording
    for what cannot be followed.
    """
    if not path.is_file() and (unfinished := unfinished_of(path)):
        return unfinished[-1]
    for ending, problem in _WHOLE_ALONE.items():
        if path.name.endswith(ending):
            do = "record to .csv, or add --once when it is finished"
            raise BadRecording(path, problem, do=do)
    if not path.is_file():
        do = "name a .csv that is being written, a board's port or /dev/i2c-N"
        raise BadRecording(path, "is a folder" if path.is_dir() else "no such file", do=do)
    return path


_INTEGER = re.compile(rb"\s*-?\d{1,18}\s*")  # so many digits fit 64 bits


class CsvTail:
    """Reads the rows of a growing CSV, each once; the last one only when its line has ended.

    scales, column_names: as of OpenRecording; bad_rows: rows left out because they are no rows of
    integers; restarts: times that the file became shorter and was read from its beginning.
    """

    def __init__(self, path: Path) -> None:
        self.path = growing_file(path)
        self.name = path.name
        self.column_names = csv_format.read_header(self.path).names
        check_names(self.column_names, self.path)
        self.scales = csv_format.read_scales(self.path, self.column_names)
        self.bad_rows = self.restarts = 0
        self._begin()

    def _begin(self) -> None:
        self._offset, self._rest, self._is_header = 0, b"", True

    def read(self) -> Columns | None:
        """Columns of the rows that came since, at most a megabyte of them; None without any.

        Raises BadRecording when the file is gone.
        """
        data = self._new_bytes()
        whole, end, self._rest = data.rpartition(b"\n")
        if self._is_header and end:
            _, _, whole = whole.partition(b"\n")
            self._is_header = False
        return self._columns(whole) if whole else None

    def _new_bytes(self) -> bytes:
        try:
            with self.path.open("rb") as file:
                if file.seek(0, io.SEEK_END) < self._offset:
                    self.restarts += 1
                    self._begin()
                file.seek(self._offset)
                data = file.read(_MOST_BYTES)
        except FileNotFoundError as error:
            raise BadRecording(self.path, "the file is gone", do="watch another") from error
        self._offset += len(data)
        return self._rest + data

    def _columns(self, rows: bytes) -> Columns | None:
        try:
            return _parsed(rows, self.column_names)
        except pa.ArrowInvalid:
            good = [row for row in rows.splitlines() if self._is_row(row)]
            return _parsed(b"\n".join(good), self.column_names) if good else None

    def _is_row(self, row: bytes) -> bool:
        cells = row.split(b",")
        good = len(cells) == len(self.column_names) and all(map(_INTEGER.fullmatch, cells))
        self.bad_rows += not good and bool(row.strip())
        return good


def _parsed(rows: bytes, names: list[str]) -> Columns:
    table = pyarrow.csv.read_csv(
        io.BytesIO(rows),
        read_options=pyarrow.csv.ReadOptions(column_names=names, use_threads=False),
        convert_options=pyarrow.csv.ConvertOptions(
            column_types={name: pa.int64() for name in names}, null_values=[]
        ),
    )
    return {name: table[name].to_numpy() for name in names}


_PATIENCE_S = 0.25


class Watcher(Recorder):
    """Shows samples through the firmware instead of keeping them.

    In doubt or not, all are given to it: its guard is there to judge them.
    """

    def __init__(self, source: str, scales: Scales, options: WatchOptions, shown: Screen) -> None:
        super().__init__([], 1.0)
        self.live = Live(source, scales, COLUMNS, options.settings, options.model)
        self._shown, self._every_s = shown, options.seconds_between_looks(shown)
        self._rows: list[tuple[int, ...]] = []
        self._fed = self._looked = time.monotonic()

    def add(self, t_us: int, sample: Sequence[int]) -> None:
        """One sample of seven words."""
        self._rows.append((t_us, *sample))
        if time.monotonic() - self._fed > _PATIENCE_S:
            self.flush()

    def flush(self) -> None:
        """Hand to the firmware what waits, and show it when it is time."""
        self._fed = time.monotonic()
        if self._rows:
            rows = np.array(self._rows, np.int64)
            self._rows.clear()
            self.live.feed(dict(zip(COLUMNS, rows.T)))
        if self._fed - self._looked > self._every_s:
            self.look()

    def look(self) -> None:
        """Show what there is."""
        self._looked = time.monotonic()
        self._shown.show(self.live, [])


def watch_board(source: str, options: WatchOptions) -> Live | None:
    """Watch a board's port or a Linux bus: see `watch`."""
    made: list[Watcher] = []
    more = {"setup": options.setup} if options.setup else {}
    with screen(options.plain) as shown:

        def take(scales: Scales) -> Watcher:
            made.append(Watcher(source, scales, options, shown))
            return made[0]

        seconds = 1.0 if options.once and options.seconds is None else options.seconds
        stream(source, take, seconds=seconds, done=lambda _: made[0].flush(), **more)
        made[0].flush()
        made[0].look()
        return made[0].live if made[0].live.samples else None


_DEVICE = re.compile(r"/dev/.+|COM\d+|\d+")
_POLL_S = 0.1
_STALLED_S = 3.0
_STALLED_SAMPLES = 20


def watch(source: str, options: WatchOptions | None = None) -> Shown | None:
    """Run the firmware on what comes from a growing CSV, a board's port or a bus, and show it.

    With `once` a finished recording of any form will do. Ends at Ctrl-C as well. Returns the
    firmware as it was at the end, what the board's own program said with `own`, None where nothing
    came. Raises ZerorateError for a source that cannot be followed.
    """
    options = options or WatchOptions()
    if options.own:
        return watch_own(source, options)
    if is_device(source):
        return watch_board(source, options)
    path = Path(source)
    if options.once and path.is_file() and path.name.endswith(tuple(_WHOLE_ALONE)):
        return _watch_finished(path, options)
    tail = CsvTail(path)
    with screen(options.plain) as shown:
        following = Following(tail, options, shown)
        try:
            following.run()
        except KeyboardInterrupt:
            pass
        following.look()
        return following.live if following.live.samples else None


def _watch_finished(path: Path, options: WatchOptions) -> Live | None:
    recording = open_recording(path)
    names, scales = recording.column_names, recording.scales
    live = Live(path.name, scales, names, options.settings, options.model)
    for columns in recording.batches():
        live.feed(columns)
    with screen(options.plain) as shown:
        shown.show(live, [])
    return live if live.samples else None


def is_device(source: str) -> bool:
    """Whether the source is a port or a bus: by its name, or a device under any other name."""
    return source == FAKE or bool(_DEVICE.fullmatch(source)) or Path(source).is_char_device()


class Following:
    """A growing file, the firmware on it, and the screen."""

    def __init__(self, tail: CsvTail, options: WatchOptions, shown: Screen) -> None:
        self.tail, self.options, self._shown = tail, options, shown
        self.live = self._fresh()
        self._begun = self._grown = self._looked = time.monotonic()

    def run(self) -> None:
        """Read and show until it is told to end."""
        while self._goes_on():
            restarts = self.tail.restarts
            columns = self.tail.read()
            if self.tail.restarts != restarts:
                self.live = self._fresh()
            if columns is not None:
                self.live.feed(columns)
                self._grown = time.monotonic()
            elif self.options.once:
                return
            else:
                time.sleep(_POLL_S)
            if self._is_time_to_look():
                self.look()

    def _is_time_to_look(self) -> bool:
        waited_s = time.monotonic() - self._looked
        return not self.options.once and waited_s >= self.options.seconds_between_looks(self._shown)

    def look(self) -> None:
        """Show what there is."""
        self._looked = time.monotonic()
        self._shown.show(self.live, self._notes())

    def _fresh(self) -> Live:
        o = self.options
        return Live(self.tail.name, self.tail.scales, self.tail.column_names, o.settings, o.model)

    def _goes_on(self) -> bool:
        return self.options.seconds is None or time.monotonic() - self._begun < self.options.seconds

    def _notes(self) -> list[str]:
        notes = []
        silent_s = time.monotonic() - self._grown
        patience_s = max(_STALLED_S, _STALLED_SAMPLES / self.tail.scales.odr_hz)
        if not self.options.once and silent_s > patience_s:
            notes.append(f"the file has not grown for {silent_s:.0f} s: has its writer stopped?")
        if self.tail.bad_rows:
            cells = len(self.tail.column_names)
            notes.append(f"{self.tail.bad_rows} rows left out: not {cells} integers")
        if self.tail.restarts:
            notes.append("the file became shorter and was begun anew")
        return notes
