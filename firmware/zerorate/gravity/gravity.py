"""The bias against gravity: counters of signs, stepped by a fixed value.

US 2015/0033821: a time interval of sub-units; in each, the angular rate that a pair of
accelerometer axes implies, its deviation from the gyroscope's, a counter; at the end of the
interval the offset moves by a first value if the counter says so. The axis x has the pair (y, z),
and so round.

With gravity g and rate w in the body frame g' = -w x g, so the pair's angle turns by
    atan2(gy, gz)' = wx - gx (wy gy + wz gz) / (gy^2 + gz^2):
the last term couples the other axes in. It is subtracted less its mean over 16 s, which is bias;
where gravity lies within 45 deg of the axis the sub-unit is not counted for it. Both sides are
means over the sub-unit of an angle, the gyroscope's being its running integral, so both see the
same motion in the same way.

The document's own form has one step, counts every sign and ends an interval after so many
sub-units; the default has a dead band, ends it after so many counted ones, doubles the step while
all signs agree and halves it when the counter turns.
"""

from ..arithmetic.atan2 import atan2_q13
from ..arithmetic.fixed import clipped, scaled

# layout: names that a board's own compiler reads
const = int
ptr32 = None
# layout: The state of the source against gravity
_UNIT_ELAPSED_US = const(0)
_UNIT_N = const(1)
_ANGLE_Q22 = const(2)
_ANGLE_SUM_Q13 = const(5)
_FORCE_SUM = const(8)
_LAST_ANGLE_Q13 = const(11)
_LAST_PAIR_Q13 = const(14)
_LAST_COUPLED_Q13 = const(17)
_LAST_GOOD = const(20)
_UNIT_COUNT = const(21)
_COUNTER = const(22)
_COUNTED = const(25)
_GRAVITY_BIAS_Q8 = const(28)
_GRAVITY_QUALITY_Q8 = const(31)
_STEP_Q8 = const(34)
_OBSERVED = const(37)
_SIGN = const(40)
_SIGN_TURNS = const(43)
_RIPPLE_Q8 = const(46)
_GRAVITY_REASON = const(49)
_SKIPPED = const(50)
_MEAN_ALONG_Q20 = const(51)
_SPREAD_Q21 = const(54)
_LEFT_OUT_Q20 = const(55)
_GRAVITY_LATE_US = const(58)
# layout: The settings of the source against gravity
_SUB_UNIT_US = const(0)
_GRAVITY_GAIN = const(1)
_GRAVITY_GAIN_SHIFT = const(2)
_GRAVITY_SHIFT = const(3)
_UNITS = const(4)
_THRESHOLD = const(5)
_DEAD_Q13 = const(6)
_COARSE_Q8 = const(7)
_FINE_Q8 = const(8)
_ONE_G_LSB = const(9)
_GRAVITY_GAP_US = const(10)
_PUSH_Q2 = const(11)
_TURN_Q12 = const(12)
# layout: What a sub-unit against gravity was
_COUNTING = const(1)
_NOT_ONE_G = const(2)
_GRAVITY_GAP = const(3)
# layout: Values that stand for none
_UNKNOWN_Q8 = const(0x1FFFFFFF)
# layout: end
_PI_Q13 = const(25736)
_SLOWEST_US = const(100000)  # of a chip that is read more often than it measures
_ONE_G_Q24 = const(0x1000000)
_BAND_Q24 = const(0x300000)
_HALF_Q24 = const(0x800000)
_MOST_Q13 = const(0x7FFF)
_FOUR_RAD_Q22 = const(0xFFFFFF)
_MOST_Q22 = const(0x3FFFFFF)  # four times as far, in a sub-unit
_RADIAN_Q13 = const(8192)
_MINUTE = const(128)  # sub-units


def clear(s: ptr32, c: ptr32):
    """Forget the offsets and everything counted."""
    for i in range(_GRAVITY_LATE_US + 1):
        s[i] = 0
    for i in range(3):
        s[_STEP_Q8 + i] = c[_COARSE_Q8]
        s[_GRAVITY_QUALITY_Q8 + i] = _UNKNOWN_Q8


def update(s: ptr32, c: ptr32, x: ptr32, dt_us: int) -> int:
    """Take the raw frame `x`, dt_us after the one before; return 1 where an interval ended."""
    since_us = s[_GRAVITY_LATE_US]
    s[_GRAVITY_LATE_US] = 0
    if dt_us <= 0 or dt_us > c[_GRAVITY_GAP_US] or since_us > _SLOWEST_US:
        s[_UNIT_ELAPSED_US] = 0
        s[_LAST_GOOD] = 0
        s[_GRAVITY_REASON] = _GRAVITY_GAP
        begin_unit(s)
        return 0
    since_us += dt_us
    gather(s, x, (since_us * c[_GRAVITY_GAIN]) >> c[_GRAVITY_GAIN_SHIFT], c[_GRAVITY_SHIFT])
    s[_UNIT_ELAPSED_US] += since_us
    s[_UNIT_N] += 1
    if s[_UNIT_ELAPSED_US] < c[_SUB_UNIT_US]:
        return 0
    s[_UNIT_ELAPSED_US] -= c[_SUB_UNIT_US]
    end_unit(s, c)
    s[_UNIT_COUNT] += 1
    return end_interval(s, c)


