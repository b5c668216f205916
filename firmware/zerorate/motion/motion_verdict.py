"""Whether a window in motion may teach a bias, and what is kept of it.

Refused: a window that hardly moves (the still source's), one that turned faster than the nodes
hold, and one whose mean force is not 1 g along one direction (the integration lost its way). Rows
that contradict what is known weigh little: a turn that stays turned. Contradiction that lasts is
believed.
"""

from ..arithmetic.fixed import clipped
from ..arithmetic.real import multiply, put, whole
from .least_squares import forget
from .thermal import forget_slopes

# layout: names that a board's own compiler reads
const = int
ptr32 = None
# layout: The state of the source in motion
_HEAD = const(8)
_FILLED = const(9)
_NEW_NODES = const(10)
_LENGTH = const(11)
_STAGE = const(12)
_PASS = const(14)
_FIRST_NODE = const(16)
_MOTION_REASON = const(17)
_START = const(28)
_UP = const(59)
_FAST = const(66)
_TRAFFIC = const(67)
_TILTED = const(68)
_ACCEPTED = const(70)
_REFUSED = const(71)
_AGAINST = const(72)
_MOTION_QUALITY_Q8 = const(76)
_NOTED_SLOPES_Q8 = const(79)
_BIAS = const(404)
_SLOPE = const(410)
_T = const(416)
_TURN_SUM = const(439)
# layout: The settings of the source in motion
_LEAST_TRAFFIC = const(7)
_NODES = const(8)
_LSB_A_UNIT = const(10)
_LONGEST = const(16)
_SHORTEST_STAGE = const(17)
_LEAST_UP = const(18)
_PATIENCE = const(19)
_MOTION_DOCUMENT = const(20)
_LEAST_TILT = const(34)
# layout: What a window in motion taught
_LEARNED = const(2)
_HARDLY_MOVES = const(3)
_TURNED = const(4)
_TOO_FAST = const(5)
_LOST = const(6)
# layout: end


def clear(s: ptr32, c: ptr32):
    """Know nothing: no bias, the widest covariance, the shortest window."""
    for i in range(3):
        put(s, _BIAS + 2 * i, 0, 0)
        s[_MOTION_QUALITY_Q8 + i] = 0x1FFFFFFF
    know_nothing(s, c)
    s[_STAGE] = c[_SHORTEST_STAGE] + 3 * c[_MOTION_DOCUMENT]
    s[_LENGTH] = 1 << s[_STAGE]


def know_nothing(s: ptr32, c: ptr32):
    """Forget what windows have taught, but for where the next integration begins."""
    forget(s, c)
    forget_slopes(s, c)
    s[_ACCEPTED] = 0
    s[_AGAINST] = 0


def start_window(s: ptr32, c: ptr32) -> int:
    """Begin a window if enough is new; return 1 if it begins."""
    n = s[_LENGTH]
    if s[_FILLED] < n or s[_NEW_NODES] < (n >> 1):
        return 0
    if s[_FAST]:
        s[_NEW_NODES] = 0
        s[_MOTION_REASON] = _TOO_FAST
        return 0
    s[_NEW_NODES] = 0
    s[_PASS] = c[_MOTION_DOCUMENT]
    s[_FIRST_NODE] = s[_HEAD] - n
    if s[_FIRST_NODE] < 0:
        s[_FIRST_NODE] += c[_NODES]
    for n in range(4):
        s[_START + n] = 0 if n else 0x4000
    return 1


def note_slope(s: ptr32, c: ptr32):
    """Note the slope of this pass, LSB in Q8, for who wants to see it."""
    i = 0
    a = _NOTED_SLOPES_Q8 + 3 * clipped(s[_PASS] - 1, 2)
    while i < 3:
        put(s, _T, c[_LSB_A_UNIT], c[_LSB_A_UNIT + 1])
        multiply(s, _T, _T, _SLOPE + 2 * i)
        s[a + i] = whole(s, _T, 0)
        i += 1


def verdict(s: ptr32, c: ptr32) -> int:
    """Return why the window teaches nothing, or _LEARNED."""
    if s[_FAST]:
        return _TOO_FAST
    if moves(s, c) == 0:
        return _HARDLY_MOVES
    if c[_MOTION_DOCUMENT] or s[_LENGTH] < c[_LONGEST]:
        return _LEARNED
    if s[_UP] >> s[_STAGE] < c[_LEAST_UP]:
        return _LOST
    return _LEARNED


def net(s: ptr32) -> int:
    """Return the sum of the half turns that did not come back, as _TRAFFIC."""
    total = 0
    for i in range(3):
        turn = s[_TURN_SUM + i]
        total += turn if turn > 0 else 0 - turn
    return total


def moves(s: ptr32, c: ptr32) -> int:
    """Return 1 if the window moves enough to teach, else 0."""
    # Only what comes back counts: a turn that goes on looks like a bias. A slow one about the
    # vertical does too, so a slow window must mostly tilt, which gravity shows: a hand, a boat and
    # a crane do, a car and a turntable do not.
    back = s[_TRAFFIC] - net(s)
    if back >= c[_LEAST_TRAFFIC] << s[_STAGE]:
        return 1
    least = c[_LEAST_TILT] << s[_STAGE]
    return 0 if back < least or s[_TILTED] < least or s[_TILTED] << 1 < s[_TRAFFIC] else 1


def refuse(s: ptr32, c: ptr32, reason: int):
    """Note why the window taught nothing; forget what is known if it is lost for long."""
    s[_MOTION_REASON] = reason
    s[_REFUSED] += 1
    if reason == _LOST:
        s[_AGAINST] += 1
        if s[_AGAINST] >= c[_PATIENCE]:
            clear(s, c)


def finish(s: ptr32, c: ptr32) -> int:
    """Count the window; know nothing and return 0 if the latest have all contradicted it."""
    s[_ACCEPTED] += 1
    if s[_MOTION_REASON] != _TURNED:
        s[_AGAINST] = 0
        return 1
    s[_REFUSED] += 1
    s[_AGAINST] += 1
    if s[_AGAINST] < c[_PATIENCE]:
        return 1
    clear(s, c)
    return 0
