"""zerorate: keeps the zero-rate output of a MEMS gyroscope at zero."""

from .corrector import Corrector
from .sensor import Sensor

__all__ = ("Corrector", "Sensor")
