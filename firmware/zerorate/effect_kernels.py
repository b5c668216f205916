"""The kernel of the effect slots, loaded only by who has a model."""

from .kernels import VIPER

if VIPER:
    from .viper.effects import sense
else:
    from .effects import sense

__all__ = ("sense",)
