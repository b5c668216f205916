"""Learns for good only what the chip sent while it was known to be configured right.

A chip that browned out answers without an error, asleep or in another range, until its
configuration is read back. What was learned since the last good read-back is taken back then.
"""

from array import array

from .native.rest import copy

TYPE_CHECKING = False
if TYPE_CHECKING:
    from .corrector import Corrector


try:
    from micropython import const
except ImportError:

    def const(value):
        return value


# What a driver says of each read (zerorate_i2c.mpu6050 has the same numbers).
FRESH = const(0)
VERIFIED = const(1)
RESTARTED = const(2)
SUSPECT = const(3)
_LONG_US = const(0x20000000)  # a leap of time at any rate; a longer one would leave 31 bits

# layout: The corrector's state
_ELAPSED_US = const(16)
_OUT_Q8 = const(57)
_SOURCE = const(75)
# layout: end


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
            self.corrector.power_on()
            # the chip began anew, not this device: what is known stands
            copy(self._kept[0], self._live[0], _OUT_Q8, _SOURCE + 3)
        if status >= RESTARTED:
            self.refused += 1
            return False
        dt_us = self._passed_us
        self._passed_us = 0
        if self.corrector.update(sample, dt_us):
            self.refused += 1
            return False
        return True

    def keep(self) -> None:
        """What is learned up to now is right."""
        for i in range(len(self._live)):
            copy(self._live[i], self._kept[i], 0, len(self._kept[i]))

    def take_back(self) -> None:
        """Forget what was learned since keep(); also for a bus that failed for good."""
        for i in range(len(self._live)):
            copy(self._kept[i], self._live[i], self._first[i], len(self._kept[i]))
        self.taken_back += 1
