"""Coefficients that go on learning on the board, off by default: another unit of the same part.

A Kalman filter (R. E. Kalman, 1960) whose state is, for each axis, an offset that walks, a straight
line over temperature, and how far each slot's coefficient is from the model's; the three axes have
one covariance. It is told each still segment's rate less what the model's own effects say, so
neither the turn-on offset nor the line is taken for an effect. No coefficient leaves the model's
own by more than the bound. Numbers are those of real.py; words of `e`: docs/layout.md.
"""

from ..arithmetic.fixed import clipped
from ..arithmetic.real import add, divide, multiply, put, subtract, whole

# layout: names that a board's own compiler reads
const = int
ptr32 = None
# layout: The corrector's state
_WINDOW_N = const(17)
_STILLNESS = const(19)
_SEGMENT_WINDOWS = const(21)
_TEMP = const(22)
_SEGMENT_TOTAL = const(100)
# layout: The corrector's settings
_WINDOW_SHIFT = const(4)
_SEGMENT = const(5)
# layout: The effect model and its running state
_REFINE_ON = const(33)
_BOUND_EIGHTHS = const(34)
_SLOTS = const(119)
_REFINE_WORK = const(589)
_STATES = const(590)
_RATE_Q8 = const(591)
_FIRST_TEMP = const(594)
_SEEN = const(595)
_REFINE_A = const(597)
_REFINE_B = const(599)
_INNOVATION = const(601)
_MISS = const(603)
_REGRESSORS = const(609)
_REFINE_GAIN = const(629)
_THETA = const(649)
_REFINE_P = const(709)
# layout: An effect slot
_SLOT_COEFFICIENT_SHIFT = const(23)
_SLOT_COEFFICIENT = const(24)
_SLOT_OWN = const(30)
_SLOT_INSTANT = const(33)
_SLOT_VALUE = const(39)
_SLOT_WORDS = const(40)
# layout: What of the sample itself a slot follows
_OF_RATE = const(1)
# layout: end
_REFINE_ROW = const(20)
_WARM_UP = const(64)
_MOST_RATE = const(0x1FFFFF)
# exponents of 2: variance of a segment's mean and of the offset's walk a segment, LSB^2
_NOISE_EXPONENT = const(-2)
_WALK_EXPONENT = const(-10)


