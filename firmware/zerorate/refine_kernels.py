"""The kernels that refine coefficients, loaded only by who asks for it."""

from .kernels import VIPER

if VIPER:
    from .viper import effect_refine
else:
    from . import effect_refine

__all__ = ("effect_refine",)
