"""What a board's own program prints, on a port that nothing is sent to: the program goes on."""

import re
import time
from collections import deque

import numpy as np
from zerorate.explain import SOURCES as IN_WORDS
from zerorate.explain import STILLNESS

from ..boards.connection import BoardError, listening
from ..ending import noted_signals
from ..replay.bias_table import SOURCES
from .live import HISTORY
from .screen import WatchOptions, screen

_NUMBER = r"([-+]?\d+\.\d+)"
_RATES = re.compile(rf"before {_NUMBER} {_NUMBER} {_NUMBER}  after {_NUMBER} {_NUMBER} {_NUMBER}")
_AXIS = re.compile(rf"g([xyz]): bias {_NUMBER} dps from (.*?), \+-{_NUMBER} dps")
_UNKNOWN = re.compile(r"g([xyz]): no bias yet")
_SHORT = dict(zip(IN_WORDS, SOURCES))
_SAID = 12
_SILENT_S = 5.0


class OwnOutput:
    """What the lines of a program say, with the names of Live.

    Lines of examples/main.py give the rates and, as their difference, the bias. Corrector.explain()
    gives each axis' bias, quality and source. Any other line is shown as it is.
    """

    def __init__(self, name: str) -> None:
        self.name, self._rest, self._begun = name, b"", time.monotonic()
        self.temp_degc: float | None = None
        self._begin()

    def _begin(self) -> None:
        self.samples = self.lines = 0
        self.rate_dps, self.left_dps, self.bias_dps, self.quality_dps = np.full((4, 3), np.nan)
        self.source = ["none"] * 3
        self.history: deque[np.ndarray] = deque(maxlen=HISTORY)
        self._said: deque[str] = deque(maxlen=_SAID)
        self._explains = False

    @property
    def duration_s(self) -> float:
        """Seconds that it has been listened to."""
        return time.monotonic() - self._begun

    def headline(self) -> str:
        """Source, and how much was said."""
        return f"{self.name}  the board's own program, {self.samples:,} lines with a bias"

    def conditions(self) -> list[str]:
        """Nothing: a program need not say how warm it is."""
        return []

    def learning(self) -> list[str]:
        """The latest explain() and what came since; without one the latest line."""
        return list(self._said) or [
            "print(corrector.corrector.explain()) in it says what it learns"
        ]

    def feed(self, data: bytes) -> None:
        """Take what came; a line counts when it has ended."""
        *lines, self._rest = (self._rest + data).split(b"\n")
        for line in lines:
            self._take(line.decode(errors="replace").strip())

    def _take(self, line: str) -> None:
        self.lines += bool(line)
        if rates := _RATES.search(line):
            numbers = np.array(rates.groups(), float)
            self.rate_dps, self.left_dps = numbers[:3], numbers[3:]
            if not self._explains:
                self.bias_dps = self.rate_dps - self.left_dps
                self.source = ["printed" if bias else "none" for bias in self.bias_dps]
            self.history.append(self.rate_dps - self.left_dps)
            self.samples += 1
        elif "soft reboot" in line:
            self._begin()
        elif line:
            self._explain(line)

    def _explain(self, line: str) -> None:
        if line in STILLNESS or not self._explains:
            self._said.clear()
        self._explains = self._explains or line in STILLNESS
        self._said.append(line)
        if known := _AXIS.match(line):
            i = "xyz".index(known[1])
            self.bias_dps[i], self.quality_dps[i] = float(known[2]), float(known[4])
            self.source[i] = str(_SHORT.get(known[3], known[3]))
            self.samples += 1
        elif unknown := _UNKNOWN.match(line):
            self.source["xyz".index(unknown[1])] = "none"


def watch_own(port: str, options: WatchOptions) -> OwnOutput | None:
    """Show what the program on the board at port says: see `watch`. Raises BoardError."""
    output = OwnOutput(port)
    heard = looked = time.monotonic()
    notes: list[str] = []
    with listening(port) as serial, screen(options.plain) as shown, noted_signals() as came:
        while not came and (options.seconds is None or output.duration_s < options.seconds):
            try:
                data = serial.read(serial.in_waiting or 1)
            except OSError as error:
                raise BoardError(f"{port}: unplugged, or taken by another program") from error
            output.feed(data)
            now = time.monotonic()
            heard = now if data else heard
            if options.once and (output.samples or output.lines > _SAID):
                break
            silent = f"nothing was printed for {now - heard:.0f} s; Ctrl-D in a terminal starts it"
            notes = [silent] if now - heard > _SILENT_S else []
            if now - looked > options.seconds_between_looks(shown):
                looked = now
                shown.show(output, notes)
        shown.show(output, notes)
    return output if output.lines else None
