"""A fake chip that samples in real time, for a board without a chip."""

import time

from zerorate_fakes import FakeI2C, FakeMPU6050


class LiveI2C(FakeI2C):
    """FakeI2C whose chip lives by the board's own clock."""

    def __init__(self, chip):
        super().__init__(chip)
        self.chip = chip
        self.last_us = time.ticks_us()

    def _begin(self, wire_bytes):
        now_us = time.ticks_us()
        self.chip.advance_us(time.ticks_diff(now_us, self.last_us))
        self.last_us = now_us
        return FakeI2C._begin(self, wire_bytes)


def counting():
    """Samples whose gz counts them."""
    number = 0
    while True:
        noise = (number * 7919) % 13
        yield (noise - 5, 3 - noise, 16384 + noise, -3000, 40 + noise, -20 - noise, number)
        number += 1


def make(chips=FakeMPU6050):
    """A bus with such a chip."""
    return LiveI2C(chips(counting()))
