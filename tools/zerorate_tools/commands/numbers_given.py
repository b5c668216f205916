"""Numbers of options: what is none that can be is refused with the usage."""

from argparse import ArgumentTypeError
from math import isfinite

_MOST = 1e9


def finite(text: str) -> float:
    """A number, and neither nan nor inf."""
    value = float(text)
    if not isfinite(value):
        raise ArgumentTypeError(f"{text} is no finite number")
    return value


def above_zero(text: str) -> float:
    """A number above 0, up to a billion: 30 years of seconds, and no rate or scale has more."""
    value = finite(text)
    if not 0 < value <= _MOST:
        raise ArgumentTypeError(f"{text} is not above 0, up to {_MOST:.0e}")
    return value
