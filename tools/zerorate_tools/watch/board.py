"""The firmware on what a board or a Linux bus streams."""

import time
from collections.abc import Sequence

import numpy as np

from ..boards.recorder import COLUMNS, Recorded
from ..boards.recording import stream
from ..recordings import Scales
from .live import Live
from .options import WatchOptions
from .screen import Screen, screen

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
