"""Which temperatures the firmware remembers: its state, looked at while recordings are replayed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from zerorate import Corrector

from zerorate_tools.layout import AXIS, ESTIMATOR, SETTINGS, axis_at

from ..loop.read.ticks import AnyPath
from ..numbers import fixed
from ..recordings import Scales, open_recording
from ..replay.engines import engine
from ..replay.replaying import corrector_for, load_model
from ..replay.samples import FRAME, frames_in_batches
from .plot import Line, Panel, Plot, Series

_POPULATION = 0x3FFF
_TEMP = FRAME.index("temp")
_KINDS = (("long", "long-term estimators", "square"), ("short", "short-term estimators", "circle"))


@dataclass(frozen=True)
class Estimator:
    """One of the x axis that holds anything: any temperature's, or a short- or long-term one."""

    kind: str
    temp_degc: float
    bias_dps: float
    readings: int


@dataclass(frozen=True)
class Moment:
    """What the firmware holds at a minute of the recordings laid end to end."""

    minute: float
    recording: str
    temp_degc: float
    held: tuple[Estimator, ...]


def moments(logs: Sequence[AnyPath], model: AnyPath | None, every_s: float) -> list[Moment]:
    """Replay recordings one after another, each a power-on, looking at the state every `every_s`.

    model: the effect model to run with. None are of recordings without a thermometer. Raises
    ZerorateError.
    """
    opened = [open_recording(log, keep_gaps=True) for log in logs]
    if not all(recording.scales.temp_lsb_per_degc for recording in opened):
        return []
    corrector = corrector_for(opened[0], {})
    out: list[Moment] = []
    begin = 0.0
    for recording in opened:
        channels = load_model(corrector, Path(model), recording) if model is not None else ()
        corrector.power_on()
        rows = max(1, round(every_s * recording.scales.odr_hz))
        batches = frames_in_batches(recording, rows=rows, channels=channels)
        first_us, minute = None, begin
        for done in engine("native").run(corrector, batches):
            first_us = int(done.t_us[0]) if first_us is None else first_us
            minute = begin + (int(done.t_us[-1]) - first_us) / 60e6
            temp_degc = float(recording.scales.temp_degc(int(done.frames[-1, _TEMP])))
            held = tuple(_held(corrector, recording.scales))
            out.append(Moment(minute, recording.name, temp_degc, held))
        begin = minute
    return out


def _held(corrector: Corrector, scales: Scales) -> list[Estimator]:
    state, settings, lsb = np.array(corrector.state), corrector.settings, scales.gyro_lsb_per_dps
    block = axis_at(settings, 0)
    words, short = settings[SETTINGS.ESTIMATOR_WORDS], settings[SETTINGS.SHORT]
    starts = range(block + AXIS.ESTIMATORS, block + settings[SETTINGS.ESTIMATORS_END], words)
    out = []
    for number, at in enumerate(starts):
        own = state[at:]
        if own[ESTIMATOR.EST_READINGS] > 0:
            kind = "any" if number == 0 else "short" if number <= short else "long"
            temp_degc = float(scales.temp_degc(own[ESTIMATOR.EST_MEAN_TEMP_Q4] / 16))
            bias_dps = float(own[ESTIMATOR.EST_BIAS_Q8]) / 256 / lsb
            histogram = own[ESTIMATOR.EST_HISTOGRAM :][: settings[SETTINGS.BINS]]
            out.append(Estimator(kind, temp_degc, bias_dps, int((histogram & _POPULATION).sum())))
    return out


def held_over_time(seen: list[Moment]) -> Plot | None:
    """Which temperatures are remembered, and by which kind; None without a moment."""
    if not seen:
        return None
    series = []
    for kind, name, symbol in _KINDS:
        rows = [(m.minute, e) for m in seen for e in m.held if e.kind == kind]
        x = np.array([minute for minute, _ in rows])
        y = np.array([e.temp_degc for _, e in rows], float)
        words = [f"{e.readings} readings, bias {fixed(e.bias_dps, 3)} dps" for _, e in rows]
        size = 6.0 if kind == "long" else 4.0
        series.append(Series(0, x, y, name, kind, "points", symbol, size=size, words=words))
    warm = np.array([(m.minute, m.temp_degc) for m in seen])
    series.append(Series(0, warm[:, 0], warm[:, 1], "die temperature", "context"))
    panel = Panel("temperature, °C", "minutes, power-ons end to end", "°C", lines=_power_ons(seen))
    return Plot(
        key="estimators-time",
        title="Which temperatures the firmware remembers",
        caption="The short-term estimators follow the temperature; those that have seen enough "
        "become long-term ones, which keep a wide range. They outlast the power cut.",
        description="Over time, the temperature of every short-term estimator as a circle and of "
        "every long-term one as a square, with the die temperature as a line.",
        panels=(panel,),
        series=tuple(series),
        stacked=True,
    )


def _power_ons(seen: list[Moment]) -> tuple[Line, ...]:
    first = [m for before, m in zip(seen, seen[1:]) if m.recording != before.recording]
    return tuple(Line("x", m.minute, "event", f"power-on: {m.recording}") for m in first)
