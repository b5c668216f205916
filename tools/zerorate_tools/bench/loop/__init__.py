"""`zerorate bench loop`: what closing the loop finds, names, removes and invents."""

from .run import markdown, run

__all__ = ["markdown", "run"]
