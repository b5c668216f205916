"""Copies flat state, as the checkpoint of what was learned."""

ptr32 = None


def copy(s: ptr32, t: ptr32, first: int, end: int):
    """Put the words from `first` up to `end` of `s` into `t`."""
    for i in range(first, end):
        t[i] = s[i]
