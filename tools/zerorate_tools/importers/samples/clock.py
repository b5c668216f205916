"""Time stamps as microseconds: counters that ran over, the rate, the gaps."""

from pathlib import Path

import numpy as np

from ...errors import BadRecording

_LONGEST_PAUSE_US = 10_000_000
#: Stamps on both sides of a torn one are nearer to each other; of all, so many are torn at most.
_BESIDE_US, _MOST_TORN = 1e6, 0.01
_DAY_US = 86_400e6
#: Rows may be rarer than a counter's pause where midnight falls between two of them.
_LONGEST_NIGHT_US = 3_600e6
_MOST_US = 2.0**62
_STRIDE = 64
_KEPT = 1 << 18
#: Beyond as many usual intervals, and a second, is a gap.
GAP_INTERVALS, GAP_LEAST_US = 3.0, 1e6


def whole_stamps(t_us: np.ndarray) -> np.ndarray:
    """(n,) bool: not a stamp far from both neighbours, which are beside each other: on its way a
    digit was lost, or one added. Where that is usual, two clocks take turns, and all are whole."""
    whole = np.ones(len(t_us), bool)
    if len(t_us) > 2:
        steps = np.abs(np.diff(t_us))
        far = np.minimum(steps[:-1], steps[1:]) > _LONGEST_PAUSE_US
        torn = far & (np.abs(t_us[2:] - t_us[:-2]) < _BESIDE_US)
        whole[1:-1] = ~torn | (torn.mean() > _MOST_TORN)
    return whole


class Unwrapped:
    """Adds what a counter of 30, 31 or 32 bits lost where it ran over, or midnight a time of day.

    step_us: what one count is worth, in microseconds; 0 for a column that is no counter.
    """

    def __init__(self, step_us: float) -> None:
        self._step_us = step_us
        self._last: float | None = None
        self._added = 0.0
        self.notes: list[str] = []

    def __call__(self, t_us: np.ndarray, place: np.ndarray) -> np.ndarray:
        """(n,) the same stamps, going on where the counter ran over."""
        if not len(t_us):
            return t_us
        before = np.concatenate([[t_us[0] if self._last is None else self._last], t_us[:-1]])
        self._last = t_us[-1]
        t_us = t_us + self._added
        for at in np.flatnonzero(np.diff(t_us - self._added, prepend=before[0]) < 0)[:1000]:
            clock, span = self._clock(before[at], t_us[at] - self._added)
            t_us[at:] += span
            self._added += span
            if span:
                row = int(place[at]) + 1
                self.notes.append(f"a clock of {clock} ran over at row {row}: counted on")
        return t_us

    def _clock(self, earlier: float, later: float) -> tuple[str, float]:
        """What ran over, and microseconds that it holds; 0 where nothing did."""
        spans = {f"{bits} bits": 2.0**bits * self._step_us for bits in (30, 31, 32)}
        for clock, span in {**spans, "24 hours": _DAY_US}.items():
            longest = _LONGEST_PAUSE_US if self._step_us else _LONGEST_NIGHT_US
            if earlier < span and 0 < later + span - earlier < longest:
                return clock, span
        return "", 0.0


class Pace:
    """The usual interval between samples, whatever gaps and bursts there are: the median of the
    means over 64 intervals, or fewer in a short recording."""

    def __init__(self) -> None:
        self._means: list[np.ndarray] = []
        self.first: np.ndarray = np.empty(0)

    def add(self, t_us: np.ndarray) -> None:
        """Take the stamps of samples in order."""
        if len(self.first) < _KEPT:
            self.first = np.concatenate([self.first, t_us[: _KEPT - len(self.first)]])
        self._means.append(np.diff(t_us[::_STRIDE]) / _STRIDE)
        if len(self._means) > 4096:
            self._means = [np.concatenate(self._means)[:: 1 + len(self._means) // 8192]]

    def interval_us(self, path: Path) -> float:
        """Raises BadRecording where time stands still."""
        stride = min(_STRIDE, max(1, len(self.first) // 16))
        means = np.concatenate(self._means) if self._means else np.empty(0)
        if stride < _STRIDE:
            means = np.diff(self.first[::stride]) / stride
        usual = float(np.median(means)) if len(means) else 0.0
        if usual <= 0:
            usual = float(np.mean(means)) if len(means) else 0.0
        if usual <= 0:
            raise BadRecording(path, "time stands still", do="give --hz, samples a second")
        return usual


def longest_us(interval_us: float) -> float:
    """Until when a reading counts as the next one: a later one is beyond a gap."""
    return max(GAP_INTERVALS * interval_us, GAP_LEAST_US)


class Gaps:
    """Counts pauses that are far longer than the usual interval."""

    def __init__(self, interval_us: float) -> None:
        self._least_us = longest_us(interval_us)
        self._last: float | None = None
        self.count = 0
        self.longest_us = 0.0

    def add(self, t_us: np.ndarray) -> None:
        """Take the stamps of samples in order."""
        if not len(t_us):
            return
        pauses = np.diff(t_us, prepend=t_us[0] if self._last is None else self._last)
        pauses = pauses[pauses > self._least_us]
        self._last = t_us[-1]
        if len(pauses):
            self.count += len(pauses)
            self.longest_us = max(self.longest_us, float(pauses.max()))

    def note(self) -> list[str]:
        """In words, where there are any."""
        if not self.count:
            return []
        if self.count == 1:
            return [f"a gap of {duration(self.longest_us * 1e-6)} in the time stamps"]
        return [f"{self.count} gaps in the time stamps, at most {duration(self.longest_us * 1e-6)}"]


def refuse_impossible(t_us: np.ndarray, place: np.ndarray, path: Path) -> None:
    """Raise BadRecording for stamps that no integer of microseconds holds."""
    outside = np.abs(t_us) >= _MOST_US
    if outside.any():
        at = int(np.argmax(outside))
        problem = f"the time stamp is {t_us[at]:.4g} us, more than 62 bits hold"
        do = "name the unit that it is in: --time-unit ns"
        raise BadRecording(path, problem, row=int(place[at]) + 1, do=do)


def duration(seconds: float) -> str:
    """As a person would say it: 250 ms, 4.2 s, 15 min, 2.5 h."""
    if seconds < 1:
        return f"{seconds * 1e3:.3g} ms"
    for span, unit in ((86_400, "days"), (3600, "h"), (60, "min")):
        if seconds >= 2 * span:
            return f"{seconds / span:.3g} {unit}"
    return f"{seconds:.3g} s"
