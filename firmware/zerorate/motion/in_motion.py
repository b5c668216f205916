"""The bias from motion that returns: the slope of integrated orientation over a stored window.

US 10,451,438: store the rates, find the stretch that moves, integrate it to orientation, fit a
line, take the slope as bias, remove it, integrate again. Two forms:

- the document's own: each axis' slope of the orientation vector is that axis' bias;
- the default: tilt comes from gravity in the tilt frame, only the heading from the assumption
  that it returns; a few rows of each window go into a filter of the bias, scale and axes, whose
  weights come from what is left of the rows.

A window grows from 2 s while nothing is known, for a large bias turns a long one too far to be
linear. Work is spread: a few nodes or pieces of algebra a sample. The state is one array('i')
of 293 words and 3 a node; motion_settings.py makes the settings.
"""

from ..arithmetic.fixed import clipped
from ..arithmetic.real import copy, subtract, whole
from .attitude import normalise, rotation, sines, turn
from .increments import close, gather, restart
from .least_squares import (
    follow_noise,
    innovate,
    look,
    move,
    narrow,
    own_slope,
    stray,
    sweep,
    weigh,
)
from .motion_verdict import finish, know_nothing, note_slope, refuse, start_window, verdict
from .posterior import know_prior, publish, shrink, weigh_prior
from .regression import rows, weights
from .thermal import carry, follow_temperature, learn_slope
from .tilt_frame import begin_attitude, find_up, level, observe

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
_MOTION_REASON = const(17)
_HALF = const(18)
_Q = const(24)
_START = const(28)
_R = const(32)
_HALF_BEFORE = const(46)
_Y = const(49)
_BIAS_CARRY_Q24 = const(52)
_TILT = const(55)
_BIAS_Q24 = const(56)
_OTHER_TILT = const(59)
_UP = const(60)
_TRAFFIC = const(62)
_TILTED = const(63)
_ACCEPTED = const(65)
_WINDOW_ROWS = const(83)
_KNOWN = const(150)
_BIAS = const(251)
_SLOPE = const(257)
_T = const(263)
_TURN_SUM = const(286)
_TURN_MEAN = const(289)
_LATE_US = const(292)
_NODES_RING = const(293)
# layout: The settings of the source in motion
_VISITS = const(5)
_MOTION_GAP_US = const(6)
_NODES = const(8)
_PASSES = const(9)
_LONGEST = const(16)
_MOTION_DOCUMENT = const(20)
_SETTLED = const(22)
# layout: What the source in motion is doing
_IDLE = const(0)
_TRAVERSE = const(1)
_SOLVE = const(2)
# layout: What a window in motion taught
_GROWING = const(1)
_LEARNED = const(2)
_MOTION_GAP = const(7)
# layout: end
_MOST_BIAS_Q24 = const(0x7FFFFF)  # half a radian in a node, some 200 deg/s
_MOST_HALF_Q14 = const(0x3FFF)
_NODES_A_PIECE = const(4)  # of algebra, by what they cost
_ROWS_A_WINDOW = const(5)
_ROW_PIECES = const(15)
_SETTLED_AFTER = const(8)
_SHRUNK = const(24)  # six rounds: where one sigma is a fifth of the bias, less stop halfway


def update(s: ptr32, c: ptr32, x: ptr32, dt_us: int) -> int:
    """Take the raw frame `x`, dt_us after the one before; return 1 where a bias was learned."""
    since_us = dt_us + s[_LATE_US]
    s[_LATE_US] = 0
    if since_us <= 0 or since_us > c[_MOTION_GAP_US]:
        restart(s)
        s[_JOB] = _IDLE
        s[_MOTION_REASON] = _MOTION_GAP
        return 0
    if gather(s, c, x, since_us):
        follow_temperature(s, x[3])
        close(s, c)
    if s[_JOB] == _IDLE:
        if start_window(s, c):
            begin_traversal(s, c)
        return 0
    return work(s, c)


def work(s: ptr32, c: ptr32) -> int:
    """Do the next nodes of a traversal, or the next pieces of algebra; return 1 as `update`."""
    # At a low rate one piece a sample would take until new nodes overwrite what is yet to be read.
    learned = 0
    i = c[_VISITS]
    while i > 0 and s[_JOB] != _IDLE:
        if s[_JOB] == _SOLVE:
            learned = solve(s, c)
            i -= _NODES_A_PIECE
        else:
            visit(s, c)
            i -= 1
    return learned


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


