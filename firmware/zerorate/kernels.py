"""Chooses the kernels: viper where it is right and there, else the same text as bytecode."""

import sys

try:
    # viper loads are unsigned in 64-bit words, and CPython has no viper
    if sys.maxsize >> 31:
        raise ImportError
    from .viper import estimators, histogram, step

    VIPER = True
except (ImportError, SyntaxError, ValueError):
    from . import estimators, histogram, step

    VIPER = False

__all__ = ("VIPER", "estimators", "histogram", "step")
