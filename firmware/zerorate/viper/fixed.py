# Generated from zerorate/fixed.py by `make viper`: edit that file, not this one.
"""Fixed-point arithmetic that never leaves 31 bits."""

import micropython


try:
    from micropython import const
except ImportError:

    def const(value):
        return value


_LOW = const(0x7FFF)


@micropython.viper
def scaled(a: int, b: int, shift: int) -> int:
    """Return (a * b) >> shift for |a|, |b| < 2^28 and shift 15..30, to within one unit."""
    high = b >> 15
    b = b & _LOW
    middle = (a >> 15) * b + (a & _LOW) * high + (((a & _LOW) * b) >> 15)
    high = (a >> 15) * high
    return (high << (30 - shift)) + (middle >> (shift - 15))


@micropython.viper
def fraction_q27(a: int, b: int) -> int:
    """Return a / b in Q27 for 0 <= a <= b < 2^20, b > 0."""
    q = 0
    i = 0
    while i < 3:
        a = a << 9
        q = (q << 9) + a // b
        a = a % b
        i += 1
    return q


@micropython.viper
def ratio_q26(a: int, b: int) -> int:
    """Return a / b in Q26, saturated at +-4, for |a| < 2^28 and 0 <= b < 2^28; 0 where b is 0."""
    sign = 1
    if a < 0:
        a = -a
        sign = -1
    if b == 0:
        return 0
    if a >> 2 >= b:
        return sign * 0xFFFFFFF
    q = a // b
    a = a % b
    i = 0
    while i < 26:
        a = a << 1
        q = q << 1
        if a >= b:
            a -= b
            q += 1
        i += 1
    return sign * q


@micropython.viper
def root(square: int) -> int:
    """Return the integer square root of 0 <= square < 2^30."""
    bit = 1 << 14
    found = 0
    while bit:
        if (found + bit) * (found + bit) <= square:
            found += bit
        bit = bit >> 1
    return found
