"""A recording streamed once into one-second ticks: means and spreads, with bad readings set aside
and counted.
"""

import hashlib
from collections.abc import Hashable, Mapping
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

import numpy as np
from scipy.signal import lfilter

from ...recordings import OpenRecording, Scales, open_recording
from ...recordings.checks import GAP
from ...recordings.recording import ACCEL, COLUMNS, GYRO, TEMP, TIME
from .bad_readings import BadReadings
from .lines import Segments
from .reference import Reference, change_of, declared, delay_products

Batch = Mapping[str, np.ndarray]
#: What names a file or a folder.
AnyPath = str | PathLike[str]
TICK_S = 1.0
#: Samples a tick below which it is taken to hold one.
_ALONE = 1.5
#: First-order high-pass of the acceleration for its vibration, per sample.
_VIBRATION_ALPHA = 1.0 / 32.0


@dataclass
class Ticks:
    """Sums per tick. count: (m,) good samples; rate, rate_var: (m, 3) dps, dps^2; others (m,) or
    (m, 3). reference: true rate where one is given, NaN where it is not known; attitude: (m, 4)
    body to world, from which no bias in motion is read: its frame, delay and noise would be in it;
    delay: (m, 2) of `reference.delay_products`.
    """

    name: str
    scales: Scales
    tick_s: float
    start_us: int
    count: np.ndarray
    rate: np.ndarray
    rate_var: np.ndarray
    accel: np.ndarray | None
    accel_var: np.ndarray | None
    vib: np.ndarray | None
    temp: np.ndarray | None
    reference: np.ndarray | None
    extra: dict[str, np.ndarray]
    faults: dict[str, int]
    samples: int
    digest: str
    attitude: np.ndarray | None
    delay: np.ndarray | None
    segments: Segments
    path: Path


class _Sums:
    """Growing sums per tick of named columns."""

    def __init__(self) -> None:
        self.size = 0
        self._sums: dict[Hashable, np.ndarray] = {}

    def add(self, name: Hashable, tick: np.ndarray, *rows: np.ndarray) -> None:
        """rows: (n,) or (n, k) each, of samples with the tick (n,) of each."""
        columns = np.column_stack(rows).T
        total = np.stack([np.bincount(tick, c, self.size) for c in columns], axis=1)
        old = self._sums.get(name)
        if old is not None:
            total[: len(old)] += old
        self._sums[name] = total

    def get(self, name: Hashable, columns: int) -> np.ndarray:
        """(size, columns); 0 where nothing was ever added, as of a recording all faulty."""
        there = self._sums.get(name, np.zeros((0, columns)))
        return np.pad(there, ((0, self.size - len(there)), (0, 0)))


def tick_seconds(path: AnyPath, least_s: float = TICK_S) -> float:
    """Length of a recording's ticks: longer where it is slower than one sample a tick, so that each
    holds one. Raises BadRecording."""
    return max(least_s, _of_one_sample(open_recording(path)))


def has_one_sample(scales: Scales, tick_s: float) -> bool:
    """Whether a tick of such a recording holds one sample."""
    return scales.odr_hz * tick_s < _ALONE


def _of_one_sample(opened: OpenRecording) -> float:
    return round(1.0 / opened.scales.odr_hz, 3)


def read_ticks(path: AnyPath, tick_s: float = TICK_S) -> Ticks:
    """Stream a recording of any length into ticks. Raises BadRecording.

    tick_s: what all recordings of a device have alike; never less than `tick_seconds` of this one.
    """
    opened = open_recording(path, keep_gaps=True)
    tick_s = max(tick_s, _of_one_sample(opened))
    reader = _Reader(opened.scales, opened.column_names, tick_s)
    for batch in opened.batches(rows=262_144):
        reader.add(batch)
    return reader.result(opened.name, Path(path))


