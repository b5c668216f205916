"""Readings that are none: what the guard refuses, and those at the end of a sensor's range."""

from collections.abc import Mapping, Sequence

import numpy as np
from scipy.ndimage import binary_opening, median_filter, uniform_filter1d

from ...recordings.recording import COLUMNS, GYRO, TEMP, TIME

_RAIL = 32767
#: Samples a second up to which a sample may well be that before it, at any temperature.
_SLOW_HZ = 2.0
#: What no sensor's temperature changes by from a sample to the next.
_LEAP_LSB = 400
#: Steps in a row without the sensor's noise, each of this share of its usual step. Of white noise
#: one of seven steps is so small, so five in a row stand by chance in one of 17,000 places; they
#: count only near the largest reading, where there are few, and where steps about them are so many
#: times the usual one: a device at rest reads the same for long.
_STEPS, _SHARE = 5, 0.25
_NEAR_LARGEST, _MOVES = 0.8, 4.0
#: Usual steps that a range has at least: noise about a bias has no end of a range.
_RANGE_STEPS = 50.0
#: Samples over which a usual step is measured; the quietest tenth counts.
_SPAN, _QUIETEST = 21, 0.1


class BadReadings:
    """Of one recording, batch by batch. faults: samples by the first of their faults."""

    def __init__(self, names: Sequence[str], odr_hz: float) -> None:
        self.faults = {"clipped": 0, "repeated": 0, "all-zero": 0, "temperature-jump": 0}
        self._names = [n for n in names if n in COLUMNS and n != TIME]
        self._fast = odr_hz > _SLOW_HZ
        self._previous: np.ndarray | None = None

    def set_aside(self, batch: Mapping[str, np.ndarray]) -> np.ndarray:
        """(n,) bool: no rail, no exact repeat of the whole sample, no frame of zeros, no leap of
        temperature.
        """
        seen = np.zeros(len(batch[TIME]), bool)
        for name, wrong in self._wrong(batch).items():
            self.faults[name] += int((wrong & ~seen).sum())
            seen |= wrong
        return ~seen

    def _wrong(self, batch: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
        """(n,) bool by fault."""
        frame = np.column_stack([batch[n] for n in self._names])
        first = frame[:1] + 1 if self._previous is None else self._previous
        before = np.vstack([first, frame[:-1]])
        self._previous = frame[-1:]
        wrong = {
            "clipped": np.any([np.abs(batch[n]) >= _RAIL for n in GYRO], axis=0),
            "repeated": (frame == before).all(axis=1) & self._fast,
            "all-zero": (frame == 0).all(axis=1),
        }
        if TEMP in self._names:
            temp, last = (rows[:, self._names.index(TEMP)] for rows in (frame, before))
            leap = (np.abs(temp - last) >= _LEAP_LSB) & self._fast
            wrong["temperature-jump"] = leap | (np.abs(temp) >= _RAIL)
        return wrong


def saturated(readings: np.ndarray) -> np.ndarray:
    """(n,) bool: a rate or a force, of (n, 3) in any unit, is at a level that the sensor does not
    exceed.

    Nothing is found where the noise is below the resolution.
    """
    out = np.zeros(len(readings), bool)
    steps = np.abs(np.diff(readings, axis=0))
    usual = float(np.median(np.quantile(median_filter(steps, (_SPAN, 1)), _QUIETEST, axis=0)))
    moves = uniform_filter1d(steps.mean(axis=1, keepdims=True), _SPAN, axis=0) > _MOVES * usual
    flat = moves & binary_opening(steps < _SHARE * usual, np.ones((_STEPS, 1), bool))
    flat = np.vstack([flat[:1], flat])
    for values, still in zip(readings.T, flat.T):
        least = max(_NEAR_LARGEST * np.abs(values).max(), _RANGE_STEPS * usual)
        for side in (1, -1):
            level = (side * values)[still & (side * values > least)]
            if len(level):
                out |= side * values >= level.min() - usual
    return out
