"""`zerorate bench fleet`: how it scales, what a prior is worth, and a million devices on paper."""

from .measure import WORKERS, run, steps
from .report import markdown

__all__ = ["WORKERS", "markdown", "run", "steps"]
