"""`zerorate bench boards`: the firmware on an emulated Pico: memory, time, and equal numbers."""

from .measuring import STEPS, measure
from .report import in_markdown

__all__ = ["STEPS", "in_markdown", "measure"]
