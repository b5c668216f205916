"""Learns for good only what the chip sent while it was known to be configured right.

A chip that browned out answers without an error, asleep or in another range, until its
configuration is read back. What was learned since the last good read-back is taken back then.
"""

from array import array

from .kernels import VIPER

if VIPER:
    from .viper import copying
else:
    from . import copying

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


class CheckedCorrector:
    """`corrector` (a Corrector) with a checkpoint of its state, as large again.

    taken_back counts the times that learning was taken back, refused the samples not passed on.
    """

    def __init__(self, corrector):
        self.corrector = corrector
        self.taken_back = 0
        self.refused = 0
        self._length = len(corrector.state)
        self._kept = array("i", corrector.state)
        self._passed_us = 0

    def update(self, sample, dt_us, status=FRESH):
        """Learn from `sample` and correct it in place; allocates nothing.

        dt_us: since the call before; status: FRESH, VERIFIED (the configuration was right up to
        this sample), RESTARTED (it was lost some time since the last VERIFIED) or SUSPECT.
        Returns True when the sample is a reading, corrected.
        """
        self._passed_us += dt_us
        if status == VERIFIED:
            self.keep()
        elif status == RESTARTED:
            self.take_back()
            self.corrector.power_on()
        if status >= RESTARTED:
            self.refused += 1
            return False
        dt_us = self._passed_us
        self._passed_us = 0
        if self.corrector.update(sample, dt_us):
            self.refused += 1
            return False
        return True

    def keep(self):
        """What is learned up to now is right."""
        copying.copy(self.corrector.state, self._kept, self._length)

    def take_back(self):
        """Forget what was learned since keep(); also for a bus that failed for good."""
        copying.copy(self._kept, self.corrector.state, self._length)
        self.taken_back += 1
