"""An MPU-6050 on the pins of a MicroPython board: the one place that says how it is wired."""

import sys

from machine import I2C, Pin

from .mpu6050 import MPU6050
from .registers import unload


def setup(scl, sda, bus=None, freq=400000, **options):
    """An MPU6050 on the pins scl and sda, by number or name; options are MPU6050's.

    bus: number of the I2C peripheral (default: the one that has these pins on a Pico, else 0).
    SDA is freed first where a chip holds it low. Raises OSError and ValueError as MPU6050 does.
    """
    from .bus_recovery import free_bus  # once: its 1 KB of heap is free again behind it

    wires = [Pin(pin, Pin.OPEN_DRAIN, value=1) for pin in (scl, sda)]
    free_bus(wires[0], wires[1])
    unload("bus_recovery")
    if bus is None:
        bus = sda // 2 % 2 if sys.platform == "rp2" else 0
    unload("board")
    return MPU6050(I2C(bus, scl=wires[0], sda=wires[1], freq=freq), **options)
