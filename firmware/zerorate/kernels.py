"""Chooses the kernels: viper where it is right and there, else the same text as bytecode."""

import sys

try:
    # viper loads are unsigned in 64-bit words; what loads no native code has no viper either
    if sys.maxsize >> 31 or not getattr(sys.implementation, "_mpy", 0) >> 10:
        raise ImportError
    from .viper import estimators, step  # noqa: F401

    VIPER = True
except (ImportError, SyntaxError, ValueError):
    from . import estimators, step  # noqa: F401

    VIPER = False
