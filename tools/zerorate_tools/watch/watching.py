"""`watch`: follow a source until it is told to end."""

import re
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..boards.recorder import COLUMNS, Recorded
from ..boards.recording import stream
from ..recordings import Scales
from .live import Live
from .screen import Lines, Screen, screen
from .tail import CsvTail

_DEVICE = re.compile(r"/dev/.+|COM\d+|\d+")
_POLL_S = 0.1
_STALLED_S = 3.0
_STALLED_SAMPLES = 20


@dataclass(frozen=True)
class WatchOptions:
    """How to watch.

    seconds: end after so long; once: end with what is there; every_s: between two looks (default
    0.5 on a terminal, 2 in a pipe); settings, model: as of Live; setup: as of
    record_port.
    """

    seconds: float | None = None
    once: bool = False
    every_s: float | None = None
    plain: bool = False
    settings: dict[str, Any] | None = None
    model: Path | None = None
    setup: str = ""

    def seconds_between_looks(self, shown: Screen) -> float:
        """Seconds between two looks on that screen."""
        if self.every_s is not None:
            return self.every_s
        return 2.0 if isinstance(shown, Lines) else 0.5


def watch(source: str, options: WatchOptions | None = None) -> Live | None:
    """Run the firmware on what comes from a growing CSV, a board's port or /dev/i2c-N, and show it.

    Ends at Ctrl-C as well. Returns the firmware as it was at the end, None where nothing came.
    Raises ZerorateError for a source that cannot be followed.
    """
    options = options or WatchOptions()
    if is_device(source):
        from .watching import watch_board

        return watch_board(source, options)
    tail = CsvTail(Path(source))
    with screen(options.plain) as shown:
        following = Following(tail, options, shown)
        try:
            following.run()
        except KeyboardInterrupt:
            pass
        following.look()
        return following.live if following.live.samples else None


def is_device(source: str) -> bool:
    """Whether the source is a port or a bus: by its name, or a device under any other name."""
    return bool(_DEVICE.fullmatch(source)) or Path(source).is_char_device()


class Following:
    """A growing file, the firmware on it, and the screen."""

    def __init__(self, tail: CsvTail, options: WatchOptions, shown: Screen) -> None:
        self.tail, self.options, self._shown = tail, options, shown
        self.live = self._fresh()
        self._begun = self._grown = self._looked = time.monotonic()
        self._clock: Callable[[], float] = time.monotonic

    def run(self) -> None:
        """Read and show until it is told to end."""
        while self._goes_on():
            restarts = self.tail.restarts
            columns = self.tail.read()
            if self.tail.restarts != restarts:
                self.live = self._fresh()
            if columns is not None:
                self.live.feed(columns)
                self._grown = self._clock()
            elif self.options.once:
                return
            else:
                time.sleep(_POLL_S)
            if self._is_time_to_look():
                self.look()

    def _is_time_to_look(self) -> bool:
        waited_s = self._clock() - self._looked
        return not self.options.once and waited_s >= self.options.seconds_between_looks(self._shown)

    def look(self) -> None:
        """Show what there is."""
        self._looked = self._clock()
        self._shown.show(self.live, self._notes())

    def _fresh(self) -> Live:
        o = self.options
        return Live(self.tail.name, self.tail.scales, self.tail.column_names, o.settings, o.model)

    def _goes_on(self) -> bool:
        return self.options.seconds is None or self._clock() - self._begun < self.options.seconds

    def _notes(self) -> list[str]:
        notes = []
        silent_s = self._clock() - self._grown
        patience_s = max(_STALLED_S, _STALLED_SAMPLES / self.tail.scales.odr_hz)
        if not self.options.once and silent_s > patience_s:
            notes.append(f"the file has not grown for {silent_s:.0f} s: has its writer stopped?")
        if self.tail.bad_rows:
            notes.append(f"{self.tail.bad_rows} rows left out: not {self._cells()} integers")
        if self.tail.restarts:
            notes.append("the file became shorter and was begun anew")
        return notes

    def _cells(self) -> int:
        return len(self.tail.column_names)


_PATIENCE_S = 0.25


class Watcher:
    """A SampleTaker that shows samples through the firmware instead of keeping them.

    In doubt or not, all are given to it: its guard is there to judge them.
    """

    def __init__(self, source: str, scales: Scales, options: WatchOptions, shown: Screen) -> None:
        self.live = Live(source, scales, COLUMNS, options.settings, options.model)
        self.result = Recorded()
        self._shown, self._every_s = shown, options.seconds_between_looks(shown)
        self._waiting: list[tuple[int, ...]] = []
        self._fed = self._looked = time.monotonic()

    def add(self, t_us: int, sample: Sequence[int]) -> None:
        """One sample of seven words."""
        self._waiting.append((t_us, *sample))
        if time.monotonic() - self._fed > _PATIENCE_S:
            self.flush()

    def flush(self) -> None:
        """Hand to the firmware what waits, and show it when it is time."""
        self._fed = time.monotonic()
        if self._waiting:
            rows = np.array(self._waiting, np.int64)
            self._waiting.clear()
            self.live.feed(dict(zip(COLUMNS, rows.T)))
        if self._fed - self._looked > self._every_s:
            self.look()

    def look(self) -> None:
        """Show what there is."""
        self._looked = time.monotonic()
        self._shown.show(self.live, [])

    def confirm(self) -> None:
        """The chip was configured right: nothing to do, for nothing is kept."""

    def discard(self) -> None:
        """It was not, perhaps: the firmware's guard has seen it too."""


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
        made[0].look()
        return made[0].live if made[0].live.samples else None
