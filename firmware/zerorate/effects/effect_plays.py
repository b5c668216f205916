"""Prandtl-Ishlinskii hysteresis: a weighted sum of play operators, each with its square.

A play operator follows its source only where that pushes it, its radius behind; several of them
are a part whose loop over temperature has inner loops and rounded ends. Each has three coefficients
of what it is and three of its square, for real loops are lopsided (M. Al Janaideh, S. Rakheja and
C.-Y. Su, 2011, IEEE/ASME Transactions on Mechatronics 16, 734, for plays seen through a function).
At power-on each stands where its source is: what was before is not known. Words: docs/layout.md.
"""

from ..arithmetic.fixed import scaled
from .effect_basis import add_times, centred

# layout: names that a board's own compiler reads
const = int
ptr32 = None
# layout: The effect model and its running state
_SUM_Q14 = const(17)
# layout: A play operator
_PLAY_RADIUS = const(5)
_PLAY_SHIFT = const(6)
_PLAY_COEFFICIENT = const(7)
_PLAY_OF_SQUARE = const(10)
_PLAY_STARTED = const(13)
_PLAY_STATE = const(14)
# layout: Values that stand for none
_NO_VALUE = const(-0x3FFFFFFF)
# layout: end


def play(e: ptr32, a: int):
    """Move the play operator at word a for a tick, and add what it says to the tick's sums."""
    v = centred(e, a)
    if v == _NO_VALUE:
        return
    p = e[a + _PLAY_STATE]
    if e[a + _PLAY_STARTED] == 0:
        e[a + _PLAY_STARTED] = 1
        p = v
    elif p < v - e[a + _PLAY_RADIUS]:
        p = v - e[a + _PLAY_RADIUS]
    elif p > v + e[a + _PLAY_RADIUS]:
        p = v + e[a + _PLAY_RADIUS]
    e[a + _PLAY_STATE] = p
    v = scaled(p, p, 24)
    add_times(e, p, a + _PLAY_COEFFICIENT, e[a + _PLAY_SHIFT], _SUM_Q14)
    add_times(e, v, a + _PLAY_OF_SQUARE, e[a + _PLAY_SHIFT], _SUM_Q14)
