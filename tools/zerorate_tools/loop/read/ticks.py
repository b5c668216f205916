"""A recording streamed once into one-second ticks: means and spreads, with bad readings set aside
and counted.
"""

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
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
    faults: dict[str, int] = field(default_factory=dict)
    samples: int = 0
    digest: str = ""
    attitude: np.ndarray | None = None
    delay: np.ndarray | None = None
    segments: Segments | None = None
    path: Path | None = None


class _Sums:
    """Growing sums per tick of named columns."""

    def __init__(self) -> None:
        self.sums: dict[str, np.ndarray] = {}

    def add(self, name: str, tick: np.ndarray, values: np.ndarray, size: int) -> None:
        total = np.bincount(tick, values, minlength=size)
        old = self.sums.get(name)
        if old is not None:
            total[: len(old)] += old
        self.sums[name] = total

    def get(self, name: str, size: int) -> np.ndarray:
        """(size,) sums; 0 where nothing was ever added, as of a recording all faulty."""
        there = self.sums.get(name, np.zeros(0))
        return np.pad(there, (0, size - len(there)))


class _Vibration:
    """Squared distance of each acceleration from its slow part; keeps the filter's state."""

    def __init__(self) -> None:
        self.state: np.ndarray | None = None

    def __call__(self, accel: np.ndarray) -> np.ndarray:
        keep = 1.0 - _VIBRATION_ALPHA
        if self.state is None:
            self.state = keep * accel[:1]
        slow, self.state = lfilter([_VIBRATION_ALPHA], [1.0, -keep], accel, axis=0, zi=self.state)
        return ((accel - slow) ** 2).sum(axis=1)


def tick_seconds(path: str | PathLike[str], least_s: float = TICK_S) -> float:
    """Length of a recording's ticks: longer where it is slower than one sample a tick, so that each
    holds one. Raises BadRecording."""
    return max(least_s, _of_one_sample(open_recording(path)))


def has_one_sample(scales: Scales, tick_s: float) -> bool:
    """Whether a tick of such a recording holds one sample."""
    return scales.odr_hz * tick_s < _ALONE


def _of_one_sample(opened: OpenRecording) -> float:
    return round(1.0 / opened.scales.odr_hz, 3)


def read_ticks(path: str | PathLike[str], tick_s: float = TICK_S) -> Ticks:
    """Stream a recording of any length into ticks. Raises BadRecording.

    tick_s: what all recordings of a device have alike; never less than `tick_seconds` of this one.
    """
    opened = open_recording(path, keep_gaps=True)
    tick_s = max(tick_s, _of_one_sample(opened))
    reader = _Reader(opened.scales, opened.column_names, tick_s)
    for batch in opened.batches(rows=1 << 18):
        reader.add(batch)
    return replace(reader.result(opened.name), path=Path(path))


