"""Readings that cannot be right, set aside and counted by what is wrong with them."""

from collections.abc import Mapping, Sequence

import numpy as np

from ...recordings.recording import COLUMNS, GYRO, TEMP, TIME

_RAIL = 32767
#: Samples a second up to which a sample may well be that before it, at any temperature.
_SLOW_HZ = 2.0
#: What no sensor's temperature changes by from a sample to the next.
_LEAP_LSB = 400


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

    def _wrong(self, batch):
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
