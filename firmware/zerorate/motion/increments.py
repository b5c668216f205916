"""Samples gathered into nodes of a fixed time: one rotation and one specific force each.

The ring keeps, a node and axis in one word, the increment (Q13 rad, 15 bits) above the mean force
(Q11 g, 15 bits). What rounding leaves over stays for the next node, so no angle is lost in the sum.
"""

from ..arithmetic.fixed import clipped

# layout: names that a board's own compiler reads
const = int
ptr32 = None
# layout: The state of the source in motion
_NODE_ELAPSED_US = const(0)
_NODE_N = const(1)
_NODE_ANGLE_Q24 = const(2)
_NODE_FORCE_Q12 = const(5)
_HEAD = const(8)
_FILLED = const(9)
_NEW_NODES = const(10)
_BIAS_Q24 = const(63)
_FAST = const(66)
_AGE_NODES = const(69)
_FRAME_FORCE_Q12 = const(424)
_NODES_RING = const(443)
_FRAME_ANGLE_Q24 = const(18)
_CONING_Q24 = const(416)
_SCULLING_Q12 = const(419)
# layout: The settings of the source in motion
_NODE_US = const(0)
_MOTION_GAIN = const(1)
_MOTION_GAIN_SHIFT = const(2)
_MOTION_SHIFT = const(3)
_FORCE_GAIN = const(4)
_NODES = const(8)
# layout: end
_TWO_RAD_Q24 = const(0x1FFFFFF)
_HALF_RAD_Q24 = const(0x7F0000)  # in a sample: two products with 2 rad fit
_MOST_ANGLE_Q13 = const(0x3FFF)
_MOST_FORCE_Q12 = const(0x7FFF)


def turn_back(s: ptr32, j: int, k: int):
    """Write what turning the third axis back to the node's start adds: to the turn (coning), Q24
    rad, half the cross product with the turned angle; to the force (sculling), Q12 g, the whole."""
    a = (s[_NODE_ANGLE_Q24 + j] + 0x400) >> 11
    b = (s[_NODE_ANGLE_Q24 + k] + 0x400) >> 11
    part = a * ((s[_FRAME_ANGLE_Q24 + k] + 0x80) >> 8)
    part -= b * ((s[_FRAME_ANGLE_Q24 + j] + 0x80) >> 8)
    s[_CONING_Q24 + 3 - j - k] = (part + 32) >> 6
    part = a * s[_FRAME_FORCE_Q12 + k] - b * s[_FRAME_FORCE_Q12 + j]
    s[_SCULLING_Q12 + 3 - j - k] = clipped((part + 0x1000) >> 13, _MOST_FORCE_Q12)


def turn_again(s: ptr32, j: int, k: int):
    """Add the second order of that to the third axis of the frame."""
    # A hand turns by a radian in a node: a sixth of one cross product more with the coning (Bortz
    # 1971), half of one with what turning back adds to the force.
    a = (s[_NODE_ANGLE_Q24 + j] + 0x400) >> 11
    b = (s[_NODE_ANGLE_Q24 + k] + 0x400) >> 11
    part = a * ((s[_CONING_Q24 + k] + 0x200) >> 10) - b * ((s[_CONING_Q24 + j] + 0x200) >> 10)
    s[_FRAME_ANGLE_Q24 + 3 - j - k] += ((part + 0x400) >> 11) * 43  # rounded: what is left adds up
    part = a * s[_SCULLING_Q12 + k] - b * s[_SCULLING_Q12 + j]
    s[_FRAME_FORCE_Q12 + 3 - j - k] += (part + 0x2000) >> 14


def turn_q24(value: int, shift: int) -> int:
    """Return value / 2^shift, rounded: rad Q24, half a radian and one at most where it grows."""
    if shift > 0:
        return ((value >> (shift - 1)) + 1) >> 1
    # a rate of a few LSB, over a long time
    return clipped(value, (_HALF_RAD_Q24 >> (0 - shift)) + 1) << (0 - shift)


