"""Runs a board's program on MicroPython's unix port as if the board had a chip, fast.

Arguments: the program's file, seconds of samples. Chip, INT pin and clock are fakes; the program
ends when the samples do. Prints what the program prints.
"""

import sys

import zerorate_i2c.clock
from zerorate_fakes import FakeClock, FakeI2C, FakeMPU6050
from zerorate_fakes.pins import BusWires, InterruptPin


def resting(count):
    """Samples of a device at rest with a bias of 40, -25 and 10 LSB, then the end."""
    state = 1
    for _ in range(count):
        noise = []
        for _ in range(7):
            total = 0
            for _ in range(4):
                state = (state * 75 + 74) % 65537
                total += state % 9
            noise.append(total - 16)
        yield (
            5 * noise[0],
            5 * noise[1],
            16384 + 5 * noise[2],
            -3000 + noise[3] // 4,
            40 + noise[4],
            -25 + noise[5],
            10 + noise[6],
        )
    raise SystemExit


chip = FakeMPU6050(resting(int(sys.argv[2]) * 100))
bus = FakeI2C(chip)
wires = BusWires(bus)
clock = FakeClock(chip)
for name in ("ticks_us", "ticks_diff", "ticks_add", "sleep_ms"):
    setattr(zerorate_i2c.clock, name, getattr(clock, name))


class Machine:
    """What the programs import from machine."""

    class Pin:
        IN, OPEN_DRAIN = 0, 1

        def __new__(cls, number, mode=None, value=None):
            return {4: wires.sda, 5: wires.scl}.get(number) or InterruptPin(chip)

    @staticmethod
    def I2C(number, scl=None, sda=None, freq=100000):
        return bus


sys.modules["machine"] = Machine
with open(sys.argv[1]) as file:
    exec(file.read(), {"__name__": "__main__"})
