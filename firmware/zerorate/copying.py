"""Copies flat state, as the checkpoint of what was learned."""


def ptr32(words):
    return words


def copy(source, target, length: int):
    """Put the first `length` words of `source` into `target`."""
    s = ptr32(source)
    t = ptr32(target)
    i = 0
    while i < length:
        t[i] = s[i]
        i += 1
