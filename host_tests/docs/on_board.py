"""Runs a board's program on MicroPython's unix port as if the board had a chip, fast.

Arguments: the program's file, seconds until the board is switched off, pins of SCL, SDA and INT
(-1: INT is not wired). Chip, pins and clock are fakes. Prints what the program prints.
"""

import gc
import sys

import zerorate_i2c.bus_recovery
import zerorate_i2c.mpu6050
from zerorate_fakes import FakeClock, FakeI2C, FakeMPU6050, Physical
from zerorate_fakes.pins import BusWires, InterruptPin

BIAS_DPS = (0.31, -0.19, 0.08)
program = sys.argv[1]
end_s, scl, sda, interrupt = [int(word) for word in sys.argv[2:6]]


def at_rest(seconds):
    """The rates of a device at rest, until it is switched off."""
    if seconds > end_s:
        raise SystemExit
    return BIAS_DPS


chip = FakeMPU6050(Physical(gyro_dps=at_rest))
bus = FakeI2C(chip)
wires = BusWires(bus)
clock = FakeClock(chip)
zerorate_i2c.mpu6050.system_clock = zerorate_i2c.bus_recovery.system_clock = clock


class Unwired:
    """A pin to which nothing is wired."""

    IRQ_RISING = 1

    def irq(self, handler, trigger):
        """Nothing comes."""


class Machine:
    """What the programs import from machine."""

    class Pin:
        IN, OPEN_DRAIN = 0, 1

        def __new__(cls, number, mode=None, value=None):
            pins = {scl: wires.scl, sda: wires.sda, interrupt: InterruptPin(chip)}
            return pins.get(number) or Unwired()

    @staticmethod
    def I2C(number, scl=None, sda=None, freq=100000):
        assert scl is wires.scl and sda is wires.sda, "other pins than those of the board"
        return bus


class Heap:
    """gc without a threshold: fakes, unlike a chip, take heap with every read."""

    collect = gc.collect

    @staticmethod
    def threshold(size):
        """Nothing is collected before it is full."""


sys.modules["machine"], sys.modules["gc"] = Machine, Heap
if interrupt < 0:

    def give_up(milliseconds):
        """Half a minute without a pulse is long enough."""
        clock.advance_us(1000 * milliseconds)
        if clock.now_us > 1000000 * end_s:
            raise SystemExit

    clock.sleep_ms = give_up
with open(program) as file:
    exec(file.read(), {"__name__": "__main__"})
