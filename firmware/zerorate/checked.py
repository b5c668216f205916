"""Learns for good only what the chip sent while it was known to be configured right.

A chip that browned out answers without an error, asleep or in another range, until its
configuration is read back. What was learned since the last good read-back is taken back then.
"""

from array import array

from .native.rest import copy

TYPE_CHECKING = False
if TYPE_CHECKING:
    from .corrector import Corrector

# layout: names that a board's own compiler reads
const = int
# layout: The corrector's state
_ELAPSED_US = const(16)
_RESTS = const(62)
_SOURCE = const(78)
# layout: The last words before the axes
_TURN_ON_OFFSET_Q8 = const(-3)
# layout: An axis
_OFFSET_VARIANCE_Q8 = const(28)
# layout: The corrector's settings
_AXES = const(0)
_AXIS_WORDS = const(15)
_TURN_ON_VARIANCE_Q8 = const(47)
# layout: end
# What a driver says of each read (zerorate_i2c.mpu6050 has the same numbers).
FRESH = const(0)
VERIFIED = const(1)
RESTARTED = const(2)
SUSPECT = const(3)
_LONG_US = const(0x20000000)  # a leap of time at any rate; a longer one would leave 31 bits


class CheckedCorrector:
    """`corrector` (a Corrector) with a checkpoint of its state, as large again.

    What it learns in motion, where it does, is in the checkpoint too.

    taken_back counts the times that learning was taken back, refused the samples not passed on.
    """

    def __init__(self, corrector: "Corrector") -> None:
        self.corrector = corrector
        self.taken_back = 0
        self.refused = 0
        self._live = [corrector.state]
        self._first = [_ELAPSED_US, 0]  # the guard's last frame and its counts stay
        if corrector.motion is not None:
            self._live.append(corrector.motion)
        self._kept = [array("i", state) for state in self._live]
        self._passed_us = 0

    def update(self, sample: "array[int]", dt_us: int, status: int = FRESH) -> bool:
        """Learn from `sample` and correct it in place; allocates nothing.

        dt_us: since the call before; status: FRESH, VERIFIED (the configuration was right up to
        this sample), RESTARTED (it was lost some time since the last VERIFIED) or SUSPECT.
        Returns True when the sample is a reading, corrected.
        """
        self._passed_us += dt_us
        if self._passed_us > _LONG_US:
            self._passed_us = _LONG_US
        if status == VERIFIED:
            self.keep()
        elif status == RESTARTED:
            self.take_back()
            self._begin_anew()
        if status >= RESTARTED:
            self.refused += 1
            return False
        dt_us = self._passed_us
        self._passed_us = 0
        if self.corrector.update(sample, dt_us):
            self.refused += 1
            return False
        return True

    def _begin_anew(self):
        """The chip began anew, not this device: what is known stands, a little less certain.

        Rests go on counting: were each restart a power-on, restarts that come faster than a
        minute of rest would keep the curve from learning anything, and halve the offset away.
        """
        corrector = self.corrector
        s = corrector.state
        c = corrector.settings
        corrector.power_on(same=True)
        copy(self._kept[0], s, _RESTS, _SOURCE + 3)
        copy(self._kept[0], s, c[_AXES] + _TURN_ON_OFFSET_Q8, c[_AXES])
        for axis in range(3):
            k = c[_AXES] + axis * c[_AXIS_WORDS] + _OFFSET_VARIANCE_Q8
            if s[k] < c[_TURN_ON_VARIANCE_Q8]:
                s[k] = c[_TURN_ON_VARIANCE_Q8]

    def keep(self) -> None:
        """Keep what was learned up to now: it is right."""
        for i in range(len(self._live)):
            copy(self._live[i], self._kept[i], 0, len(self._kept[i]))

    def take_back(self) -> None:
        """Forget what was learned since keep(); also for a bus that failed for good."""
        for i in range(len(self._live)):
            copy(self._kept[i], self._live[i], self._first[i], len(self._kept[i]))
        self.taken_back += 1
