"""A window's nodes one by one: orientation from its first node on, less the bias, and its sums."""

from ..arithmetic.fixed import clipped
from ..arithmetic.real import whole
from .attitude import normalise, rotation, sines, turn
from .regression import rows, weights
from .tilt_frame import begin_attitude, level, observe

# layout: names that a board's own compiler reads
const = int
ptr32 = None
# layout: The state of the source in motion
_LENGTH = const(11)
_STAGE = const(12)
_JOB = const(13)
_PASS = const(14)
_PROGRESS = const(15)
_FIRST_NODE = const(16)
_HALF = const(18)
_Q = const(24)
_START = const(28)
_R = const(32)
_HALF_BEFORE = const(48)
_Y = const(51)
_BIAS_CARRY_Q24 = const(54)
_TILT = const(57)
_OTHER_TILT = const(58)
_UP = const(59)
_TURN_MEAN = const(60)
_BIAS_Q24 = const(63)
_TRAFFIC = const(67)
_TILTED = const(68)
_ACCEPTED = const(70)
_WINDOW_ROWS = const(88)
_KNOWN = const(204)
_BIAS = const(404)
_TURN_SUM = const(439)
_NODES_RING = const(443)
# layout: The settings of the source in motion
_NODES = const(8)
_MOTION_DOCUMENT = const(20)
# layout: What the source in motion is doing
_TRAVERSE = const(1)
_SOLVE = const(2)
# layout: end
_MOST_BIAS_Q24 = const(0x7FFFFF)  # half a radian in a node, some 200 deg/s
_MOST_HALF_Q14 = const(0x3FFF)
_SETTLED_AFTER = const(8)


def begin_traversal(s: ptr32, c: ptr32):
    """Begin at the window's first node with the bias of this pass removed."""
    # While little is known a steady turn may be a bias, so motion is what is beside it.
    beside = 1 if s[_PASS] & 1 and s[_ACCEPTED] < _SETTLED_AFTER else 0
    if c[_MOTION_DOCUMENT]:
        beside = 0
    elif s[_PASS] & 1 == 0:
        begin_levelling(s)
    for i in range(_KNOWN - _WINDOW_ROWS):
        s[_WINDOW_ROWS + i] = 0
    for i in range(3):
        s[_TURN_MEAN + i] = s[_TURN_SUM + i] >> s[_STAGE] if beside else 0
        s[_TURN_SUM + i] = 0
        s[_HALF_BEFORE + i] = 0
        s[_BIAS_Q24 + i] = clipped(whole(s, _BIAS + 2 * i, 0), _MOST_BIAS_Q24)
        s[_BIAS_CARRY_Q24 + i] = 0
    s[_UP] = 0
    s[_TRAFFIC] = 0
    s[_TILTED] = 0
    s[_PROGRESS] = 0
    s[_JOB] = _TRAVERSE
    begin_attitude(s)


def begin_levelling(s: ptr32):
    """Find first where the mean force is up, in the attitude of the first node."""
    s[_START] = 0x4000
    for i in range(1, 4):
        s[_START + i] = 0
    s[_TILT] = 0
    s[_OTHER_TILT] = 0


def visit(s: ptr32, c: ptr32):
    """Integrate over one node and add it to the sums."""
    a = s[_FIRST_NODE] + s[_PROGRESS]
    if a >= c[_NODES]:
        a -= c[_NODES]
    a = _NODES_RING + 3 * a
    rotation(s)
    remove_bias(s, a)
    if c[_MOTION_DOCUMENT]:
        observe_vector(s)
    elif s[_PASS] & 1:
        observe(s, a)
    else:
        level(s, a)
    if s[_PASS] & 1 or c[_MOTION_DOCUMENT]:
        weights(s, s[_PROGRESS], s[_STAGE], c[_MOTION_DOCUMENT])
        rows(s)
    a = tilting(s, 0)
    a += tilting(s, 3)
    s[_TILTED] += a
    sines(s)
    turn(s)
    normalise(s)
    s[_PROGRESS] += 1
    if s[_PROGRESS] >= s[_LENGTH]:
        s[_PROGRESS] = 0
        s[_JOB] = _SOLVE


def observe_vector(s: ptr32):
    """Take the rotation vector from the start, Q12 rad."""
    for i in range(3):
        s[_Y + i] = s[_Q + 1 + i] >> 15
        if s[_Q] < 0:
            s[_Y + i] = -s[_Y + i]


def remove_bias(s: ptr32, a: int):
    """Take the bias from the node's increment and write its half angles, Q14 rad."""
    # What the bias has below a unit is carried from node to node.
    for i in range(3):
        s[_BIAS_CARRY_Q24 + i] += s[_BIAS_Q24 + i]
        part = (s[_BIAS_CARRY_Q24 + i] + 0x400) >> 11
        s[_BIAS_CARRY_Q24 + i] -= part << 11
        part = clipped((s[a + i] >> 15) - part, _MOST_HALF_Q14)
        s[_HALF + i] = part
        part -= s[_TURN_MEAN + i]
        s[_TURN_SUM + i] += part
        s[_TRAFFIC] += part if part > 0 else 0 - part


def tilting(s: ptr32, row: int) -> int:
    """Return how far the node turned about a level axis, half angle, Q14 rad: gravity shows it."""
    part = 0x2000
    for i in range(3):
        part += s[_R + row + i] * (s[_HALF + i] - s[_TURN_MEAN + i])
    part = part >> 14
    return part if part > 0 else 0 - part
