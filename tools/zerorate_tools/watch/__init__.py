"""The firmware at work while a recording grows or a board streams."""

from .watching import watch

__all__ = ["watch"]
