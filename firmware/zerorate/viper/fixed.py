# Generated from zerorate/fixed.py by `make viper`: edit that file, not this one.
"""Fixed-point arithmetic that never leaves 31 bits."""

import micropython


@micropython.viper
def scaled(b: int, a: int, shift: int) -> int:
    high = b >> 15
    b = b & 32767
    middle = (a >> 15) * b + (a & 32767) * high + ((a & 32767) * b >> 15)
    high = (a >> 15) * high
    return (high << 30 - shift) + (middle >> shift - 15)


@micropython.viper
def room(value: int) -> int:
    if value >> 30:
        value = 0 - value
    shift = 0
    if not value:
        return 27
    if value < 2048:
        value = value << 16
        shift = 16
    if value < 524288:
        value = value << 8
        shift = shift + 8
    if value < 8388608:
        value = value << 4
        shift = shift + 4
    if value < 33554432:
        value = value << 2
        shift = shift + 2
    if value < 67108864:
        shift = shift + 1
    return shift


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