def convert_turns(s: ptr32, c: ptr32, x: ptr32, factor: int):
    """Write the frame's turns, Q24 rad, to scratch words."""
    shift = c[_MOTION_SHIFT]
    # eleven words: factor is halved where the time is long, or with a rate it would not fit
    while factor > 0x3FFF:
        factor = factor >> 1
        shift -= 1
    i = 0
    while i < 3:
        value = turn_q24(x[4 + i] * factor, shift)
        s[_FRAME_ANGLE_Q24 + i] = clipped(value, _HALF_RAD_Q24)
        if s[_FRAME_ANGLE_Q24 + i] != value:
            s[_FAST] = c[_NODES]
        i += 1


def convert_forces(s: ptr32, c: ptr32, x: ptr32):
    """Write the frame's forces, Q12 g, to scratch words."""
    i = 0
    beyond = 0xFFFFFFF // c[_FORCE_GAIN]  # the most of a force
    while i < 3:
        value = clipped(x[i], beyond) * c[_FORCE_GAIN]
        s[_FRAME_FORCE_Q12 + i] = clipped((value + 0x1000) >> 13, _MOST_FORCE_Q12)
        i += 1


def gather(s: ptr32, c: ptr32, x: ptr32, dt_us: int) -> int:
    """Add the frame `x` to the node; return 1 when the node is full, else 0."""
    convert_forces(s, c, x)
    convert_turns(s, c, x, (dt_us * c[_MOTION_GAIN]) >> c[_MOTION_GAIN_SHIFT])
    turn_back(s, 1, 2)
    turn_back(s, 2, 0)
    turn_back(s, 0, 1)
    turn_again(s, 1, 2)
    turn_again(s, 2, 0)
    turn_again(s, 0, 1)
    advance(s, c)
    s[_NODE_N] += 1
    s[_NODE_ELAPSED_US] += dt_us
    return 1 if s[_NODE_ELAPSED_US] >= c[_NODE_US] else 0


def advance(s: ptr32, c: ptr32):
    """Add what the frame turned and pulled to the node."""
    i = 0
    while i < 3:
        s[_NODE_FORCE_Q12 + i] += s[_FRAME_FORCE_Q12 + i] + s[_SCULLING_Q12 + i]
        angle = s[_NODE_ANGLE_Q24 + i] + s[_FRAME_ANGLE_Q24 + i] + s[_CONING_Q24 + i]
        s[_NODE_ANGLE_Q24 + i] = clipped(angle, _TWO_RAD_Q24)
        if s[_NODE_ANGLE_Q24 + i] != angle:
            s[_FAST] = c[_NODES]
        i += 1


def close(s: ptr32, c: ptr32):
    """Write the full node to the ring and begin the next one."""
    # The node's last sample reaches over its end: the bias' share of that belongs to the next node.
    s[_NODE_ELAPSED_US] -= c[_NODE_US]
    a = _NODES_RING + 3 * s[_HEAD]
    for i in range(3):
        over = (s[_NODE_ELAPSED_US] << 10) // c[_NODE_US]
        over = ((s[_BIAS_Q24 + i] >> 8) * over) >> 2
        angle = clipped((s[_NODE_ANGLE_Q24 + i] - over + 0x400) >> 11, _MOST_ANGLE_Q13)
        over = (s[_NODE_FORCE_Q12 + i] + s[_NODE_N]) // (2 * s[_NODE_N])
        over = clipped(over, _MOST_ANGLE_Q13)
        s[a + i] = (angle << 15) + (over & 0x7FFF)
        angle = s[_NODE_ANGLE_Q24 + i] - (angle << 11)
        s[_NODE_ANGLE_Q24 + i] = clipped(angle, _TWO_RAD_Q24)
        s[_NODE_FORCE_Q12 + i] = 0
    s[_NODE_N] = 0
    next_node(s, c)


def next_node(s: ptr32, c: ptr32):
    """Go to the next place of the ring."""
    s[_HEAD] += 1
    if s[_HEAD] >= c[_NODES]:
        s[_HEAD] = 0
    if s[_FILLED] < c[_NODES]:
        s[_FILLED] += 1
    s[_NEW_NODES] += 1
    s[_AGE_NODES] += 1
    if s[_FAST] > 0:
        s[_FAST] -= 1


def restart(s: ptr32):
    """Forget the node and the window, after a gap in time or a bad reading."""
    for i in range(_NEW_NODES + 1):
        s[i] = 0
