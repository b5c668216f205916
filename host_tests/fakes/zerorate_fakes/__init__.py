"""MPU-6050 family chips and an I2C bus made of registers, for tests without hardware.

Runs on CPython and MicroPython. Strict: what the data sheet does not document fails.
"""

from .bus import FakeClock, FakeI2C
from .device import FakeMPU6050, UnknownRegister
from .source import Physical

__all__ = ["FakeClock", "FakeI2C", "FakeMPU6050", "Physical", "UnknownRegister"]