class _Reader:
    def __init__(self, scales: Scales, names: list[str], tick_s: float) -> None:
        self.scales, self.names, self.tick_s = scales, names, tick_s
        self.sums, self.segments = _Sums(), Segments()
        self.start: int | None = None
        self.samples = 0
        self.bad = BadReadings(names, scales.odr_hz)
        self.digest = hashlib.sha256()
        self.centre = np.zeros(3)
        self.slow: np.ndarray | None = None
        self.reference = Reference(names, scales.gyro_lsb_per_dps)
        known = {*COLUMNS, *self.reference.names, *declared(scales.more)}
        self.extra = [n for n in names if n not in known]

    def add(self, batch: Batch) -> None:
        t_us = batch[TIME]
        if not len(t_us):
            return
        gyro = np.column_stack([batch[n] for n in GYRO])
        if self.start is None:
            self.start, self.centre = self._start_us(t_us), gyro.mean(axis=0)
        self.digest.update(np.ascontiguousarray(gyro[:4096]).tobytes())
        self.samples += len(t_us)
        tick = ((t_us - self.start) / (self.tick_s * 1e6)).astype(np.int64)
        self.sums.size = int(tick[-1]) + 1
        good = self.bad.set_aside(batch)
        self._channels(batch, tick, good)
        if self.reference.names:
            self._true_rate(batch, tick, gyro, good)
        tick = tick[good]
        rate = (gyro[good] - self.centre) / self.scales.gyro_lsb_per_dps
        self.sums.add("gyro", tick, rate, rate**2, np.ones(len(tick)))
        self.segments.add(tick, rate)
        if "ax" in self.names and len(tick):
            accel = np.column_stack([batch[n] for n in ACCEL])[good] / self.scales.accel_lsb_per_g
            self.sums.add("accel", tick, accel, accel**2, self._vibration(accel))

    def _start_us(self, t_us: np.ndarray) -> int:
        """Of the first tick. Where a tick holds one sample, that is in its middle, so that neither
        jitter nor a rate that is not quite what it says puts two into one and none in the next.
        """
        alone = has_one_sample(self.scales, self.tick_s)
        return int(t_us[0]) - (round(0.5e6 * self.tick_s) if alone else 0)

    def _vibration(self, accel: np.ndarray) -> np.ndarray:
        """(n,) squared distance of each acceleration from its slow part."""
        keep = 1.0 - _VIBRATION_ALPHA
        state = keep * accel[:1] if self.slow is None else self.slow
        slow, self.slow = lfilter([_VIBRATION_ALPHA], [1.0, -keep], accel, axis=0, zi=state)
        return ((accel - slow) ** 2).sum(axis=1)

    def _channels(self, batch: Batch, tick: np.ndarray, good: np.ndarray) -> None:
        for name in (*self.extra, *({TEMP} & {*self.names})):
            there = good if name == TEMP else batch[name] != GAP
            values = batch[name][there].astype(float)
            self.sums.add(("channel", name), tick[there], values, np.ones(len(values)))

    def _true_rate(
        self, batch: Batch, tick: np.ndarray, gyro: np.ndarray, good: np.ndarray
    ) -> None:
        q = self.reference.quaternions(batch) if self.reference.attitude else None
        rate = self.reference.rate_dps(batch[TIME], batch, q)
        known = good & np.isfinite(rate).all(axis=1)
        self.sums.add("true", tick[known], rate[known], np.ones(int(known.sum())))
        change = change_of(batch[TIME], rate)
        both = known & np.isfinite(change).all(axis=1)
        miss = gyro[both] / self.scales.gyro_lsb_per_dps - rate[both]
        self.sums.add("late", tick[both], delay_products(miss, change[both]))
        if q is not None:
            seen = np.isfinite(q[:, 0])
            self.sums.add("attitude", tick[seen], q[seen])

    def _mean(self, channel: str) -> np.ndarray:
        total, count = self.sums.get(("channel", channel), 2).T
        return gap_filled(np.where(count > 0, total / np.maximum(count, 1), np.nan))

    def result(self, name: str, path: Path) -> Ticks:
        *gyro, count = self.sums.get("gyro", 7).T
        filled = np.where(count > 0, count, np.nan)[:, None]
        rate, rate_var = _moments(np.transpose(gyro) / filled)
        accel = accel_var = vib = temp = reference = None
        if "ax" in self.names:
            means = self.sums.get("accel", 7) / filled
            accel, accel_var = _moments(means[:, :6])
            accel, vib = gap_filled(accel), gap_filled(means[:, 6])
        if TEMP in self.names:
            temp = self.scales.temp_degc(self._mean(TEMP))
        if self.reference.rates:
            reference = self._true_rates(count)
        extra = {n: of for n in self.extra if np.isfinite(of := self._mean(n)).any()}
        delay = self.sums.get("late", 2) if self.reference.names else None
        rate = rate + self.centre / self.scales.gyro_lsb_per_dps
        return Ticks(
            name, self.scales, self.tick_s, self.start or 0, count, rate, rate_var,
            accel, accel_var, vib, temp,
            reference, extra, self.bad.faults, self.samples, self.digest.hexdigest(),
            self._attitude(), delay, self.segments, path,
        )  # fmt: skip

    def _true_rates(self, count: np.ndarray) -> np.ndarray:
        """(m, 3) mean over the good samples of ticks in which all of them have a reference."""
        *rates, known = self.sums.get("true", 4).T
        mean = np.transpose(rates) / np.maximum(known, 1.0)[:, None]
        return np.where(((known > 0) & (known == count))[:, None], mean, np.nan)

    def _attitude(self) -> np.ndarray | None:
        if not self.reference.attitude:
            return None
        return _unit(gap_filled(_unit(self.sums.get("attitude", 4))))


def _moments(means: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(m, 3) means and variances from means of values and of their squares, (m, 6)."""
    mean, square = np.hsplit(means, 2)
    return mean, np.maximum(square - mean**2, 0.0)


def _unit(rows: np.ndarray) -> np.ndarray:
    """(m, k) of length 1, NaN where there is no length."""
    length = np.linalg.norm(rows, axis=1, keepdims=True)
    return rows / np.where(length > 0, length, np.nan)


def gap_filled(values: np.ndarray) -> np.ndarray:
    """(m,) or (m, k): gaps bridged by a straight line, the ends held; all-NaN stays so."""
    if values.ndim > 1:
        return np.column_stack([gap_filled(column) for column in values.T])
    good = np.isfinite(values)
    if not good.any():
        return values
    return np.interp(np.arange(len(values)), np.flatnonzero(good), values[good])
