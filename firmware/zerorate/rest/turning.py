"""Whether an apparent rest may be a turn: what gravity cannot show lies along gravity."""

# A rest tells bias plus a possible turn. A turn about a level axis moves gravity; what is left can
# only be along it, while a bias that jumps has a direction of its own in the body. So an error
# along gravity is no evidence against a bias that is known.

from ..arithmetic.fixed import clipped, root
from .recent import well_known

# layout: names that a board's own compiler reads
const = int
ptr32 = None
# layout: The corrector's state
_ANCHOR_Q4 = const(36)
_TARGET_Q8 = const(73)
# layout: An axis
_WAITING_SUM = const(0)
_WAITING_N = const(1)
_OFFER = const(12)
_SUSPECT = const(30)
_LEFT_Q4 = const(37)
# layout: The corrector's settings
_AXES = const(0)
_AXIS_WORDS = const(15)
# layout: Values that stand for none
_NO_VALUE = const(-0x3FFFFFFF)
# layout: end
_MOST_ERROR_Q4 = const(0x1FFFF)  # times _MOST_G, three times over, it fits 31 bits
_MOST_G = const(0x7FF)
_MAY_TURN = const(-1)


def off_q4(s: ptr32, c: ptr32, axis: int) -> int:
    """Return how far the waiting segment lies from the bias that is subtracted: LSB, Q4."""
    a = c[_AXES] + axis * c[_AXIS_WORDS]
    n = s[a + _WAITING_N]
    mean = s[a + _WAITING_SUM]
    mean = ((mean // n) << 8) + ((mean % n) << 8) // n
    return clipped((mean - s[_TARGET_Q8 + axis]) >> 4, _MOST_ERROR_Q4)


def up(s: ptr32, axis: int) -> int:
    """Return gravity along the axis where the rest began, in units of 16 LSB."""
    return clipped(s[_ANCHOR_Q4 + axis] >> 8, _MOST_G)


def along(s: ptr32, c: ptr32, size: int) -> int:
    """Return the segment's error along gravity: LSB, Q4. size: of gravity."""
    total = 0
    for i in range(3):
        total += off_q4(s, c, i) * up(s, i)
    return total // size


def square_aside(s: ptr32, c: ptr32, axis: int, slope_q10: int) -> int:
    """Return the square of an axis' error aside from gravity. slope_q10: error by gravity."""
    aside = off_q4(s, c, axis)
    aside = clipped(aside - (slope_q10 * up(s, axis) >> 10), 0x3FFF)
    return aside * aside


def asides(s: ptr32, c: ptr32, slope_q10: int) -> int:
    """Return the square of the segment's error that is not along gravity."""
    total = square_aside(s, c, 0, slope_q10)
    total += square_aside(s, c, 1, slope_q10)
    total += square_aside(s, c, 2, slope_q10)
    return total


def seems_a_turn(s: ptr32, c: ptr32) -> int:
    """Return 1 if the waiting segment's error lies within 27 degrees of gravity, else 0."""
    size = up(s, 0) * up(s, 0) + up(s, 1) * up(s, 1)
    size = root(size + up(s, 2) * up(s, 2))
    if size == 0:
        return 0
    turn = along(s, c, size)
    aside = asides(s, c, (turn << 10) // size)
    turn = clipped(turn >> 1, 0x3FFF)
    return 1 if aside <= turn * turn else 0


def suspect_turn(s: ptr32, c: ptr32):
    """Mark the waiting segment of every axis as a possible turn, where the bias is well known."""
    # Well known: learned from as long a rest as must insist, and found again since power-on.
    a = c[_AXES]
    last = a + 3 * c[_AXIS_WORDS]
    turn = seems_a_turn(s, c)
    while a < last:
        s[a + _OFFER] = 0
        if turn and s[a + _LEFT_Q4] != _NO_VALUE and well_known(s, c, a):
            s[a + _OFFER] = _MAY_TURN
        a += c[_AXIS_WORDS]


def end_of_rest(s: ptr32, c: ptr32):
    """Let a possible turn insist anew: only one unbroken rest tells that it is none."""
    for i in range(3):
        a = c[_AXES] + i * c[_AXIS_WORDS]
        if s[a + _SUSPECT] < 0:
            s[a + _SUSPECT] = 0
