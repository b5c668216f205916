"""What else the rest path's machine code does, each by the number of a stage."""

from .choosing import code

try:
    from micropython import const
except ImportError:

    def const(value):
        return value


# what stands in the fourth argument's upper half word (tools/zerorate_tools/kernels/parts.py)
_ADMIT = const(-0x40000000)
_FINISH = const(-0x3FFF0000)
_CONSIDER = const(-0x3FFE0000)
_RESET = const(-0x3FFD0000)
_COPY = const(-0x3FFC0000)

step = code["rest"]


def admit(s, c, x, kind):
    return step(s, c, x, _ADMIT + kind)


def finish(s, c, x, kind):
    return step(s, c, x, _FINISH + kind)


def consider(s, c, m, w, source):
    step(s, c, m, _CONSIDER + (source << 8) + w)


def reset(s, c, a):
    step(s, c, 0, _RESET + a)


def copy(source, target, first, end):
    step(source, target, end, _COPY + first)
