"""`zerorate bench boards`: the firmware on an emulated Pico: memory, time, and equal numbers."""

from .measuring import measure
from .report import in_markdown

__all__ = ["in_markdown", "measure"]
