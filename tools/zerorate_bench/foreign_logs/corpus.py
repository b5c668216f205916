"""Every log of the corpus; importing the modules that write them registers them."""

from . import arrays, changed, clocks, flights, phones, robots, sensors, tools  # noqa: F401
from .world import CORPUS, Log, World

__all__ = ["CORPUS", "Log", "World"]
