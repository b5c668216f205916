"""The bias from motion that returns: the slope of integrated orientation over a stored window.

US 10,451,438: store the rates, find the stretch that moves, integrate it to orientation, fit a
line, take the slope as bias, remove it, integrate again. Two forms:

- the document's own: each axis' slope of the orientation vector is that axis' bias;
- the default: tilt comes from gravity in the tilt frame, only the heading from the assumption
  that it returns; slopes are mapped to the body by the integrated rotation matrix, tapered, and
  joined with what earlier windows know by weights that the window's own residual sets.

A window grows from 2 s while nothing is known, for a large bias turns a long one too far to be
linear. Work is spread: a few nodes or pieces of algebra a sample. The state is one array('i')
of 258 words and 3 a node; motion_settings.py makes the settings.
"""

from ..arithmetic.fixed import clipped
from ..arithmetic.real import add, copy, whole
from .attitude import normalise, rotation, sines, turn
from .increments import close, gather, restart
from .least_squares import (
    covariance,
    held_weights,
    matrix_element,
    noise,
    own_slope,
    own_variance,
    right_side,
    spread_prior,
    step,
    sweep,
    weights,
)
from .motion_verdict import finish, note_slope, start_window
from .posterior import know_prior, publish, shrink, weigh_prior
from .regression import centre, first_sums, look_past_vertical, regressors, second_sums, taper
from .thermal import carry, follow_temperature
from .tilt_frame import begin_attitude, find_up, find_vertical, observe, turn_centre, turn_start

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
_TAPER_SUM = const(18)
_HALF = const(19)
_Q = const(25)
_R = const(33)
_SUM_R = const(42)
_Y = const(51)
_BIAS_CARRY_Q24 = const(54)
_BIAS_Q24 = const(57)
_TAPER = const(60)
_UP = const(63)
_TRAFFIC = const(65)
_TILTED = const(66)
_ACCEPTED = const(68)
_SUMS = const(86)
_PRIOR = const(161)
_PRIOR_MEAN = const(173)
_BIAS = const(179)
_SLOPE = const(185)
_CENTRE = const(214)
_TURN_SUM = const(245)
_LATE_US = const(257)
_NODES_RING = const(258)
# layout: The sums of one component
_COMPONENT_WORDS = const(21)
# layout: The settings of the source in motion
_VISITS = const(5)
_MOTION_GAP_US = const(6)
_NODES = const(8)
_PASSES = const(9)
_LONGEST = const(16)
_MOTION_DOCUMENT = const(20)
_SETTLED = const(23)
# layout: What the source in motion is doing
_IDLE = const(0)
_TRAVERSE = const(1)
_SOLVE = const(2)
# layout: What a window in motion taught
_MOTION_GAP = const(7)
# layout: end
_MOST_BIAS_Q24 = const(0x7FFFFF)  # half a radian in a node, some 200 deg/s
_MOST_HALF_Q14 = const(0x3FFF)
_NODES_A_PIECE = const(4)  # of algebra, by what they cost
_ROUNDS = const(6)  # where one sigma is a fifth of the bias, less of them stop halfway


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
            begin_traversal(s)
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


def begin_traversal(s: ptr32):
    """Begin at the window's first node with the bias of this pass removed."""
    for i in range(3 * _COMPONENT_WORDS):
        s[_SUMS + i] = 0
    for i in range(3):
        s[_TURN_SUM + i] = 0
        s[_BIAS_Q24 + i] = clipped(whole(s, _BIAS + 2 * i, 0), _MOST_BIAS_Q24)
        s[_BIAS_CARRY_Q24 + i] = 0
    for i in range(9):
        s[_SUM_R + i] = s[_CENTRE + i]
    s[_UP] = 0
    s[_TAPER_SUM] = 0
    s[_TRAFFIC] = 0
    s[_TILTED] = 0
    s[_PROGRESS] = 0
    s[_JOB] = _TRAVERSE
    begin_attitude(s)


def visit(s: ptr32, c: ptr32):
    """Integrate over one node and add it to the sums."""
    a = s[_FIRST_NODE] + s[_PROGRESS]
    if a >= c[_NODES]:
        a -= c[_NODES]
    a = _NODES_RING + 3 * a
    taper(s, s[_PROGRESS], s[_STAGE], c[_MOTION_DOCUMENT])
    rotation(s)
    if c[_MOTION_DOCUMENT]:
        observe_vector(s)
    else:
        observe(s, a)
    sum_up(s)
    remove_bias(s, a)
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
    """Take the rotation vector from the start, Q12 rad, and let each slope be its own axis'."""
    for i in range(9):
        s[_R + i] = 0
    for i in range(3):
        s[_R + 4 * i] = 0x4000
        s[_Y + i] = s[_Q + 1 + i] >> 15
        if s[_Q] < 0:
            s[_Y + i] = -s[_Y + i]


def sum_up(s: ptr32):
    """Add the node to the sums of the three components, M taken at the node's start."""
    for i in range(9):
        s[_SUM_R + i] += s[_R + i] >> 1
    for i in range(3):
        regressors(s, _SUM_R + 3 * i, s[_STAGE])
        if i < 2:
            look_past_vertical(s)
        first_sums(s, _SUMS + _COMPONENT_WORDS * i, s[_Y + i])
        second_sums(s, _SUMS + _COMPONENT_WORDS * i)
    for i in range(9):
        s[_SUM_R + i] += s[_R + i] - (s[_R + i] >> 1)


