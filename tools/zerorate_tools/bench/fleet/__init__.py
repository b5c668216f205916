"""`zerorate bench fleet`: how it scales, what a prior is worth, and a million devices on paper."""

from .measure import WORKERS, run, steps
from .report import in_markdown

__all__ = ["WORKERS", "in_markdown", "run", "steps"]
