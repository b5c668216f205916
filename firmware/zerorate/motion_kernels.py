"""The kernels of the source in motion, loaded only by who learns in motion."""

from .kernels import VIPER

if VIPER:
    from .viper import in_motion
else:
    from . import in_motion

__all__ = ("in_motion",)
