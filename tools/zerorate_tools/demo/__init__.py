"""The whole job without hardware: chip, bus, driver and firmware inside a real MicroPython."""

from .run import Demo, demo

__all__ = ["Demo", "demo"]
