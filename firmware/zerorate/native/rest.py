"""The way of a sample at rest: examined, learned from, corrected."""

from .choosing import machine_code

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

step = machine_code("rest")

if step:

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

else:
    from ..copying import copy  # noqa: F401
    from ..estimators import reset  # noqa: F401
    from ..step import admit, consider, finish, step  # type: ignore[assignment]  # noqa: F401
