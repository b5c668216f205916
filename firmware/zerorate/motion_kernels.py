"""The kernels of the other two sources, loaded only by who learns from them."""

from .kernels import VIPER

if VIPER:
    from .viper import in_motion, realtime
else:
    from . import in_motion, realtime

__all__ = ("in_motion", "realtime")
