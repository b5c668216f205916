"""`zerorate record --guide`: which turn is still missing, said while a device is in the hand."""

from .guided import Guide
from .screen import screen, unknown

__all__ = ["Guide", "screen", "unknown"]
