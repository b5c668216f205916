"""Whole samples out of the chip's data registers: none torn, frozen or made of one word."""

from .registers import decode

const = int  # on a board the compiler itself reads const(...)

_ACCEL_XOUT_H = const(0x3B)
_BYTES = const(14)
_FROZEN_PERIODS = const(16)
_LEAP_LSB = const(160)


class DataRegisters:
    """Those of imu, an MPU6050, which says what its methods do and counts."""

    def __init__(self, imu):
        self._imu = imu
        self._burst = bytearray(_BYTES)
        self._previous = bytearray(_BYTES)
        self._stands_still = False

    def read(self, sample):
        """Fill sample from a burst; False, and imu.doubt called, where it is no measurement."""
        self.read_sample(sample)
        if self._is_suspect():
            self._imu.doubt(self._stands_still)
            return False
        if self._has_leapt():
            self._read_again(sample)
            if self._is_one_word_repeated(self._burst):
                self._imu.doubt(False)
                return False
        return True

    def read_sample(self, sample):
        """As MPU6050.read_sample."""
        self._burst, self._previous = self._previous, self._burst
        self._imu.read_into(_ACCEL_XOUT_H, self._burst)
        decode(self._burst, 0, sample)

    def _has_leapt(self):
        """A word torn between two samples is off by its high byte: about 256 LSB."""
        burst = self._burst
        previous = self._previous
        for i in range(0, _BYTES, 2):
            leap = (burst[i] - previous[i]) * 256 + burst[i + 1] - previous[i + 1]
            if _LEAP_LSB < leap & 0xFFFF < 0x10000 - _LEAP_LSB:  # from -1 to 0 is one step
                return True
        return False

    def _read_again(self, sample):
        """Motion reads the same again; what a chip without shadow registers tore does not."""
        self.read_sample(sample)
        if self._burst != self._previous:
            self._imu.torn += 1

    def _is_suspect(self):
        imu = self._imu
        burst = self._burst
        self._stands_still = False
        if burst != self._previous:
            imu.changed_us = imu.clock.ticks_us()
            return self._is_one_word_repeated(burst)
        imu.repeats += 1
        still_us = imu.clock.ticks_diff(imu.clock.ticks_us(), imu.changed_us)
        self._stands_still = still_us > _FROZEN_PERIODS * imu.period_us
        return self._stands_still or self._is_one_word_repeated(burst)

    def _is_one_word_repeated(self, burst):
        for i in range(2, _BYTES):  # noqa: SIM110 (a generator would allocate)
            if burst[i] != burst[i & 1]:
                return False
        return True
