"""Every log of the corpus, as other tools write them: importing its modules registers them."""

# the order in which a page lists them
# isort: off
from . import phones, clocks, arrays, changed, robots, sensors, tools  # noqa: F401
from .world import CORPUS, Log, World

__all__ = ["CORPUS", "Log", "World"]
