"""The firmware over samples as they come, and what it says of itself, here or on a board."""

import re
import time
from collections import deque
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from zerorate.explain import SOURCES as IN_WORDS
from zerorate.explain import STILLNESS

from ..boards.connection import BoardError, listening
from ..ending import noted_signals
from ..recordings import Recording, Scales
from ..recordings.recording import TIME, Columns
from ..replay.engines import CPythonEngine, Engine, Outcome, engine
from ..replay.replaying import SOURCES, corrector_for, load_model
from ..replay.samples import Frames, frames_of
from .screen import WatchOptions, screen

#: From so many samples at once on, compiled kernels are worth their loading.
_MANY = 20_000
_SHOWN_S = 1.0
HISTORY = 900  # a quarter of an hour


class Live:
    """A corrector that is fed and asked.

    options: keywords of zerorate.Corrector; model: an effect model. rate_dps, left_dps: (3,) means
    over the latest second, as read and as corrected; bias_dps, quality_dps: (3,) now; source: three
    names; temp_degc: None without a thermometer; history: the bias each second of the last quarter
    of an hour. Raises ZerorateError (BadModel, ...).
    """

    def __init__(
        self,
        name: str,
        scales: Scales,
        column_names: list[str],
        options: dict[str, Any] | None = None,
        model: Path | None = None,
    ) -> None:
        recording = Recording({n: np.zeros(0, np.int32) for n in column_names}, scales, name)
        self.name, self.scales = name, scales
        self.corrector = corrector_for(recording, options or {})
        self._channels = load_model(self.corrector, model, recording) if model else ()
        self._last_us: int | None = None
        self.samples, self.start_us, self._kept = 0, 0, -1
        self.rate_dps, self.left_dps = np.full(3, np.nan), np.full(3, np.nan)
        self.temp_degc: float | None = None
        self.history: deque[np.ndarray] = deque(maxlen=HISTORY)

    def feed(self, columns: Columns) -> None:
        """Let the firmware take a batch of samples."""
        batch = self._frames(columns)
        if not len(batch):
            return
        raw = batch.frames.copy()
        runner: Engine = engine("native") if len(batch) > _MANY else CPythonEngine()
        for outcome in runner.run(self.corrector, [batch]):
            self._note(raw, outcome.frames, outcome.t_us)
            self._keep(outcome)

    def headline(self) -> str:
        """Source, sensor, and how much came."""
        minutes, seconds = divmod(int(self.duration_s), 60)
        return (
            f"{self.name}  {self.scales.sensor}  {minutes}:{seconds:02d} min, "
            f"{self.samples:,} samples, {self.rate_hz:.1f} Hz"
        )

    def conditions(self) -> list[str]:
        """How warm it is, a line each."""
        if self.temp_degc is None:
            return ["no thermometer"]
        return [f"temperature {self.temp_degc:.2f} degC"]

    @property
    def duration_s(self) -> float:
        """Seconds from the first sample to the latest."""
        return ((self._last_us or 0) - self.start_us) * 1e-6 if self.samples else 0.0

    @property
    def rate_hz(self) -> float:
        """Samples a second so far."""
        return (self.samples - 1) / self.duration_s if self.duration_s > 0 else 0.0

    @property
    def bias_dps(self) -> np.ndarray:
        """(3,) what is subtracted now."""
        return self._of_axes(self.corrector.bias_lsb) / self.scales.gyro_lsb_per_dps

    @property
    def quality_dps(self) -> np.ndarray:
        """(3,) one sigma of it."""
        return self._of_axes(self.corrector.quality_lsb) / self.scales.gyro_lsb_per_dps

    @property
    def source(self) -> list[str]:
        """Where each axis' bias comes from."""
        return [SOURCES[self.corrector.source(axis)] for axis in range(3)]

    def learning(self) -> list[str]:
        """What is being learned or why not: the firmware's own words, a line each."""
        return self.corrector.explain().splitlines()

    @staticmethod
    def _of_axes(ask: Callable[[int], float]) -> np.ndarray:
        return np.array([ask(axis) for axis in range(3)])

    def _frames(self, columns: Columns) -> Frames:
        t_us = columns[TIME]
        if self._last_us is None and len(t_us):
            self.start_us = int(t_us[0])
            self._last_us = self.start_us - round(1e6 / self.scales.odr_hz)
        return frames_of(columns, self._last_us or 0, self._channels)

    def _keep(self, outcome: Outcome) -> None:
        """The first bias of each second."""
        second = (outcome.t_us - self.start_us) // 1_000_000
        _, first = np.unique(second, return_index=True)
        rows = outcome.bias_q8[first[second[first] > self._kept]] / 256.0
        self.history.extend(rows / self.scales.gyro_lsb_per_dps)
        self._kept = max(self._kept, int(second[-1]))

    def _note(self, raw: np.ndarray, corrected: np.ndarray, t_us: np.ndarray) -> None:
        self.samples += len(t_us)
        self._last_us = int(t_us[-1])
        latest = t_us > t_us[-1] - round(_SHOWN_S * 1e6)
        self.rate_dps = raw[latest, 4:].mean(axis=0) / self.scales.gyro_lsb_per_dps
        self.left_dps = corrected[latest, 4:].mean(axis=0) / self.scales.gyro_lsb_per_dps
        if self.scales.temp_lsb_per_degc:
            self.temp_degc = float(self.scales.temp_degc(raw[latest, 3].mean()))


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
