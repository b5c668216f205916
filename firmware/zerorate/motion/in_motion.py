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

from ..arithmetic.real import copy, subtract, whole
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
from .thermal import carry, follow_temperature, learn_slope
from .tilt_frame import find_up
from .traversal import begin_traversal, visit

# layout: names that a board's own compiler reads
const = int
ptr32 = None
# layout: The state of the source in motion
_LENGTH = const(11)
_STAGE = const(12)
_JOB = const(13)
_PASS = const(14)
_PROGRESS = const(15)
_MOTION_REASON = const(17)
_ACCEPTED = const(70)
_BIAS = const(404)
_SLOPE = const(410)
_T = const(416)
_LATE_US = const(442)
# layout: The settings of the source in motion
_VISITS = const(5)
_MOTION_GAP_US = const(6)
_PASSES = const(9)
_LONGEST = const(16)
_MOTION_DOCUMENT = const(20)
_SETTLED = const(22)
# layout: What the source in motion is doing
_IDLE = const(0)
_SOLVE = const(2)
# layout: What a window in motion taught
_GROWING = const(1)
_LEARNED = const(2)
_MOTION_GAP = const(7)
# layout: end
_SLOWEST_US = const(100000)  # of a chip that is read more often than it measures
_NODES_A_PIECE = const(4)  # of algebra, by what they cost
_ROWS_A_WINDOW = const(6)
_ROW_PIECES = const(21)
_SHRUNK = const(24)  # six rounds: where one sigma is a fifth of the bias, less stop halfway


def update(s: ptr32, c: ptr32, x: ptr32, dt_us: int) -> int:
    """Take the raw frame `x`, dt_us after the one before; return 1 where a bias was learned."""
    late_us = s[_LATE_US]
    s[_LATE_US] = 0
    if dt_us <= 0 or dt_us > c[_MOTION_GAP_US] or late_us > _SLOWEST_US:
        restart(s)
        s[_JOB] = _IDLE
        s[_MOTION_REASON] = _MOTION_GAP
        return 0
    if gather(s, c, x, dt_us + late_us):
        follow_temperature(s, x[3])
        close(s, c)
    if s[_JOB] == _IDLE:
        if start_window(s, c):
            begin_traversal(s, c)
        return 0
    # frames that were passed over have their share of the work
    return work(s, c, c[_VISITS] + (c[_VISITS] * late_us // dt_us if late_us else 0))


def work(s: ptr32, c: ptr32, nodes: int) -> int:
    """Do the next nodes of a traversal, or pieces of algebra; return 1 as `update`."""
    # At a low rate one piece a sample would take until new nodes overwrite what is yet to be read.
    learned = 0
    i = nodes
    while i > 0 and s[_JOB] != _IDLE:
        if s[_JOB] == _SOLVE:
            learned = solve(s, c)
            i -= _NODES_A_PIECE
        else:
            visit(s, c)
            i -= 1
    return learned


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
    elif k < 10:
        look(s, r, k - 1)
        look(s, r, k + 8)
    elif k == 10:
        weigh(s, r)
        if s[_LENGTH] == c[_LONGEST]:
            follow_noise(s, r)
        for i in range(3):
            learn_slope(s, i)
    elif k == 11:
        move(s)
    else:
        narrow(s, k - 12)
        narrow(s, 29 - k)


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
