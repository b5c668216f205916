# Generated from zerorate/copying.py by `make viper`: edit that file, not this one.
"""Copies flat state, as the checkpoint of what was learned."""

import micropython


@micropython.viper
def copy(source, target, first: int, end: int):
    s = ptr32(source)
    t = ptr32(target)
    i = first
    while i < end:
        t[i] = s[i]
        i = i + 1
