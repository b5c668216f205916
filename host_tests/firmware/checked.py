"""An integer that minds 31 bits.

A small integer of a 32-bit MicroPython has 31 bits; what leaves them is an object on the heap, and
in C a wrapped number. Plain kernels compute with whatever they are given, so an I31 in every
word of their arrays checks every intermediate result.
"""

LEAST, MOST = -(1 << 30), (1 << 30) - 1


class OutOf31Bits(AssertionError):
    """An intermediate result that no small integer holds."""


class I31(int):
    """An int whose operators give I31 or raise OutOf31Bits."""

    __slots__ = ()


def checked(value, what=""):
    """The value as I31. Raises OutOf31Bits."""
    if not LEAST <= value <= MOST:
        raise OutOf31Bits(f"{what} = {value}")
    return int.__new__(I31, value)


def _checking(name):
    plain, make = getattr(int, name), int.__new__

    def operator(a, b):
        result = plain(a, b)
        if LEAST <= result <= MOST:
            return make(I31, result)
        raise OutOf31Bits(f"{int(a)} {name} {int(b)} = {result}")

    return operator


def _shifting(name):
    checking, by_the_first = _checking(name), name in ("__rlshift__", "__rrshift__")

    def operator(a, b):
        if 0 <= (a if by_the_first else b) <= 30:
            return checking(a, b)
        raise OutOf31Bits(f"{int(a)} {name} {int(b)}")

    return operator


def _dividing(name):
    checking = _checking(name)

    def operator(a, b):
        try:
            return checking(a, b)
        except ZeroDivisionError as error:
            raise OutOf31Bits(f"{int(a)} {name} {int(b)}") from error

    return operator


for _kind, _names in {
    _checking: ("add", "sub", "mul", "and", "or", "xor"),
    _shifting: ("lshift", "rshift"),
    _dividing: ("floordiv", "mod"),
}.items():
    for _name in _names:
        setattr(I31, f"__{_name}__", _kind(f"__{_name}__"))
        setattr(I31, f"__r{_name}__", _kind(f"__r{_name}__"))
I31.__neg__ = lambda a: checked(-int(a), f"-{int(a)}")
I31.__invert__ = lambda a: checked(~int(a))


class Words(list):
    """A list of I31 that takes only what fits; counts nothing, forgives nothing."""

    def __init__(self, values):
        super().__init__(checked(v, "settings or state") for v in values)

    def __setitem__(self, index, value):
        if index < 0:
            raise OutOf31Bits(f"word {int(index)} of the state")
        super().__setitem__(index, checked(value, f"word {int(index)}"))
