"""`watch`: follow a source until it is told to end."""

import re
import time
from collections.abc import Callable
from pathlib import Path

from .live import Live
from .options import WatchOptions
from .screen import Screen, Shown, screen
from .tail import CsvTail

_DEVICE = re.compile(r"/dev/.+|COM\d+|\d+")
_POLL_S = 0.1
_STALLED_S = 3.0
_STALLED_SAMPLES = 20


def watch(source: str, options: WatchOptions | None = None) -> Shown | None:
    """Run the firmware on what comes from a growing CSV, a board's port or /dev/i2c-N, and show it.

    Ends at Ctrl-C as well. Returns the firmware as it was at the end, what the board's own program
    said with `own`, None where nothing came.
    Raises ZerorateError for a source that cannot be followed.
    """
    options = options or WatchOptions()
    if options.own:
        from .own import watch_own

        return watch_own(source, options)
    if is_device(source):
        from .board import watch_board

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
