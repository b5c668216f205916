"""Copies flat state, as the checkpoint of what was learned."""

ptr32 = None


def copy(source: ptr32, target: ptr32, length: int):
    """Put the first `length` words of `source` into `target`."""
    i = 0
    while i < length:
        target[i] = source[i]
        i += 1
