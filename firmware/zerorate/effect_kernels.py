"""The kernels of the effect slots, loaded only by who has a model."""

from .kernels import VIPER

if VIPER:
    from .viper import effects
else:
    from . import effects

__all__ = ("effects",)
