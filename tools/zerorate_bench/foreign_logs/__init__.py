"""Every log of the corpus, as other tools write them: importing its modules registers them."""

from . import (  # noqa: F401
    arrays,
    changed,
    clocks,
    flights,
    phones,
    robots,
    sensors,
    tools,
    wearables,
)
from .world import CORPUS, Log, World

__all__ = ["CORPUS", "Log", "World"]
