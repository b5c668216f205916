"""Whether a window in motion may teach a bias, and what is kept of it.

Refused: a window that hardly moves (the still source's), one that turned faster than the nodes
hold, one whose mean force is not 1 g along one direction (the integration lost its way), and one
that contradicts what is known: a turn that stays turned. Contradiction that lasts is believed.
"""

from ..arithmetic.fixed import clipped
from ..arithmetic.real import add, copy, divide, multiply, put, subtract, whole
from .least_squares import covariance, less, place
from .posterior import follow_turn
from .regression import mean
from .thermal import forget_slopes, learn_slope, variance_at

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
_TAPER_SUM = const(18)
_START = const(29)
_UP = const(63)
_FAST = const(64)
_TRAFFIC = const(65)
_TILTED = const(66)
_ACCEPTED = const(68)
_REFUSED = const(69)
_AGAINST = const(70)
_MOTION_QUALITY_Q8 = const(74)
_NOTED_SLOPES_Q8 = const(77)
_KNOWN_P = const(149)
_PRIOR_MEAN = const(173)
_BIAS = const(179)
_SLOPE = const(185)
_HELD_NOISE = const(191)
_T = const(203)
_T1 = const(205)
_CENTRE = const(214)
_NOISE_ENERGY = const(223)
_MISFIT_Q16 = const(241)
_VERTICAL = const(242)
_TURN_SUM = const(245)
# layout: The settings of the source in motion
_LEAST_TRAFFIC = const(7)
_NODES = const(8)
_LSB_A_UNIT = const(10)
_START_VARIANCE = const(14)
_LONGEST = const(16)
_SHORTEST_STAGE = const(17)
_LEAST_UP = const(18)
_PATIENCE = const(19)
_MOTION_DOCUMENT = const(20)
_LEAST_TILT = const(31)
# layout: What a window in motion taught
_GROWING = const(1)
_LEARNED = const(2)
_HARDLY_MOVES = const(3)
_TURNED = const(4)
_TOO_FAST = const(5)
_LOST = const(6)
# layout: end
_SETTLED_AFTER = const(3)
_AS_EXPECTED_Q16 = const(0x4000)


def clear(s: ptr32, c: ptr32):
    """Know nothing: no bias, the widest covariance, the shortest window."""
    for i in range(3):
        put(s, _BIAS + 2 * i, 0, 0)
        s[_MOTION_QUALITY_Q8 + i] = 0x1FFFFFFF
    forget_slopes(s, c)
    s[_MISFIT_Q16] = _AS_EXPECTED_Q16
    s[_ACCEPTED] = 0
    s[_AGAINST] = 0
    s[_STAGE] = c[_SHORTEST_STAGE] + 3 * c[_MOTION_DOCUMENT]
    s[_LENGTH] = 1 << s[_STAGE]


def know_nothing(s: ptr32, c: ptr32, tilt: int, heading: int):
    """Set the prior to the widest one about no bias, and the noise energies, Q24 rad^2."""
    for i in range(6):
        put(s, _KNOWN_P + 2 * i, 0, 0)
    put(s, _KNOWN_P, c[_START_VARIANCE], c[_START_VARIANCE + 1])
    copy(s, _KNOWN_P + 6, _KNOWN_P, 2)
    copy(s, _KNOWN_P + 10, _KNOWN_P, 2)
    for i in range(3):
        put(s, _PRIOR_MEAN + 2 * i, 0, 0)
        put(s, _HELD_NOISE + 2 * i, heading if i == 2 else tilt, 0)


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
    if n < c[_LONGEST]:
        know_nothing(s, c, 6711, 41943)
    elif s[_ACCEPTED] == 0:
        know_nothing(s, c, 167772, 1509949)
    else:
        copy(s, _PRIOR_MEAN, _BIAS, 6)
    for n in range(9):
        s[_CENTRE + n] = 0
    for n in range(4):
        s[_START + n] = 0 if n else 0x4000
    for n in range(3):
        s[_VERTICAL + n] = 0
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
    if (s[_UP] << 8) // (s[_TAPER_SUM] >> 2) < c[_LEAST_UP]:
        return _LOST
    if s[_ACCEPTED] >= _SETTLED_AFTER and (contradicts(s) or louder(s)):
        return _TURNED
    return _LEARNED