def gather(s: ptr32, x: ptr32, factor: int, shift: int):
    """Add the frame to the sub-unit: the running angle, Q22 rad, its sum, Q13, and the forces."""
    i = 0
    while i < 3:
        turned = (x[4 + i] << 8) - s[_GRAVITY_BIAS_Q8 + i]
        turned = scaled(turned, factor, shift) + s[_ANGLE_Q22 + i]
        turned = clipped(turned, _MOST_Q22)
        s[_ANGLE_Q22 + i] = turned
        s[_ANGLE_SUM_Q13 + i] += turned >> 9
        s[_FORCE_SUM + i] += x[i]
        i += 1


def begin_unit(s: ptr32):
    """Begin the sums of a sub-unit."""
    s[_UNIT_N] = 0
    for i in range(3):
        s[_ANGLE_Q22 + i] = 0
        s[_ANGLE_SUM_Q13 + i] = 0
        s[_FORCE_SUM + i] = 0


def end_unit(s: ptr32, c: ptr32):
    """Count the sub-unit's deviations, where the force is near 1 g."""
    square = 0
    for i in range(3):
        # a mean rate of 8 g cannot be gravity, and would not fit
        force = ((s[_FORCE_SUM + i] // s[_UNIT_N]) << 12) // c[_ONE_G_LSB]
        if force > 8191 or force < -8191:
            force = 8191
        s[_FORCE_SUM + i] = force
        square += force * force
    i = _ONE_G_Q24 - square
    if i > _BAND_Q24 or i < -_BAND_Q24:
        s[_LAST_GOOD] = 0
        s[_SKIPPED] += 1
        s[_GRAVITY_REASON] = _NOT_ONE_G
    else:
        s[_GRAVITY_REASON] = _COUNTING
        for i in range(3):
            compare(s, c, i, square)
    begin_unit(s)


def compare(s: ptr32, c: ptr32, i: int, square: int):
    """Compare the axis' angle with its pair's since the sub-unit before, and count."""
    across = square - s[_FORCE_SUM + i] * s[_FORCE_SUM + i]
    # of 4 rad or more in a sub-unit the angles may wrap
    if across < _HALF_Q24 or clipped(s[_ANGLE_Q22 + i], _FOUR_RAD_Q22) != s[_ANGLE_Q22 + i]:
        s[_LAST_GOOD] = s[_LAST_GOOD] & (7 - (1 << i))
        return
    deviation = since_last(s, i, across >> 12)
    if s[_LAST_GOOD] & (1 << i):
        count(s, c, i, deviation)
    s[_LAST_GOOD] = s[_LAST_GOOD] | (1 << i)


def since_last(s: ptr32, i: int, square: int) -> int:
    """Return the gyroscope's mean turn since the last sub-unit less the pair's, Q13 rad."""
    mean = s[_ANGLE_SUM_Q13 + i] // s[_UNIT_N]
    deviation = mean - s[_LAST_ANGLE_Q13 + i] + s[_LAST_PAIR_Q13 + i]
    s[_LAST_ANGLE_Q13 + i] = mean - (s[_ANGLE_Q22 + i] >> 9)
    mean = pair_angle_q13(s, i)
    s[_LAST_PAIR_Q13 + i] = mean
    deviation -= mean
    mean = coupled_q13(s, i, square >> 2)
    deviation -= (mean + s[_LAST_COUPLED_Q13 + i]) >> 1
    s[_LAST_COUPLED_Q13 + i] = mean
    while deviation > _PI_Q13:
        deviation -= 2 * _PI_Q13
    while deviation < -_PI_Q13:
        deviation += 2 * _PI_Q13
    return deviation


def pair_angle_q13(s: ptr32, i: int) -> int:
    """Return the angle of the mean force in the plane of the axis' pair."""
    j = i + 1 if i < 2 else 0
    k = i - 1 if i > 0 else 2
    return atan2_q13(s[_FORCE_SUM + j], s[_FORCE_SUM + k])


def along_q12(s: ptr32, i: int) -> int:
    """Return how far the two axes beside i turned about gravity in the sub-unit, Q12 rad."""
    j = i + 1 if i < 2 else 0
    k = i - 1 if i > 0 else 2
    first = clipped(s[_ANGLE_Q22 + j] >> 9, _MOST_Q13) * s[_FORCE_SUM + j]
    return (first + clipped(s[_ANGLE_Q22 + k] >> 9, _MOST_Q13) * s[_FORCE_SUM + k]) >> 13


def coupled_q13(s: ptr32, i: int, square: int) -> int:
    """Return what the other axes turn the pair's angle by in a sub-unit; square: Q10."""
    # Their mean over the last 16 s or so is left out: it is their bias, not a turn.
    along = along_q12(s, i)
    mean = s[_MEAN_ALONG_Q20 + i]
    mean += ((along << 8) - mean) >> 5
    s[_MEAN_ALONG_Q20 + i] = mean
    along -= mean >> 8
    return (along * (s[_FORCE_SUM + i] >> 1)) // square


def beside_q13(s: ptr32, c: ptr32, i: int) -> int:
    """Return what the pair turns by in a sub-unit where the other axes are off, or turn for longer
    than their mean is taken over: in proportion to gravity along the axis."""
    turn = s[_MEAN_ALONG_Q20 + i] >> 8
    turn = (turn if turn > 0 else 0 - turn) + c[_TURN_Q12]
    lean = s[_FORCE_SUM + i]
    turn = turn * ((lean if lean > 0 else 0 - lean) >> 1)
    return turn // (1024 - (lean * lean >> 14))


def leave_out(s: ptr32, i: int, now: int):
    """Follow what `beside_q13` returned, which is in the offset: a mean over a minute."""
    n = s[_OBSERVED + i]
    n = n if n < _MINUTE else _MINUTE
    s[_LEFT_OUT_Q20 + i] += ((now << 7) - s[_LEFT_OUT_Q20 + i]) // n


def count(s: ptr32, c: ptr32, i: int, deviation: int):
    """Move the axis' counter by the deviation's sign."""
    s[_COUNTED + i] += 1
    s[_OBSERVED + i] += 1
    spread(s, deviation)
    beside = beside_q13(s, c, i)
    leave_out(s, i, beside)
    if deviation > c[_DEAD_Q13]:
        s[_COUNTER + i] += 1
    elif deviation < -c[_DEAD_Q13]:
        s[_COUNTER + i] -= 1


def spread(s: ptr32, deviation: int):
    """Follow how far the deviations go, over all axes, for half a minute or so."""
    far = clipped(deviation if deviation >= 0 else -deviation, _RADIAN_Q13)
    s[_SPREAD_Q21] += ((far << 8) - s[_SPREAD_Q21]) >> 6


def end_interval(s: ptr32, c: ptr32) -> int:
    """Step the offsets whose interval is over; return 1 if there was one."""
    # The document's interval is so many sub-units; by default so many that were counted.
    ended = 0
    for i in range(3):
        if s[_COUNTED + i] >= c[_UNITS] or (c[_PUSH_Q2] == 0 and s[_UNIT_COUNT] >= c[_UNITS]):
            end_axis(s, c, i)
            ended = 1
    if s[_UNIT_COUNT] >= c[_UNITS]:
        s[_UNIT_COUNT] = 0
    return ended


def end_axis(s: ptr32, c: ptr32, i: int):
    """Step the axis' offset if its counter passed the threshold; begin its next interval."""
    if c[_PUSH_Q2]:
        size_step(s, c, i)
    step(s, c, i)
    judge(s, c, i)
    s[_COUNTER + i] = 0
    s[_COUNTED + i] = 0


def size_step(s: ptr32, c: ptr32, i: int):
    """Double the step while all signs agree; halve it when the counter turns."""
    sign = 1 if s[_COUNTER + i] >= 0 else -1
    most = sign * s[_COUNTER + i]
    if most <= c[_THRESHOLD]:
        return
    if s[_SIGN + i] + sign == 0:
        s[_SIGN_TURNS + i] += 1
        if s[_STEP_Q8 + i] > c[_FINE_Q8]:
            s[_STEP_Q8 + i] = s[_STEP_Q8 + i] >> 1
    elif most >= s[_COUNTED + i] and s[_STEP_Q8 + i] < c[_COARSE_Q8] * 8:
        s[_STEP_Q8 + i] = s[_STEP_Q8 + i] << 1
    s[_SIGN + i] = sign


def step(s: ptr32, c: ptr32, i: int):
    """Move the offset by its step if the counter passed the threshold."""
    moved = 0
    if s[_COUNTER + i] > c[_THRESHOLD]:
        moved = s[_STEP_Q8 + i]
        s[_GRAVITY_BIAS_Q8 + i] += moved
    elif s[_COUNTER + i] < -c[_THRESHOLD]:
        moved = s[_STEP_Q8 + i]
        s[_GRAVITY_BIAS_Q8 + i] -= moved
    # ripple: the mean step of the latest eight intervals or so
    s[_RIPPLE_Q8 + i] += (moved - s[_RIPPLE_Q8 + i]) >> 3


def judge(s: ptr32, c: ptr32, i: int):
    """Write one sigma: known once the signs have turned twice, by the ripple's size then, and by
    how far the deviations go, for a motion may push always the same way."""
    if s[_SIGN_TURNS + i] < 3 and c[_PUSH_Q2] or s[_OBSERVED + i] == 0:
        return
    pushed = (s[_SPREAD_Q21] * c[_PUSH_Q2]) >> 10
    turned = clipped(s[_LEFT_OUT_Q20 + i] >> 7, _RADIAN_Q13)
    pushed += turned * c[_PUSH_Q2] << 2
    if c[_PUSH_Q2] == 0:  # the literal rules
        pushed = c[_FINE_Q8] << 2
    s[_GRAVITY_QUALITY_Q8 + i] = (s[_RIPPLE_Q8 + i] << 1) + s[_STEP_Q8 + i] + pushed
