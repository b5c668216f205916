"""`zerorate record --guide`: which turn is still missing, said while a device is in the hand."""

from .screen import Guide, screen, unknown

__all__ = ["Guide", "screen", "unknown"]
