"""`zerorate run`: the firmware as a service of a Linux board."""

from .fake_bus import FakeBus
from .metrics import Metrics
from .publish import Datagrams, Lines, Sink, UnixSocket
from .serve import Service, System

__all__ = ["Datagrams", "FakeBus", "Lines", "Metrics", "Service", "Sink", "System", "UnixSocket"]
