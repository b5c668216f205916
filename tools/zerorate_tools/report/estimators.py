"""The firmware's estimators at work: its state, looked at while the recordings are replayed."""

from collections.abc import Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from zerorate import Corrector

from zerorate_tools.layout import AXIS, ESTIMATOR, MARKS, SETTINGS, STATE, axis_at

from ..recordings import Scales, open_recording
from ..replay.engines import engine
from ..replay.replaying import corrector_for, load_model
from ..replay.samples import FRAME, frames_in_batches

_POPULATION = 0x3FFF
_TEMP = FRAME.index("temp")


@dataclass(frozen=True)
class Estimator:
    """One estimator: kind any, short or long; temp_degc None for the one of any temperature.

    edges_dps: (bins + 1,) of its histogram; readings: (bins,) in each; in_use: learning just then.
    """

    kind: str
    temp_degc: float | None
    bias_dps: float
    edges_dps: NDArray
    readings: NDArray
    in_use: bool


@dataclass(frozen=True)
class Moment:
    """The estimators of each axis at a minute of the recordings laid end to end.

    bias_dps: (3,) what the firmware takes for the bias then, effects apart.
    """

    minute: float
    recording: str
    temp_degc: float | None
    bias_dps: NDArray
    axes: tuple[tuple[Estimator, ...], ...]


def moments(
    logs: Sequence[str | PathLike[str]],
    model: str | PathLike[str] | None = None,
    every_s: float = 60.0,
) -> list[Moment]:
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


def _moment(corrector: Corrector, scales: Scales, minute, name, raw_temp) -> Moment:
    state, lsb = np.array(corrector.state), scales.gyro_lsb_per_dps
    warm = bool(scales.temp_lsb_per_degc)
    return Moment(
        minute=minute,
        recording=name,
        temp_degc=float(scales.temp_degc(raw_temp)) if warm else None,
        bias_dps=state[STATE.OUT_Q8 : STATE.OUT_Q8 + 3] / 256 / lsb,
        axes=tuple(
            tuple(_estimators(state, corrector.settings, axis, scales)) for axis in range(3)
        ),
    )


def _estimators(state: NDArray, settings, axis: int, scales: Scales) -> list[Estimator]:
    """Those of an axis that hold anything."""
    block = axis_at(settings, axis)
    words, short = settings[SETTINGS.ESTIMATOR_WORDS], settings[SETTINGS.SHORT]
    starts = range(block + AXIS.ESTIMATORS, block + settings[SETTINGS.ESTIMATORS_END], words)
    out = []
    for number, at in enumerate(starts):
        own = state[at : at + words]
        kind = "any" if number == 0 else "short" if number <= short else "long"
        free = number > 0 and own[ESTIMATOR.EST_TEMP] == MARKS.FREE
        if own[ESTIMATOR.EST_READINGS] > 0 and not free:
            in_use = at == state[block + AXIS.CURRENT]
            out.append(_estimator(kind, own, settings[SETTINGS.BINS], in_use, scales))
    return out


def _estimator(kind: str, own: NDArray, bins: int, in_use: bool, scales: Scales) -> Estimator:
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