def net(s: ptr32) -> int:
    """Return the sum of the half turns that did not come back, as _TRAFFIC."""
    total = 0
    for i in range(3):
        turn = mean(s, s[_TURN_SUM + i])
        total += turn if turn > 0 else 0 - turn
    return total << s[_STAGE]


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


def louder(s: ptr32) -> int:
    """Return 1 if the tilt's noise energy is over 512 times what was held, else 0."""
    # A bias that jumped leaves this: what is known holds the slope back, and what that leaves is
    # taken for noise. A turn of heading does too, and so is not looked at.
    put(s, _T, s[_HELD_NOISE], s[_HELD_NOISE + 1] + 9)
    return less(s, _T, _NOISE_ENERGY)


def contradicts(s: ptr32) -> int:
    """Return 1 if an axis moved by more than four sigma of what was known, else 0."""
    d = _KNOWN_P
    for i in range(3):
        put(s, _T, s[d], s[d + 1] + 4)
        subtract(s, _T1, _BIAS + 2 * i, _PRIOR_MEAN + 2 * i)
        multiply(s, _T1, _T1, _T1)
        if less(s, _T, _T1):
            return 1
        d += 6 - 2 * i
    return 0


def finish(s: ptr32, c: ptr32) -> int:
    """Keep or refuse the window's bias; return 1 if it was learned."""
    reason = verdict(s, c)
    s[_MOTION_REASON] = reason
    if reason != _LEARNED:
        refuse(s, c, reason)
        return 0
    if s[_LENGTH] < c[_LONGEST]:
        s[_LENGTH] = s[_LENGTH] << 1
        s[_STAGE] += 1
        s[_MOTION_REASON] = _GROWING
        return 0
    if s[_ACCEPTED] and c[_MOTION_DOCUMENT] == 0:
        for i in range(3):
            follow_misfit(s, i)
    for i in range(3):
        follow_turn(s, i)
        learn_slope(s, i)
    covariance(s, _KNOWN_P)
    keep_noise(s)
    s[_ACCEPTED] += 1
    s[_AGAINST] = 0
    return 1


def refuse(s: ptr32, c: ptr32, reason: int):
    """Take back the window's bias; widen or forget what is known if this goes on for long."""
    copy(s, _BIAS, _PRIOR_MEAN, 6)
    s[_REFUSED] += 1
    if reason != _TURNED and reason != _LOST:
        return
    s[_AGAINST] += 1
    if s[_AGAINST] < c[_PATIENCE]:
        return
    s[_AGAINST] = 0
    if reason == _LOST:
        clear(s, c)
        return
    copy(s, _HELD_NOISE, _NOISE_ENERGY, 6)
    i = 0
    while i < 12:
        put(s, _KNOWN_P + i, s[_KNOWN_P + i], s[_KNOWN_P + i + 1] + 8)
        i += 2


def follow_misfit(s: ptr32, i: int):
    """Follow how far windows move the bias of axis i beside how far they are expected to."""
    # A quarter is as it should be: half a window was seen before, and one bout lasts over several.
    a = variance_at(i)
    add(s, _T, a, place(i, i))  # less the variance that the window leaves
    subtract(s, _T1, _BIAS + 2 * i, _PRIOR_MEAN + 2 * i)
    multiply(s, _T1, _T1, _T1)
    divide(s, _T1, _T1, _T)
    a = clipped(whole(s, _T1, 16), 0x40000)
    s[_MISFIT_Q16] += (a - s[_MISFIT_Q16]) >> 5
    if s[_MISFIT_Q16] < 0x100:
        s[_MISFIT_Q16] = 0x100


def keep_noise(s: ptr32):
    """Hold this window's noise energies for the next: .8 of the heading's, .25 of the tilts'."""
    # Gravity shows a tilt's noise in every window anew. A turn as steady as a bias, which a stride
    # makes, is in no shape: how far a heading strays is seen before or after it.
    for i in range(0, 6, 2):
        put(s, _T, 13107 if i == 4 else 4096, -14)
        multiply(s, _HELD_NOISE + i, _NOISE_ENERGY + i, _T)
