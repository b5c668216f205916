# Generated from zerorate/fixed.py by `make viper`: edit that file, not this one.
"""Fixed-point arithmetic that never leaves 31 bits."""

import micropython


@micropython.viper
def scaled(a: int, b: int, shift: int) -> int:
    high = b >> 15
    b = b & 32767
    middle = (a >> 15) * b + (a & 32767) * high + ((a & 32767) * b >> 15)
    high = (a >> 15) * high
    return (high << 30 - shift) + (middle >> shift - 15)


@micropython.viper
def root(square: int) -> int:
    bit = 16384
    if square < 16777216:
        bit = 2048
    found = 0
    while bit:
        more = found + bit
        if more * more <= square:
            found = more
        bit = bit >> 1
    return found
