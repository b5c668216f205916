"""The firmware's estimators at work: its state, looked at while the recordings are replayed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from zerorate import Corrector

from zerorate_tools.layout import AXIS, ESTIMATOR, SETTINGS, STATE, axis_at

from ..loop.read.ticks import AnyPath
from ..numbers import fixed
from ..recordings import Scales, open_recording
from ..replay.engines import engine
from ..replay.replaying import corrector_for, load_model
from ..replay.samples import FRAME, frames_in_batches
from .plot import AXES, Line, Numbers, Panel, Plot, Series

_POPULATION = 0x3FFF
_TEMP = FRAME.index("temp")
KINDS = (("long", "long-term estimators", "square"), ("short", "short-term estimators", "circle"))
_AXIS = 0


@dataclass(frozen=True)
class Estimator:
    """One estimator: kind any, short or long; temp_degc None for the one of any temperature.

    edges_dps: (bins + 1,) of its histogram; readings: (bins,) in each; in_use: learning just then.
    """

    kind: str
    temp_degc: float | None
    bias_dps: float
    edges_dps: Numbers
    readings: Numbers
    in_use: bool


@dataclass(frozen=True)
class Moment:
    """The estimators of each axis at a minute of the recordings laid end to end.

    bias_dps: (3,) what the firmware takes for the bias then, effects apart.
    """

    minute: float
    recording: str
    temp_degc: float | None
    bias_dps: Numbers
    axes: tuple[tuple[Estimator, ...], ...]


def moments(logs: Sequence[AnyPath], model: AnyPath | None, every_s: float) -> list[Moment]:
    """Replay recordings one after another, each a power-on, looking at the state every `every_s`.

    model: the effect model to run with. Raises ZerorateError.
    """
    opened = [open_recording(log, keep_gaps=True) for log in logs]
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
            raw = int(done.frames[-1, _TEMP])
            out.append(_moment(corrector, recording.scales, minute, recording.name, raw))
        begin = minute
    return out


def _moment(
    corrector: Corrector, scales: Scales, minute: float, name: str, raw_temp: int
) -> Moment:
    state, lsb = np.array(corrector.state), scales.gyro_lsb_per_dps
    warm = bool(scales.temp_lsb_per_degc)
    return Moment(
        minute=minute,
        recording=name,
        temp_degc=float(scales.temp_degc(raw_temp)) if warm else None,
        bias_dps=state[STATE.OUT_Q8 :][:3] / 256 / lsb,
        axes=tuple(
            tuple(_estimators(state, corrector.settings, axis, scales)) for axis in range(3)
        ),
    )


def _estimators(state: Numbers, settings: Any, axis: int, scales: Scales) -> list[Estimator]:
    """Those of an axis that hold anything."""
    block = axis_at(settings, axis)
    words, short = settings[SETTINGS.ESTIMATOR_WORDS], settings[SETTINGS.SHORT]
    starts = range(block + AXIS.ESTIMATORS, block + settings[SETTINGS.ESTIMATORS_END], words)
    out = []
    for number, at in enumerate(starts):
        own = state[at:]
        kind = "any" if number == 0 else "short" if number <= short else "long"
        if own[ESTIMATOR.EST_READINGS] > 0:
            in_use = at == state[block + AXIS.CURRENT]
            out.append(_estimator(kind, own, settings[SETTINGS.BINS], in_use, scales))
    return out


def _estimator(kind: str, own: Numbers, bins: int, in_use: bool, scales: Scales) -> Estimator:
    histogram, lsb = own[ESTIMATOR.EST_HISTOGRAM :], scales.gyro_lsb_per_dps
    warm = kind != "any" and scales.temp_lsb_per_degc
    return Estimator(
        kind=kind,
        temp_degc=float(scales.temp_degc(own[ESTIMATOR.EST_MEAN_TEMP_Q4] / 16)) if warm else None,
        bias_dps=float(own[ESTIMATOR.EST_BIAS_Q8]) / 256 / lsb,
        edges_dps=(histogram[: bins + 1] >> 14) / lsb,
        readings=histogram[:bins] & _POPULATION,
        in_use=bool(in_use),
    )


def held_over_time(seen: list[Moment]) -> Plot | None:
    """Which temperatures are remembered, and by which kind; None without a thermometer."""
    if not any(m.temp_degc is not None for m in seen):
        return None
    series = []
    for kind, name, symbol in KINDS:
        rows = [(m.minute, e) for m in seen for e in m.axes[_AXIS] if e.kind == kind]
        x = np.array([minute for minute, _ in rows])
        y = np.array([e.temp_degc for _, e in rows], float)
        words = [_said(e) for _, e in rows]
        size = 6.0 if kind == "long" else 4.0
        series.append(Series(0, x, y, name, kind, "points", symbol, size=size, words=words))
    warm = np.array([(m.minute, m.temp_degc) for m in seen if m.temp_degc is not None])
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


def _said(e: Estimator) -> str:
    return f"{int(e.readings.sum())} readings, bias {fixed(e.bias_dps, 3)} dps"


def inside(seen: list[Moment]) -> Plot | None:
    """Each estimator's bias over temperature, and the histogram in use, at each moment.

    None where nothing was learned.
    """
    seen = [m for m in seen if all(m.axes)]
    if not seen:
        return None
    drawn = [_at(m) for m in seen]
    warm = any(m.temp_degc is not None for m in seen)
    panels = [Panel("readings in each bin", "rate, dps", "readings")]
    if warm:
        panels.append(Panel("bias by estimator, dps", "°C", "dps"))
    frames = tuple(
        (f"minute {m.minute:.0f} · {m.recording}", dict(enumerate(series)))
        for m, series in zip(seen, drawn)
    )
    return Plot(
        key="estimators-inside",
        title="Inside the estimators",
        caption="Move the slider through the recordings. Each estimator is a histogram of few bins "
        "that crowd where the readings are; the one in use is drawn. Its mean is its bias; "
        "a line through the estimators near by answers for temperatures in between.",
        description="The histogram of the estimator in use as bars"
        + (", and the bias of every estimator over its temperature." if warm else "."),
        panels=tuple(panels),
        series=tuple(drawn[-1]),
        views=tuple(f"{a} axis" for a in AXES),
        frames=frames,
    )


def _at(m: Moment) -> list[Series]:
    out = []
    for a, held in enumerate(m.axes):
        view = (f"{AXES[a]} axis",)
        in_use = next((e for e in held if e.in_use), held[0])
        out += [_histogram(in_use, view), _edges(in_use, view), _mean(in_use, view)]
        if m.temp_degc is None:
            continue
        for kind, name, symbol in KINDS:
            own = [e for e in held if e.kind == kind]
            out.append(_biases(own, name, kind, symbol, view))
        now: dict[str, Any] = {"mark": "points", "symbol": "star", "size": 11.0, "views": view}
        x, y = np.array([m.temp_degc]), np.array([m.bias_dps[a]])
        out.append(Series(1, x, y, "the firmware's bias", "now", **now))
    return out


def _histogram(e: Estimator, view: tuple[str, ...]) -> Series:
    middle, width = (e.edges_dps[:-1] + e.edges_dps[1:]) / 2, np.diff(e.edges_dps)
    said = "at any temperature" if e.temp_degc is None else f"at {e.temp_degc:.1f} °C"
    words = [f"{n} readings {said}" for n in e.readings]
    look: dict[str, Any] = {"mark": "bars", "width": width, "views": view, "words": words}
    return Series(0, middle, e.readings.astype(float), "histogram in use", "any", **look)


def _edges(e: Estimator, view: tuple[str, ...]) -> Series:
    """A tick at each edge of a bin, for most bins are empty."""
    high = 0.04 * max(1, int(e.readings.max()))
    x = np.column_stack([e.edges_dps, e.edges_dps, np.full(len(e.edges_dps), np.nan)])
    y = np.tile([0.0, high, np.nan], len(e.edges_dps))
    return Series(0, x.ravel(), y, "edges of its bins", "context", views=view)


def _mean(e: Estimator, view: tuple[str, ...]) -> Series:
    y = np.array([0.0, 1.06 * max(1, int(e.readings.max()))])
    return Series(0, np.full(2, e.bias_dps), y, "its bias", "now", dash="dot", views=view)


def _biases(
    own: list[Estimator], name: str, kind: str, symbol: str, view: tuple[str, ...]
) -> Series:
    x = np.array([e.temp_degc for e in own], float)
    y = np.array([e.bias_dps for e in own])
    look: dict[str, Any] = {"mark": "points", "symbol": symbol, "size": 9.0, "views": view}
    return Series(1, x, y, name, kind, words=[_said(e) for e in own], **look)
