"""From physical units to integers: rows that are no samples left out, every loss counted."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ..errors import BadRecording
from ..recordings import Recording, Scales, recording_from_columns
from ..recordings.checks import GAP
from .foreign import Foreign

_GYRO_RANGES = (131.0, 65.5, 32.8, 16.4)
_ACCEL_RANGES = (16384.0, 8192.0, 4096.0, 2048.0)
_TEMP_LSB, _TEMP_OFFSET = 100.0, 0.0
_RAIL = 32767


@dataclass
class Options:
    """What the user knows of the source: scales, rate, name; None: as the source says."""

    sensor: str | None = None
    hz: float | None = None
    gyro_lsb_per_dps: float | None = None
    accel_lsb_per_g: float | None = None
    temp_lsb_per_degc: float | None = None
    temp_offset_degc: float | None = None


@dataclass
class Report:
    """What an import did: rows read and written, rows dropped by reason, readings at the rails."""

    rows_read: int = 0
    rows_written: int = 0
    dropped: Counter[str] = field(default_factory=Counter)
    clipped: Counter[str] = field(default_factory=Counter)
    notes: list[str] = field(default_factory=list)

    def lines(self) -> list[str]:
        """The report in words, a line each."""
        out = [f"{self.rows_written} of {self.rows_read} rows written"]
        out += [f"dropped {count} rows: {reason}" for reason, count in self.dropped.items()]
        out += [
            f"{name}: {count} readings at the end of the 16-bit range (clipped)"
            for name, count in self.clipped.items()
        ]
        return out + self.notes


def converted(foreign: Foreign, options: Options, path: Path) -> tuple[Recording, Report]:
    """A Recording out of what a reader found, and what was lost on the way. Raises BadRecording."""
    report = Report(rows_read=len(foreign.gyro) + sum(foreign.dropped.values()))
    _drop_no_samples(foreign)
    if not len(foreign.gyro):
        raise BadRecording(path, "no sample is left", do=_first(foreign.dropped))
    t_us = _stamps_us(foreign, options, path)
    scales = _scales(foreign, options, path, t_us)
    columns: dict[str, np.ndarray] = {"t_us": t_us}
    for i, axis in enumerate("xyz"):
        columns[f"g{axis}"] = _counts(foreign.gyro[:, i], "g", foreign, scales.gyro_lsb_per_dps)
    if foreign.accel is not None:
        for i, axis in enumerate("xyz"):
            columns[f"a{axis}"] = _counts(foreign.accel[:, i], "a", foreign, scales.accel_lsb_per_g)
    if foreign.temp is not None:
        columns["temp"] = _temp_counts(foreign.temp, foreign, scales)
    for name, values in columns.items():
        if name != "t_us":
            columns[name] = _clipped(name, values, report)
    recording = recording_from_columns({**columns, **_extra(foreign, path)}, scales, path.name)
    report.rows_written, report.dropped = len(t_us), foreign.dropped
    report.notes = [*foreign.notes, *_absent(foreign)]
    return recording, report


def _drop_no_samples(foreign: Foreign) -> None:
    given = [foreign.gyro, foreign.accel, None if foreign.temp is None else foreign.temp[:, None]]
    table = np.hstack([part for part in given if part is not None])
    foreign.keep(np.isfinite(table).all(axis=1), "a reading is no number")
    # three rates alone may well be zero on a coarse scale; with gravity, or 0 degC, they are none
    beside = foreign.accel if foreign.accel is not None else foreign.temp
    if beside is not None:
        readings = np.column_stack([foreign.gyro, beside])
        foreign.keep((readings != 0).any(axis=1), "all readings are zero")
    if foreign.time_s is not None:
        foreign.keep(np.isfinite(foreign.time_s), "the time stamp is no number")
        latest = np.maximum.accumulate(foreign.time_s)
        foreign.keep(foreign.time_s >= latest, "the time stamp goes backwards")


def _stamps_us(foreign: Foreign, options: Options, path: Path) -> np.ndarray:
    if foreign.time_s is not None:
        return np.rint(foreign.time_s * 1e6).astype(np.int64)
    hz = options.hz or foreign.odr_hz
    if not hz:
        raise BadRecording(path, "the source has no time stamps", do=foreign.hint_hz)
    foreign.notes.append(f"no time stamps in the source: counted at {hz:g} Hz")
    return np.rint(foreign.index * (1e6 / hz)).astype(np.int64)


def _scales(foreign: Foreign, options: Options, path: Path, t_us: np.ndarray) -> Scales:
    def pick(key: str) -> float | None:
        given = getattr(options, key)
        return given if given is not None else foreign.lsb.get(key)

    gyro = pick("gyro_lsb_per_dps") or _fitting(foreign.gyro, "g", foreign, path)
    accel = temp = offset = None
    if foreign.accel is not None:
        accel = pick("accel_lsb_per_g") or _fitting(foreign.accel, "a", foreign, path)
    if foreign.temp is not None:
        temp, offset = pick("temp_lsb_per_degc"), pick("temp_offset_degc")
        if "t" in foreign.raw and (temp is None or offset is None):
            do = "give --temp-lsb-per-degc and --temp-offset-degc"
            raise BadRecording(path, "the scale of raw temperature is not known", do=do)
        temp = _TEMP_LSB if temp is None else temp
        offset = _TEMP_OFFSET if offset is None else offset
    return Scales(
        sensor=options.sensor or foreign.sensor or "unknown",
        odr_hz=options.hz or foreign.odr_hz or _mean_hz(t_us, path),
        gyro_lsb_per_dps=gyro,
        accel_lsb_per_g=accel,
        temp_lsb_per_degc=temp,
        temp_offset_degc=offset,
        more=foreign.more,
    )


def _fitting(values: np.ndarray, letter: str, foreign: Foreign, path: Path) -> float:
    unit, ranges = ("dps", _GYRO_RANGES) if letter == "g" else ("g", _ACCEL_RANGES)
    if letter in foreign.raw:
        do = "give --gyro-lsb-per-dps" if letter == "g" else "give --accel-lsb-per-g"
        raise BadRecording(path, f"the scale of raw counts ({unit}) is not known", do=do)
    largest = float(np.abs(values).max())
    lsb = next((lsb for lsb in ranges if largest * lsb < _RAIL), ranges[-1])
    foreign.notes.append(f"{lsb:g} LSB per {unit} chosen, as {largest:.4g} {unit} is the most seen")
    return lsb


def _mean_hz(t_us: np.ndarray, path: Path) -> float:
    span = float(t_us[-1] - t_us[0])
    if span <= 0:
        raise BadRecording(path, "time stands still", do="give --hz, samples a second")
    return float(f"{(len(t_us) - 1) / span * 1e6:.6g}")


def _counts(values: np.ndarray, letter: str, foreign: Foreign, lsb: float | None) -> np.ndarray:
    return np.rint(values if letter in foreign.raw or lsb is None else values * lsb)


def _temp_counts(temp: np.ndarray, foreign: Foreign, scales: Scales) -> np.ndarray:
    if "t" in foreign.raw:
        return np.rint(temp)
    assert scales.temp_lsb_per_degc is not None and scales.temp_offset_degc is not None
    raw = (temp - scales.temp_offset_degc) * scales.temp_lsb_per_degc
    return np.rint(raw / foreign.temp_step_lsb) * foreign.temp_step_lsb


def _extra(foreign: Foreign, path: Path) -> dict[str, np.ndarray]:
    for name, values in foreign.extra.items():
        bad = np.abs(values) >= 2**31
        if bad.any():
            at = int(np.argmax(bad))
            do = f"scale it down: --map {name}=COLUMN:x0.001"
            problem = f"{name} is {values[at]:g}, no integer of 32 bits"
            raise BadRecording(path, problem, row=int(foreign.index[at]) + 1, do=do)
    return {
        name: np.where(np.isnan(values), GAP, np.rint(values))
        for name, values in foreign.extra.items()
    }


def _clipped(name: str, values: np.ndarray, report: Report) -> np.ndarray:
    at_end = int((np.abs(values) >= _RAIL).sum())
    if at_end:
        report.clipped[name] = at_end
    return np.clip(values, -_RAIL - 1, _RAIL)


def _absent(foreign: Foreign) -> list[str]:
    absent = []
    if foreign.accel is None:
        absent.append("no acceleration: nothing can be learned against gravity")
    if foreign.temp is None:
        absent.append("no temperature: the bias cannot be followed over temperature")
    return absent


def _first(dropped: Counter[str]) -> str:
    return "; ".join(f"{count} rows: {why}" for why, count in dropped.items()) or "empty source"
