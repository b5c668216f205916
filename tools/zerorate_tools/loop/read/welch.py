"""The quick part of the rate: a spectrum of samples in short segments, kept while it is read."""

import numpy as np

from .lines import Spectrum

SEGMENT = 2048
_MOST_SEGMENTS = 1500


class Segments:
    """Power of segments of samples; which of them were at rest is known when all is read."""

    def __init__(self) -> None:
        self.power: list[np.ndarray] = []
        self.ticks: list[tuple[int, int]] = []
        self._kept = np.zeros((0, 3))
        self._kept_tick = np.zeros(0, np.int64)
        self._window = np.hanning(SEGMENT)[:, None]

    def add(self, tick: np.ndarray, rate_dps: np.ndarray) -> None:
        """Samples (n, 3) in time order with the tick of each."""
        rate = np.vstack([self._kept, rate_dps])
        tick = np.concatenate([self._kept_tick, tick])
        whole = len(rate) // SEGMENT
        for i in range(whole if len(self.power) < _MOST_SEGMENTS else 0):
            part = slice(i * SEGMENT, (i + 1) * SEGMENT)
            centred = rate[part] - rate[part].mean(axis=0)
            bins = np.abs(np.fft.rfft(centred * self._window, axis=0)) / self._window.sum()
            self.power.append((2 * bins**2).astype(np.float32))
            self.ticks.append((int(tick[part][0]), int(tick[part][-1])))
        self._kept, self._kept_tick = rate[whole * SEGMENT :], tick[whole * SEGMENT :]

    def at_rest(self, still: np.ndarray, odr_hz: float) -> Spectrum | None:
        """Mean over the segments all of whose ticks were still; None with fewer than four."""
        use = [
            power
            for power, (first, last) in zip(self.power, self.ticks)
            if still[first : last + 1].all() and (last - first + 2) > 0.9 * SEGMENT / odr_hz
        ]
        if len(use) < 4:
            return None
        mean = np.mean(use, axis=0, dtype=float)
        return Spectrum(mean, odr_hz / SEGMENT, float(len(use)))
