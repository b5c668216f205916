"""Every log of the corpus; importing the modules that write them registers them."""

from . import arrays, clocks, flights, phones, robots, sensors
from .world import CORPUS, Log, World

__all__ = ["CORPUS", "Log", "World", "arrays", "clocks", "flights", "phones", "robots", "sensors"]
