"""The whole job without hardware: chip, bus, driver and firmware inside a real MicroPython."""

from .job import Demo, Device, back_on_the_chip, demo, first_power_on, make_device

__all__ = ["Demo", "Device", "back_on_the_chip", "demo", "first_power_on", "make_device"]
