"""`zerorate run`: the firmware as a service of a Linux board."""

from ..boards.fake_chip import FakeBus
from .publish import Datagrams, Lines, Metrics, Sink, UnixSocket
from .serve import Service, System

__all__ = ["Datagrams", "FakeBus", "Lines", "Metrics", "Service", "Sink", "System", "UnixSocket"]
