"""When to write what was learned: when it matters, and within a budget of writes a day."""

from array import array

try:
    from time import ticks_diff, ticks_us
except ImportError:
    from time import monotonic_ns  # type: ignore[attr-defined]

    def ticks_us():
        """Microseconds that only go forward."""
        return monotonic_ns() // 1000

    def ticks_diff(end, start):
        """Microseconds from start to end."""
        return end - start


TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

_DAY_S = 86400


class SaveSchedule:
    """Saves to store when a vital value has moved by tolerance, writes_a_day times a day at most.

    vital values are what a reader of the state would miss: array('i') of length items, for
    example each axis's bias in Q8 LSB. A power-on adds five writes at most: each waits as long as
    it has lasted, so that a short one is kept, too. What a LearnedStore loaded needs none. Flash of
    100 000 cycles and two slots at 24 writes a day last 22 years. Raises ValueError for a budget
    below one.

    While flash is erased and written nothing else runs. With `corrector`, a Corrector, a save waits
    for a rest, where a gap costs nothing, but no longer than one write's share of a day; and its
    `explain` tells what saving costs. saves: how many there were; longest_us: of one of them;
    next_s: from when on one may be, seconds since power-on.
    """

    def __init__(
        self,
        store: "Any",
        length: int,
        tolerance: int,
        writes_a_day: int = 24,
        corrector: "Any" = None,
    ) -> None:
        if writes_a_day < 1:
            raise ValueError("writes_a_day is at least 1")
        self.store = store
        self.tolerance = tolerance
        self.interval_s = _DAY_S // writes_a_day
        self.postponed = 0
        self.saves = 0
        self.longest_us = 0
        self._corrector = corrector
        self._due_s = -1
        self._saved = array("i", [0] * length)
        self.next_s = 0
        if corrector is not None:
            corrector.schedule = self

    def offer(self, payload: "Any", vital: "array[int]", now_s: int) -> bool:
        """Save payload if it is due at now_s, seconds since power-on; True when it was written."""
        if not self.is_significant(vital):
            return False
        if getattr(self.store, "loaded", False):  # with what this power-on began
            self.store.loaded = False
            self.loaded(vital)
            return False
        if not self.is_due(now_s) or self._waits(now_s):
            self.postponed += 1
            return False
        self.written_at(now_s)
        self._due_s = -1
        begun_us = ticks_us()
        written = self.store.save(payload)
        self.saves += 1
        self.longest_us = max(self.longest_us, ticks_diff(ticks_us(), begun_us))
        if written:
            self.loaded(vital)
        return written

    def is_due(self, now_s: int) -> bool:
        """True from next_s on."""
        return now_s >= self.next_s

    def _waits(self, now_s):
        """True while a rest is better waited for."""
        if self._corrector is None or self._corrector.rests:
            return False
        if self._due_s < 0:
            self._due_s = now_s
        return now_s - self._due_s < self.interval_s

    def is_significant(self, vital: "array[int]") -> bool:
        """True when a vital value is tolerance or more away from the one last saved."""
        for i in range(len(self._saved)):
            moved = vital[i] - self._saved[i]
            if moved >= self.tolerance or moved <= -self.tolerance:
                return True
        return False

    def written_at(self, saved_s: int) -> None:
        """Tell when the state was last written, in seconds of `now_s`: below 0 before power-on."""
        wait_s = self.interval_s
        if saved_s >= 0:
            wait_s = min(wait_s, saved_s + (wait_s + 15) // 16)
        self.next_s = saved_s + wait_s

    def loaded(self, vital: "array[int]") -> None:
        """Tell what vital values the loaded state has: they need no saving."""
        for i in range(len(self._saved)):
            self._saved[i] = vital[i]
