"""`zerorate run`: the firmware as a service of a Linux board."""

from .publish import Datagrams, Lines, Sink, UnixSocket
from .serve import Service, System

__all__ = ["Datagrams", "Lines", "Service", "Sink", "System", "UnixSocket"]
