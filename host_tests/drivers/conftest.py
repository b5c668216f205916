"""What every driver test stands on: a chip that plays a known recording on a fake bus."""

from array import array

import pytest
from zerorate_fakes import FakeClock, FakeI2C, FakeMPU6050
from zerorate_i2c.mpu6050 import MPU6050


def recording(rows):
    """rows samples, all words different, their high bytes changing as they go."""
    return [[1000 * word + 3 * row for word in range(7)] for row in range(rows)]


class Bench:
    """A chip, its bus, its clock and the driver under test."""

    def __init__(self, source=None, part="MPU-6050", linked=False, named=None, **options):
        self.chip = FakeMPU6050(recording(2000) if source is None else source, part)
        self.bus = FakeI2C(self.chip)
        self.clock = FakeClock(self.chip) if linked else FakeClock()
        self.imu = MPU6050(self.bus, part=named, clock=self.clock, **options)
        self.sample = array("i", [0] * 7)

    def read(self):
        """Step the chip, read; the status."""
        self.clock.advance_us(self.imu.period_us)
        assert self.chip.step()
        return self.imu.read(self.sample)


@pytest.fixture
def bench():
    return Bench()


@pytest.fixture
def make_bench():
    return Bench