def mean_q8(total: int, n: int) -> int:
    """Return total / n in Q8, for 0 < n < 2^20, within 2^21."""
    sign = 1 if total >= 0 else -1
    size = sign * total
    if size // n > 8191:
        return sign * _MOST_RATE
    return sign * (((size // n) << 8) + ((size % n) << 8) // n)


def observe(s: ptr32, e: ptr32, n: int):
    """Take a still segment of n samples whose totals, less the effects, stand in s."""
    # Nothing happens where refinement is off or the segment before is still at work in `refine`.
    if e[_REFINE_ON] == 0 or e[_REFINE_WORK]:
        return
    if e[_SEEN] == 0:
        e[_FIRST_TEMP] = s[_TEMP]
    put(e, _REGRESSORS, 1, 0)
    i = s[_TEMP] - e[_FIRST_TEMP]
    put(e, _REGRESSORS + 2, i, -8)
    for i in range(3):
        e[_RATE_Q8 + i] = mean_q8(s[_SEGMENT_TOTAL + i], n)
    i = 2
    while i < e[_STATES]:
        a = _SLOTS + (i - 2) * _SLOT_WORDS
        put(e, _REGRESSORS + 2 * i, e[a + _SLOT_VALUE], -24)
        if e[a + _SLOT_INSTANT] == _OF_RATE:
            put(e, _REGRESSORS + 2 * i, 0, 0)
        i += 1
    e[_REFINE_WORK] = 1


def attend(s: ptr32, c: ptr32, e: ptr32):
    """After a good frame: take the still segment that it has completed, or go on with the last."""
    if s[_WINDOW_N] == 0 and s[_STILLNESS] == 1 and s[_SEGMENT_WINDOWS] == 0:
        observe(s, e, c[_SEGMENT] << c[_WINDOW_SHIFT])
    elif e[_REFINE_WORK]:
        refine(e)


def product(e: ptr32, to: int, a: int, b: int):
    """Store at `to` the scalar product of the states at a and b."""
    put(e, to, 0, 0)
    i = 0
    while i < 2 * e[_STATES]:
        multiply(e, _REFINE_A, a + i, b + i)
        add(e, to, to, _REFINE_A)
        i += 2


def miss(e: ptr32, axis: int):
    """Note by how much the axis' rate, with the learned effects, misses what the filter says."""
    i = _THETA + axis * _REFINE_ROW
    product(e, _REFINE_B, i, _REGRESSORS)
    put(e, _REFINE_A, e[_RATE_Q8 + axis], -8)
    i = _MISS + 2 * axis
    subtract(e, i, _REFINE_A, _REFINE_B)
    restore(e, axis, i)


def put_learned(e: ptr32, a: int, axis: int):
    """Store at _REFINE_A how far the slot's coefficient is from the model's own, in LSB."""
    m = e[a + _SLOT_COEFFICIENT + axis]
    m -= e[a + _SLOT_OWN + axis]
    exponent = 10 - e[a + _SLOT_COEFFICIENT_SHIFT]
    put(e, _REFINE_A, m, exponent)


def restore(e: ptr32, axis: int, to: int):
    """Add at `to` what the learned part of the axis' coefficients has taken from the rate."""
    a = _SLOTS
    i = _REGRESSORS + 4
    while i < _REGRESSORS + 2 * e[_STATES]:
        put_learned(e, a, axis)
        multiply(e, _REFINE_A, _REFINE_A, i)
        add(e, to, to, _REFINE_A)
        a += _SLOT_WORDS
        i += 2


def update_state(e: ptr32, i: int):
    """Let state i of each axis, and its row of the covariance, learn from the misses."""
    divide(e, _REFINE_B, _REFINE_GAIN + 2 * i, _INNOVATION)
    axis = 0
    while axis < 3:
        multiply(e, _REFINE_A, _REFINE_B, _MISS + 2 * axis)
        at = _THETA + axis * _REFINE_ROW + 2 * i
        add(e, at, at, _REFINE_A)
        axis += 1
    at = _REFINE_P + i * _REFINE_ROW
    i = 0  # eleven words: i is from here on the column of the covariance
    while i < e[_STATES]:
        multiply(e, _REFINE_A, _REFINE_B, _REFINE_GAIN + 2 * i)
        put(e, _REFINE_A, -e[_REFINE_A], e[_REFINE_A + 1])
        add(e, at, at, _REFINE_A)
        at += 2
        i += 1


def bound(e: ptr32, a: int) -> int:
    """Return how far a coefficient of the slot may go: a share of the model's largest."""
    most = 0
    for i in range(3):
        m = e[a + _SLOT_OWN + i]
        if m < 0:
            m = -m
        if m > most:
            most = m
    return (most >> 3) * e[_BOUND_EIGHTHS]


def move(e: ptr32, a: int, state: int):
    """Set the slot's coefficients to the model's own plus what was learned, within the bound."""
    most = bound(e, a)
    # eleven words: state is from here on the word of what was learned; a goes on with it
    state = _THETA + 2 * state
    shift = e[a + _SLOT_COEFFICIENT_SHIFT] - 10
    i = 3
    while i > 0:
        d = whole(e, state, shift)
        e[a + _SLOT_COEFFICIENT] = e[a + _SLOT_OWN] + clipped(d, most)
        a += 1
        state += _REFINE_ROW
        i -= 1


def refine(e: ptr32):
    """Do the next piece of learning from the latest segment; nothing when all is done."""
    n = e[_STATES]
    i = e[_REFINE_WORK] - 1
    if i < 0:
        return
    e[_REFINE_WORK] += 1
    if i < n:
        if i == 0:
            put(e, _REFINE_A, 1, _WALK_EXPONENT)
            add(e, _REFINE_P, _REFINE_P, _REFINE_A)
        product(e, _REFINE_GAIN + 2 * i, _REFINE_P + i * _REFINE_ROW, _REGRESSORS)
    elif i == n:
        product(e, _INNOVATION, _REFINE_GAIN, _REGRESSORS)
        put(e, _REFINE_A, 1, _NOISE_EXPONENT)
        add(e, _INNOVATION, _INNOVATION, _REFINE_A)
    elif i < n + 4:
        miss(e, i - n - 1)
    elif i < 2 * n + 4:
        update_state(e, i - n - 4)
    else:
        i = 2
        while i < n and e[_SEEN] >= _WARM_UP:
            move(e, _SLOTS + (i - 2) * _SLOT_WORDS, i)
            i += 1
        e[_REFINE_WORK] = 0
        if e[_SEEN] < 0xFFFF:
            e[_SEEN] += 1


def renew(e: ptr32):
    """Begin a power-on: the offset is as unknown as at first, all else is kept."""
    e[_REFINE_WORK] = 0
    e[_SEEN] = 0
    i = 0
    while i < e[_STATES]:
        put(e, _REFINE_P + 2 * i, 0, 0)
        put(e, _REFINE_P + i * _REFINE_ROW, 0, 0)
        i += 1
    put(e, _REFINE_P, 1, 24)
    for i in range(3):
        put(e, _THETA + i * _REFINE_ROW, 0, 0)


def doubt(e: ptr32, a: int, p: int):
    """Store at p the variance of the slot's coefficients: the bound is one sigma."""
    m = bound(e, a)
    exponent = 10 - e[a + _SLOT_COEFFICIENT_SHIFT]
    put(e, _REFINE_A, m, exponent)
    multiply(e, p, _REFINE_A, _REFINE_A)


def begin(e: ptr32, slots: int):
    """Know nothing yet of any unit: each coefficient is the model's, give or take the bound."""
    e[_STATES] = slots + 2
    for i in range(30):
        put(e, _THETA + 2 * i, 0, 0)
    for i in range(100):
        put(e, _REFINE_P + 2 * i, 0, 0)
    put(e, _REFINE_P + _REFINE_ROW + 2, 1, 6)
    for i in range(slots):
        doubt(e, _SLOTS + i * _SLOT_WORDS, _REFINE_P + (i + 2) * (_REFINE_ROW + 2))
    renew(e)
