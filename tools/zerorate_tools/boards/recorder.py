"""Rows of a recording being made: written, and believed, only when the chip was verified."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import ZerorateError, os_error_in_words
from ..model.model import KEY, NAMES
from ..recordings import Scales, growing_recording
from ..recordings.recording import Columns
from .connection import BoardError

COLUMNS = ["t_us", "ax", "ay", "az", "temp", "gx", "gy", "gz"]
_STAYS_LATE = 8


@dataclass
class Recorded:
    """What a recording came to: samples written, lost on the way (never seen), dropped as doubtful.

    dropped: frames a board sent that never arrived (among the lost); bytes_skipped: in no frame;
    restarts: the chip had to be configured again; bus_errors: transfers that failed;
    part: the chip.
    """

    samples: int = 0
    lost: int = 0
    doubtful: int = 0
    restarts: int = 0
    bus_errors: int = 0
    dropped: int = 0
    bytes_skipped: int = 0
    seconds: float = 0.0
    part: str = ""

    def kept(self, out: Path) -> str:
        """Where the samples are, for an error that ended a recording."""
        if not self.samples:
            return "no sample had come"
        return f"{self.samples} samples, {self.seconds:.1f} s, are in {out}"

    @property
    def rate_hz(self) -> float:
        """Samples a second, over the time between the first and the last."""
        return (self.samples - 1) / self.seconds if self.seconds > 0 else 0.0

    def __str__(self) -> str:
        text = (
            f"{self.part}{', ' if self.part else ''}"
            f"{self.samples} samples in {self.seconds:.1f} s ({self.rate_hz:.1f} Hz), "
            f"{self.lost} lost, {self.doubtful} dropped as doubtful"
        )
        for count, what in (
            (self.restarts, "restarts of the chip"),
            (self.bus_errors, "bus errors"),
            (self.dropped, "frames dropped by the port"),
            (self.bytes_skipped, "bytes skipped"),
        ):
            text += f", {count} {what}" if count else ""
        return text


#: Of a recording's scales, what each batch of its verified samples is given to as well.
Heard = Callable[[Scales], Callable[[Columns], None]]


#: Makes what takes the samples once their scales are known.
Take = Callable[[Scales], "Recorder"]


def recorded(out: Path, heard: Heard | None, stream: Callable[[Take], None]) -> Recorded:
    """Record into out what stream(take) streams; what had been verified when it failed is kept.

    Raises BoardError or, for a bus, ZerorateError where it fails on its way, and says what is kept.
    """
    made: list[Recorder] = []
    try:
        with ExitStack() as opened:

            def take(scales: Scales) -> Recorder:
                growing = opened.enter_context(growing_recording(out, COLUMNS, scales))
                appends = [growing.append, *([heard(scales)] if heard else [])]
                made.append(Recorder(appends, 1e6 / scales.odr_hz, scales.sensor))
                return made[0]

            stream(take)
    except (BoardError, OSError) as error:
        if not made:
            raise
        kept = made[0].result.kept(out)
        if isinstance(error, BoardError):
            raise BoardError(f"{error}; {kept}") from error
        raise ZerorateError(f"{os_error_in_words(error)}; {kept}") from error
    return made[0].result


class Recorder:
    """Takes samples one by one and hands them to each of appends when they are known to be good.

    Rows wait until confirm() says that the chip was configured right all the while, and discard()
    drops those that wait. Time starts at 0 with the first row and must not go backwards.
    """

    def __init__(
        self, appends: Sequence[Callable[[Columns], None]], period_us: float, part: str = ""
    ) -> None:
        self.result = Recorded(part=part)
        self._appends = appends
        self._period_us = period_us
        self._waiting: list[tuple[int, ...]] = []
        self._start_us: int | None = None
        self._expected_us = 0.0
        self._late_in_a_row = 0

    def add(self, t_us: int, sample: Sequence[int]) -> None:
        """One sample of seven words at t_us on any clock; gaps in time count as lost samples."""
        if self._start_us is None:
            self._start_us = t_us
        since_us = t_us - self._start_us
        self._count_lost(since_us)
        self._waiting.append((since_us, *sample))

    def _count_lost(self, since_us: int) -> None:
        """A sample may be late, and the chip's clock off by a few percent, without any lost.

        So a gap counts when it is long, or when the samples stay late after it.
        """
        late = (since_us - self._expected_us) / self._period_us
        self._late_in_a_row = self._late_in_a_row + 1 if late > 0.5 else 0
        if late > 1.7 or self._late_in_a_row == _STAYS_LATE:
            missing = max(1, round(late))
            self.result.lost += missing
            self._expected_us += missing * self._period_us
            late -= missing
            self._late_in_a_row = 0
        follow = 0 if self._late_in_a_row else late / 8
        self._expected_us += (1 + follow) * self._period_us

    def confirm(self) -> None:
        """What waits is good, and handed over. Raises what append raises."""
        if not self._waiting:
            return
        rows = np.array(self._waiting, dtype=np.int64)
        self._waiting.clear()
        columns = dict(zip(COLUMNS, rows.T, strict=True))
        columns = {k: v if k == "t_us" else v.astype(np.int32) for k, v in columns.items()}
        for append in self._appends:
            append(columns)
        self.result.samples += len(rows)
        self.result.seconds = float(rows[-1, 0]) / 1e6

    def discard(self) -> None:
        """What waits is in doubt."""
        self.result.doubtful += len(self._waiting)
        self._waiting.clear()


def scales_of(values: Mapping[str, Any]) -> Scales:
    """Scales from the attributes of a driver, or from the header a board sends."""
    known = ("odr_hz", "gyro_lsb_per_dps", "accel_lsb_per_g", "temp_lsb_per_degc")
    numbers = {name: float(values[name]) for name in (*known, "temp_offset_degc")}
    more: dict[str, Any] = {"source": str(values["source"])}
    if "binding" in values:
        more[KEY] = dict(zip(NAMES, map(int, values["binding"]), strict=True))
    return Scales(sensor=str(values["part"]), more=more, **numbers)