def remove_bias(s: ptr32, a: int):
    """Take the bias from the node's increment and write its half angles, Q14 rad."""
    # What the bias has below a unit is carried from node to node.
    for i in range(3):
        s[_BIAS_CARRY_Q24 + i] += s[_BIAS_Q24 + i]
        part = (s[_BIAS_CARRY_Q24 + i] + 0x400) >> 11
        s[_BIAS_CARRY_Q24 + i] -= part << 11
        part = clipped((s[a + i] >> 15) - part, _MOST_HALF_Q14)
        s[_HALF + i] = part
        s[_TURN_SUM + i] += (s[_TAPER] * part + 512) >> 10
        s[_TRAFFIC] += part if part > 0 else 0 - part


def tilting(s: ptr32, row: int) -> int:
    """Return how far the node turned about a level axis, half angle, Q14 rad: gravity shows it."""
    at = _R + row
    part = s[at] * s[_HALF] + s[at + 1] * s[_HALF + 1]
    part = (part + s[at + 2] * s[_HALF + 2] + 0x2000) >> 14
    return part if part > 0 else 0 - part


def solve(s: ptr32, c: ptr32) -> int:
    """Do one piece of the algebra that follows a traversal; return 1 if a bias was learned."""
    k = s[_PROGRESS]
    s[_PROGRESS] = k + 1
    if c[_MOTION_DOCUMENT]:
        return solve_document(s, c, k)
    if s[_PASS] == 0:
        level_and_prior(s, c, k)
        return 0
    if k < 3:
        centre(s, _SUMS + _COMPONENT_WORDS * k, 3 * k, s[_STAGE])
    elif k == 3:
        turn_start(s)
    elif k < 16:
        normal_equations(s, k - 4)
    elif k == 16:
        step(s)
    elif k < 20:
        noise(s, k - 17)
    elif k == 20:
        weights(s, c)
        if last_pass(s, c) == 0:
            remove_slope(s, c)
    elif k < 33:
        normal_equations(s, k - 21)
    elif k == 33:
        step(s)
        s[_PASS] = c[_PASSES]
        remove_slope(s, c)
    else:
        return conclude(s, c, k - 34)
    return 0


def conclude(s: ptr32, c: ptr32, k: int) -> int:
    """Judge the window and, if it taught, do piece k of publishing; return 1 after the last."""
    if k == 0:
        know_prior(s)
        if finish(s, c) == 0:
            s[_JOB] = _IDLE
    elif k > 4 * _ROUNDS + 1:
        s[_JOB] = _IDLE
        publish(s, c)
        return 1
    elif k & 3 == 1:
        if k > 1:
            shrink(s, c)
        weigh_prior(s, c)
    else:
        sweep(s, (k & 3) - 2 if k & 3 else 2)
    return 0


def normal_equations(s: ptr32, n: int):
    """Build element n of the normal equations, or sweep them: 6 of the matrix, 3, 3 sweeps."""
    if n < 6:
        matrix_element(s, n)
    elif n < 9:
        right_side(s, n - 6)
    else:
        sweep(s, n - 9)


def solve_document(s: ptr32, c: ptr32, k: int) -> int:
    """Do one piece of the document's own form; return 1 if a bias was learned."""
    if k < 3:
        centre(s, _SUMS + _COMPONENT_WORDS * k, 3 * k, s[_STAGE])
    elif k < 6:
        own_slope(s, k - 3)
    elif k < 9:
        noise(s, k - 6)
    elif k == 9:
        if last_pass(s, c):
            s[_PASS] = c[_PASSES]
        remove_slope(s, c)
    elif k < 13:
        own_variance(s, c, k - 10)
    else:
        s[_JOB] = _IDLE
        if finish(s, c):
            publish(s, c)
            return 1
    return 0


def level_and_prior(s: ptr32, c: ptr32, k: int):
    """After the first traversal: find the tilt frame, then invert the covariance."""
    if k == 0:
        find_up(s)
        turn_centre(s, s[_STAGE])
        find_vertical(s)
    elif k == 1:
        known = 1 if s[_LENGTH] == c[_LONGEST] and s[_ACCEPTED] > 0 else 0
        carry(s, c, known)
        if known:
            copy(s, _BIAS, _PRIOR_MEAN, 6)
    elif k == 2:
        spread_prior(s)
    elif k < 6:
        sweep(s, k - 3)
    else:
        covariance(s, _PRIOR)
        held_weights(s, c)
        s[_PASS] = 1
        begin_traversal(s)


def last_pass(s: ptr32, c: ptr32) -> int:
    """Return 1 if the slope is below its threshold or this was the last pass allowed."""
    if s[_PASS] >= c[_PASSES]:
        return 1
    for i in range(3):
        slope = whole(s, _SLOPE + 2 * i, 0)
        if slope > c[_SETTLED] or slope < -c[_SETTLED]:
            return 0
    return 1


def remove_slope(s: ptr32, c: ptr32):
    """Add this pass' slope to the bias, note it, and integrate again unless it was the last."""
    for i in range(0, 6, 2):
        add(s, _BIAS + i, _BIAS + i, _SLOPE + i)
    note_slope(s, c)
    if s[_PASS] < c[_PASSES]:
        s[_PASS] += 1
        begin_traversal(s)
