"""Fractions of integers: settings come out the same at any width of the floats given."""

from math import frexp

PI = (3141592653589793, 1000000000000000)
_DIGITS = 100000  # the least number of six digits: what the narrowest floats of a board tell apart


class Ratio:
    """over / under, of integers; a float counts to six digits, or to the unit where it has more."""

    def __init__(self, over, under=1):
        if int(over) != over:
            over, under = _six_digits(over)
        self.over = int(over)
        self.under = under

    def __mul__(self, other):
        other = _ratio(other)
        return Ratio(self.over * other.over, self.under * other.under)

    def __truediv__(self, other):
        other = _ratio(other)
        return Ratio(self.over * other.under, self.under * other.over)

    def floor(self):
        """The integer not above it."""
        return self.over // self.under

    def nearest(self):
        """The nearest integer; of two as near the larger."""
        return (2 * self.over + self.under) // (2 * self.under)

    def squared(self, most=1 << 28):
        """The square's floor, 1..most."""
        return max(1, min(most, self.over * self.over // (self.under * self.under)))


def _ratio(value):
    return value if isinstance(value, Ratio) else Ratio(value)


def _six_digits(value):
    mantissa, exponent = frexp(value)
    over = int(mantissa * (1 << 30))
    exponent -= 30
    under = 1
    if exponent < 0:
        under <<= -exponent
    else:
        over <<= exponent
    scale = 1
    while over * scale < _DIGITS * under:
        scale *= 10
    return (2 * over * scale + under) // (2 * under), scale
