"""Real boards: firmware put on them, and recordings made from them or from a Linux I2C bus."""

from .flashing import flash
from .recorder import Recorded
from .recording import record, stream

__all__ = ["Recorded", "flash", "record", "stream"]
