"""The firmware over samples as they come, and what it says of itself."""

from collections import deque
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from ..recordings import Recording, Scales
from ..recordings.recording import TIME, Columns
from ..replay.bias_table import SOURCES
from ..replay.engines import CPythonEngine, Engine, Outcome, engine
from ..replay.replaying import corrector_for, load_model
from ..replay.samples import Frames, frames_of

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