def solve(s: ptr32, c: ptr32) -> int:
    """Do one piece of the algebra that follows a traversal; return 1 if a bias was learned."""
    k = s[_PROGRESS]
    s[_PROGRESS] = k + 1
    if c[_MOTION_DOCUMENT]:
        return solve_document(s, c, k)
    if s[_PASS] & 1 == 0:
        find_up(s)
        if s[_PASS] == 0:
            carry(s, c, s[_ACCEPTED])
        next_pass(s, c)
    elif k == 0:
        open_rows(s, c)
    elif k <= _ROW_PIECES * _ROWS_A_WINDOW:
        learn_row(s, c, (k - 1) // _ROW_PIECES, (k - 1) % _ROW_PIECES)
    else:
        return conclude(s, c, k - 1 - _ROW_PIECES * _ROWS_A_WINDOW)
    return 0


def next_pass(s: ptr32, c: ptr32):
    """Integrate the window once more."""
    s[_PASS] += 1
    begin_traversal(s, c)


def open_rows(s: ptr32, c: ptr32):
    """Refuse the window or prepare for its rows: a short one knows nothing of those before."""
    if s[_LENGTH] < c[_LONGEST]:
        s[_MOTION_REASON] = _GROWING
        know_nothing(s, c)
        stray(s, c)
    elif refused(s, c) == 0:
        stray(s, c)


def learn_row(s: ptr32, c: ptr32, r: int, k: int):
    """Do piece k of what row r teaches."""
    if k == 0:
        innovate(s, c, r)
    elif k < 7:
        look(s, r, 2 * k - 2)
        look(s, r, 2 * k - 1)
    elif k == 7:
        weigh(s, r)
        if s[_LENGTH] == c[_LONGEST]:
            follow_noise(s, r)
        for i in range(3):
            learn_slope(s, i)
    elif k == 8:
        move(s)
    else:
        narrow(s, k - 9)
        narrow(s, 20 - k)


def conclude(s: ptr32, c: ptr32, k: int) -> int:
    """Do piece k of what follows the rows; return 1 if a bias was learned."""
    if k == 0:
        know_prior(s)
    if k & 3:
        sweep(s, (k & 3) - 1)
        return 0
    if k:
        shrink(s, c)
    if k < _SHRUNK:
        weigh_prior(s, c)
        return 0
    if s[_LENGTH] == c[_LONGEST]:
        s[_JOB] = _IDLE
        publish(s, c)
        remove(s, c)
        return finish(s, c)
    remove(s, c)
    if s[_PASS] < 2 * c[_PASSES] - 1 and settled(s, c) == 0:
        next_pass(s, c)
    else:
        grow(s, c)
    return 0


def remove(s: ptr32, c: ptr32):
    """Remove the bias at _SLOPE from now on; what it was wrong by takes its place."""
    for i in range(0, 6, 2):
        subtract(s, _T, _SLOPE + i, _BIAS + i)
        copy(s, _BIAS + i, _SLOPE + i, 2)
        copy(s, _SLOPE + i, _T, 2)
    note_slope(s, c)


def grow(s: ptr32, c: ptr32):
    """Take a window of twice the length next, unless this one taught nothing."""
    s[_JOB] = _IDLE
    if refused(s, c) == 0:
        s[_MOTION_REASON] = _GROWING
        s[_LENGTH] = s[_LENGTH] << 1
        s[_STAGE] += 1
        know_nothing(s, c)


def solve_document(s: ptr32, c: ptr32, k: int) -> int:
    """Do one piece of the document's own form; return 1 if a bias was learned."""
    if k < 3:
        own_slope(s, k)
    elif k == 3:
        remove(s, c)
        if s[_PASS] < c[_PASSES] and settled(s, c) == 0:
            next_pass(s, c)
    else:
        s[_JOB] = _IDLE
        if refused(s, c) == 0:
            copy(s, _SLOPE, _BIAS, 6)
            publish(s, c)
            return finish(s, c)
    return 0


def refused(s: ptr32, c: ptr32) -> int:
    """Return 1 if the window teaches nothing, and note why; else 0."""
    reason = verdict(s, c)
    if reason == _LEARNED:
        s[_MOTION_REASON] = reason
        return 0
    refuse(s, c, reason)
    s[_JOB] = _IDLE
    return 1


def settled(s: ptr32, c: ptr32) -> int:
    """Return 1 if the slope is below its threshold."""
    for i in range(3):
        slope = whole(s, _SLOPE + 2 * i, 0)
        if slope > c[_SETTLED] or slope < -c[_SETTLED]:
            return 0
    return 1
