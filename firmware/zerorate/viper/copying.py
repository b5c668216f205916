# Generated from zerorate/copying.py by `make viper`: edit that file, not this one.
"""Copies flat state, as the checkpoint of what was learned."""

import micropython


@micropython.viper
def copy(source, target, length: int):
    """Put the first `length` words of `source` into `target`."""
    s = ptr32(source)
    t = ptr32(target)
    i = 0
    while i < length:
        t[i] = s[i]
        i += 1
