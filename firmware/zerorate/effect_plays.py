"""Prandtl-Ishlinskii hysteresis: a weighted sum of play operators, each with its square.

A play operator follows its source only where that pushes it, its radius behind; several of them
are a part whose loop over temperature has inner loops and rounded ends. Each has three coefficients
of what it is and three of its square, for real loops are lopsided (M. Al Janaideh, S. Rakheja and
C.-Y. Su, 2011, IEEE/ASME Transactions on Mechatronics 16, 734, for plays seen through a function).
At power-on each stands where its source is: what was before is not known. Words: see model.py.
"""

try:
    from micropython import const
except ImportError:

    def const(value):
        return value


ptr32 = None


from .effect_basis import add_times, centred
from .fixed import scaled

_NONE = const(-0x3FFFFFFF)

_SUM_Q14 = const(10)

_RADIUS = const(5)
_SHIFT = const(6)
_COEFFICIENT = const(7)
_OF_SQUARE = const(10)
_STARTED = const(13)
_STATE = const(14)


def play(e: ptr32, a: int):
    """Move the play operator at word a for a tick, and add what it says to the tick's sums."""
    v = centred(e, a)
    if v == _NONE:
        return
    p = e[a + _STATE]
    if e[a + _STARTED] == 0:
        e[a + _STARTED] = 1
        p = v
    elif p < v - e[a + _RADIUS]:
        p = v - e[a + _RADIUS]
    elif p > v + e[a + _RADIUS]:
        p = v + e[a + _RADIUS]
    e[a + _STATE] = p
    v = scaled(p, p, 24)
    add_times(e, p, a + _COEFFICIENT, e[a + _SHIFT], _SUM_Q14)
    add_times(e, v, a + _OF_SQUARE, e[a + _SHIFT], _SUM_Q14)