class _Reader:
    def __init__(self, scales: Scales, names: list[str], tick_s: float) -> None:
        self.scales, self.names, self.tick_s = scales, names, tick_s
        self.sums, self.vibration = _Sums(), _Vibration()
        self.start: int | None = None
        self.size = self.samples = 0
        self.bad = BadReadings(names, scales.odr_hz)
        self.digest = hashlib.sha256()
        self.centre = np.zeros(3)
        self.reference = Reference(names, scales.gyro_lsb_per_dps)
        self.segments = Segments()
        known = {*COLUMNS, *self.reference.names, *declared(scales.more)}
        self.extra = [n for n in names if n not in known]

    def add(self, batch: Batch) -> None:
        t_us = batch[TIME]
        if not len(t_us):
            return
        gyro = np.column_stack([batch[n] for n in GYRO])
        if self.start is None:
            self.start, self.centre = self._start_us(t_us), gyro[:256].mean(axis=0)
        self.digest.update(np.ascontiguousarray(gyro[:4096]).tobytes())
        self.samples += len(t_us)
        tick = ((t_us - self.start) / (self.tick_s * 1e6)).astype(np.int64)
        self.size = max(self.size, int(tick[-1]) + 1)
        good = self.bad.set_aside(batch)
        self._channels(batch, tick, good)
        if self.reference.names:
            self._true_rate(batch, t_us, tick, gyro, good)
        tick, gyro = tick[good], gyro[good]
        self.sums.add("count", tick, np.ones(len(tick)), self.size)
        rate = (gyro - self.centre) / self.scales.gyro_lsb_per_dps
        self._moments("gyro", tick, rate)
        self.segments.add(tick, rate)
        if "ax" in self.names:
            accel = np.column_stack([batch[n] for n in ACCEL])[good] / self.scales.accel_lsb_per_g
            self._moments("accel", tick, accel)
            if len(accel):
                self.sums.add("vib", tick, self.vibration(accel), self.size)

    def _start_us(self, t_us: np.ndarray) -> int:
        """Of the first tick. Where a tick holds one sample, that is in its middle, so that neither
        jitter nor a rate that is not quite what it says puts two into one and none in the next.
        """
        alone = has_one_sample(self.scales, self.tick_s)
        return int(t_us[0]) - (round(0.5e6 * self.tick_s) if alone else 0)

    def _moments(self, name: str, tick: np.ndarray, values: np.ndarray) -> None:
        for a in range(3):
            self.sums.add(f"{name}{a}", tick, values[:, a], self.size)
            self.sums.add(f"{name}{a}^2", tick, values[:, a] ** 2, self.size)

    def _channels(self, batch: Batch, tick: np.ndarray, good: np.ndarray) -> None:
        for name in [*self.extra, *([TEMP] if TEMP in self.names else [])]:
            there = good if name == TEMP else batch[name] != GAP
            key = _key(name)
            self.sums.add(key, tick[there], batch[name][there].astype(float), self.size)
            self.sums.add(f"{key} count", tick[there], np.ones(int(there.sum())), self.size)

    def _true_rate(
        self,
        batch: Batch,
        t_us: np.ndarray,
        tick: np.ndarray,
        gyro: np.ndarray,
        good: np.ndarray,
    ) -> None:
        q = self.reference.quaternions(batch) if self.reference.attitude else None
        rate = self.reference.rate_dps(t_us, batch, q)
        known = good & np.isfinite(rate).all(axis=1)
        self.sums.add("known", tick[known], np.ones(int(known.sum())), self.size)
        for a in range(3):
            self.sums.add(f"true{a}", tick[known], rate[known, a], self.size)
        change = change_of(t_us, rate)
        both = known & np.isfinite(change).all(axis=1)
        miss = gyro[both] / self.scales.gyro_lsb_per_dps - rate[both]
        self._columns_of("late", tick[both], delay_products(miss, change[both]))
        if q is not None:
            seen = np.isfinite(q[:, 0])
            for i in range(4):
                self.sums.add(f"attitude{i}", tick[seen], q[seen, i], self.size)

    def _columns_of(self, name: str, tick: np.ndarray, rows: np.ndarray) -> None:
        for i, column in enumerate(rows.T):
            self.sums.add(f"{name}{i}", tick, column, self.size)

    def _mean(self, name: str) -> np.ndarray:
        total, count = (self.sums.get(_key(name) + of, self.size) for of in ("", " count"))
        return gap_filled(np.where(count > 0, total / np.maximum(count, 1), np.nan))

    def _triple(self, name: str, count: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        mean = (
            np.column_stack([self.sums.get(f"{name}{a}", self.size) for a in range(3)])
            / count[:, None]
        )
        square = (
            np.column_stack([self.sums.get(f"{name}{a}^2", self.size) for a in range(3)])
            / count[:, None]
        )
        return mean, np.maximum(square - mean**2, 0.0)

    def result(self, name: str) -> Ticks:
        raw = self.sums.get("count", self.size)
        count = np.where(raw > 0, raw, np.nan)
        rate, rate_var = self._triple("gyro", count)
        rate = rate + self.centre / self.scales.gyro_lsb_per_dps
        accel = accel_var = vib = temp = reference = None
        if "ax" in self.names:
            accel, accel_var = self._triple("accel", count)
            vib = gap_filled(self.sums.get("vib", self.size) / count)
            accel = np.column_stack([gap_filled(accel[:, a]) for a in range(3)])
        if TEMP in self.names:
            temp = self.scales.temp_degc(self._mean(TEMP))
        if self.reference.rates:
            reference = self._true_rates(raw)
        extra = {
            n: self._mean(n)
            for n in self.extra
            if np.any(self.sums.get(f"{_key(n)} count", self.size))
        }
        delay = self._columns("late", 2) if self.reference.names else None
        return Ticks(
            name, self.scales, self.tick_s, self.start or 0, raw, rate, rate_var,
            accel, accel_var, vib, temp,
            reference, extra, self.bad.faults, self.samples, self.digest.hexdigest(),
            self._attitude(), delay, self.segments,
        )  # fmt: skip

    def _columns(self, name: str, number: int) -> np.ndarray:
        return np.column_stack([self.sums.get(f"{name}{i}", self.size) for i in range(number)])

    def _true_rates(self, count: np.ndarray) -> np.ndarray:
        """(m, 3) mean over the good samples of ticks in which all of them have a reference."""
        known = self.sums.get("known", self.size)
        whole = (known > 0) & (known >= count)
        mean = self._columns("true", 3) / np.maximum(known, 1.0)[:, None]
        return np.where(whole[:, None], mean, np.nan)

    def _attitude(self) -> np.ndarray | None:
        if not self.reference.attitude:
            return None
        total = self._columns("attitude", 4)
        length = np.linalg.norm(total, axis=1, keepdims=True)
        mean = np.where(length > 0, total / np.where(length > 0, length, 1.0), np.nan)
        held = np.column_stack([gap_filled(mean[:, i]) for i in range(4)])
        return held / np.linalg.norm(held, axis=1, keepdims=True)


def _key(channel: str) -> str:
    """Of a channel's sums, which no channel's name can make another sum's."""
    return f"channel {channel}"


def gap_filled(values: np.ndarray) -> np.ndarray:
    """Gaps bridged by a straight line, the ends held; all-NaN stays so."""
    good = np.isfinite(values)
    if not good.any():
        return values
    return np.interp(np.arange(len(values)), np.flatnonzero(good), values[good])
