"""`zerorate bench boards`: the firmware on an emulated Pico: memory, time, and equal numbers."""

from .measuring import STEPS, in_markdown, measure

__all__ = ["STEPS", "in_markdown", "measure"]
