"""`zerorate bench loop`: what closing the loop finds, names, removes and invents."""

from .trials import markdown, renewed, run

__all__ = ["markdown", "renewed", "run"]
