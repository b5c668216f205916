"""Still, moving or turning: judged from windows of gyroscope and accelerometer."""

# Nothing here assumes a small bias: only the spread of the rates, their change from window to
# window and the direction of gravity count. A constant turn about the vertical leaves all three
# alone and cannot be told from a bias; a turn about any other axis moves gravity.

from ..arithmetic.fixed import clipped, root

# layout: names that a board's own compiler reads
const = int
ptr32 = None
# layout: The corrector's state
_WINDOW_N = const(17)
_STILLNESS = const(19)
_REST = const(20)
_SEGMENT_WINDOWS = const(21)
_TEMP = const(22)
_DRIFTED_Q4 = const(24)
_ANCHOR_SIZE = const(25)
_WINDOW_SUM = const(38)
_SQUARE_ACCEL = const(45)
_SQUARE_GYRO = const(46)
_SQUARE_STEP = const(47)
_DIRTY = const(48)
_LAST_RATE = const(49)
_EFFECT_SUM_Q8 = const(52)
_REFERENCE = const(55)
_TARGET_Q8 = const(66)
_EFFECT_Q8 = const(75)
_NOISE_Q8 = const(81)
_TEMP_RISE_Q12 = const(82)
_TEMP_WINDOWS = const(83)
_SEGMENT_TEMP = const(84)
_TIP_Q8 = const(85)
_TEMP_LEVEL_Q8 = const(87)
_BANK_Q10 = const(89)
_ANCHOR_Q4 = const(90)
_LEAN_Q4 = const(93)
_TILT_NOISE_Q8 = const(96)
_FIRST_RATE_Q4 = const(97)
_SEGMENT_TOTAL = const(100)
# layout: The corrector's settings
_WINDOW = const(3)
_WINDOW_SHIFT = const(4)
_SEGMENT = const(5)
_STILL_GYRO_Q8 = const(7)
_STILL_ACCEL_Q8 = const(8)
_TIP_LIMIT_Q8 = const(9)
_TILT_LIMIT_Q4 = const(10)
_TILT_NOISE_FACTOR_Q4 = const(11)
_CHANGE_LIMIT_Q8 = const(12)
_TURNING_LSB = const(54)
_TURN_HALVES = const(55)
_TILT_SPEED = const(56)
_ONE_G = const(57)
_QUIETEST_Q8 = const(58)
# layout: What a window was
_STILL = const(1)
_MOVING = const(2)
_TURNING = const(3)
_SHAKEN = const(4)
_SHIFTED = const(5)
_SILENT = const(6)
# layout: end
_FAR_LSB = const(512)  # a reading this many LSB from the window's first one is motion
_MOST_SEGMENTS = const(0x3FFF)
_MOST_G = const(0x7FF)
_MOST_HIDDEN_Q4 = const(0x7FFFF)
_FAR_BITS = const(10)  # log2 of twice FAR_LSB: the sum of a window's squares then fits 31 bits
_BANKED = const(9)  # turn of an aircraft at 60 m/s, banked by 45 degrees, over turning_dps
# a mean's variance: of a window's, three axes added; 18 is a chi squared of 27, 14 is 4.5 sigma
_GRAVITY_NOISE = const(18)  # most squared change of gravity by noise, over a mean's variance
_FAR_Q8 = const(0x7FFFF)  # LSB in 1/256: a temperature farther from its line begins a new line
_SMOOTHED = const(30)  # the temperature is smoothed over at most this many windows
_NOISY_Q8 = const(192)  # LSB^2 in 1/256, three axes: a part this noisy gives no constant window
_RATE_NOISE = const(14)  # most squared change of an axis' rate by noise, over a mean's variance


def gather(s: ptr32, c: ptr32, x: ptr32) -> int:
    """Add the frame `x` to the window; return 1 when the window is full, else 0."""
    i = 0
    if s[_WINDOW_N] == 0:
        while i < 7:
            s[_REFERENCE + i] = x[i]
            i += 1
        for i in range(_WINDOW_SUM, _EFFECT_SUM_Q8 + 3):
            s[i] = 0
    s[_WINDOW_N] += 1
    if s[_DIRTY] == 0:
        i = 0
        while i < 7:
            d = x[i] - s[_REFERENCE + i]
            if (d + _FAR_LSB) >> _FAR_BITS:
                s[_DIRTY] = i + 1
                d = 0
            s[_WINDOW_SUM + i] += d
            if i < 3:
                s[_SQUARE_ACCEL] += d * d
            elif i > 3:
                s[_SQUARE_GYRO] += d * d
                e = d - s[_LAST_RATE - 4 + i]
                s[_SQUARE_STEP] += e * e
                s[_LAST_RATE - 4 + i] = d
                e = s[_EFFECT_Q8 - 4 + i]
                s[_EFFECT_SUM_Q8 - 4 + i] += e
            i += 1
    else:
        # the thermometer is read in motion as well, and one reading of it is noise
        d = x[3] - s[_REFERENCE + 3]
        s[_WINDOW_SUM + 3] += d
    return 1 if s[_WINDOW_N] >= c[_WINDOW] else 0


def spread_q8(s: ptr32, first: int, square: int, shift: int) -> int:
    """Return the variance of 2^shift frames, LSB^2 Q8, summed over three channels from `first`."""
    left = square
    i = first
    while i < first + 3:
        mean_q4 = (s[i] << 4) >> shift
        left -= (mean_q4 * s[i]) >> 4
        i += 1
    if left < 0:
        left = 0
    return left << (8 - shift)


def seems_still(s: ptr32, c: ptr32, shift: int) -> int:
    """Return 1 if the window's frames so far, 2^shift of them, spread as little as at rest."""
    if s[_DIRTY] or spread_q8(s, _WINDOW_SUM + 4, s[_SQUARE_GYRO], shift) > c[_STILL_GYRO_Q8]:
        return 0
    if spread_q8(s, _WINDOW_SUM, s[_SQUARE_ACCEL], shift) > c[_STILL_ACCEL_Q8]:
        return 0
    return 1


def gravity_moved_q8(s: ptr32, c: ptr32) -> int:
    """Return how far gravity has moved since the rest began, LSB^2 Q8; sum up how it tilts."""
    # Weighted -7, -5 .. 7 the means of eight windows give the slope of a line through them.
    i = 0
    square = 0
    weight = 2 * s[_SEGMENT_WINDOWS] + 1 - c[_SEGMENT]
    while i < 3:
        d = (
            (s[_REFERENCE + i] << 4)
            + ((s[_WINDOW_SUM + i] << 4) >> c[_WINDOW_SHIFT])
            - s[_ANCHOR_Q4 + i]
        )
        d = clipped(d, 8191)
        square += d * d
        s[_LEAN_Q4 + i] += weight * d
        i += 1
    return square


def begin_tilt(s: ptr32):
    """Begin to watch how gravity tilts."""
    for i in range(4):
        s[_LEAN_Q4 + i] = 0  # TILT_NOISE_Q8 stands behind them


def tilts_steadily(s: ptr32, c: ptr32) -> int:
    """Return 1 if gravity moved steadily over the segment: the device turns, if slowly."""
    square = 0
    for i in range(3):
        d = clipped(s[_LEAN_Q4 + i] >> 2, 17000)
        square += d * d
    d = clipped(s[_TILT_NOISE_Q8], 0x3FFFFF) * c[_TILT_NOISE_FACTOR_Q4] >> 4
    return 1 if square > c[_TILT_LIMIT_Q4] + d else 0


def change_q4(s: ptr32, c: ptr32) -> int:
    """Return the largest change of a window's mean rate since the segment began: LSB, Q4."""
    most = 0
    for i in range(3):
        d = (
            (s[_REFERENCE + 4 + i] << 4)
            + ((s[_WINDOW_SUM + 4 + i] << 4) >> c[_WINDOW_SHIFT])
            - s[_FIRST_RATE_Q4 + i]
        )
        if d < 0:
            d = -d
        if d > most:
            most = d
    return most


def begin(s: ptr32, c: ptr32, anchored: int):
    """Begin a segment with this window; without `anchored` a new rest as well."""
    for i in range(3):
        if anchored == 0:
            s[_ANCHOR_Q4 + i] = (s[_REFERENCE + i] << 4) + (
                (s[_WINDOW_SUM + i] << 4) >> c[_WINDOW_SHIFT]
            )
        s[_FIRST_RATE_Q4 + i] = (s[_REFERENCE + 4 + i] << 4) + (
            (s[_WINDOW_SUM + 4 + i] << 4) >> c[_WINDOW_SHIFT]
        )
        s[_SEGMENT_TOTAL + i] = 0
    if anchored == 0:
        begin_tilt(s)
        s[_REST] = 0
        s[_ANCHOR_SIZE] = size(s)
        s[_BANK_Q10] = bank_q10(s, c)
    if s[_REST] < _MOST_SEGMENTS:
        s[_REST] += 1
    s[_SEGMENT_TEMP] = 0
    s[_SEGMENT_WINDOWS] = 0


def white(s: ptr32, c: ptr32, spread: int) -> int:
    """Return 1 if neighbouring samples of the gyroscope share nothing: noise, not motion."""
    # von Neumann's ratio: the mean squared step is twice the variance for white noise, less for
    # whatever is slower and more for what alternates: 1.375 to 2.75 times is taken for noise.
    step = s[_SQUARE_STEP] << (8 - c[_WINDOW_SHIFT]) >> 4
    level = spread >> 4
    least = level + (level >> 1) - (level >> 3)
    return 1 if step > least and step < 3 * level - (level >> 2) else 0


def classify_window(s: ptr32, c: ptr32) -> int:
    """Return what the full window says: _STILL, _MOVING, _SHAKEN, _TURNING, _SHIFTED, _SILENT."""
    if s[_DIRTY] > 3:
        return _MOVING
    if s[_DIRTY]:
        return _SHAKEN
    noise_q8 = spread_q8(s, _WINDOW_SUM + 4, s[_SQUARE_GYRO], c[_WINDOW_SHIFT])
    if noise_q8 == 0 and s[_NOISE_Q8] + c[_QUIETEST_Q8] > _NOISY_Q8:
        return _SILENT  # no rate changed, of a part whose noise would change them
    if noise_q8 > c[_STILL_GYRO_Q8] and white(s, c, noise_q8) == 0:
        return _MOVING
    shake_q8 = spread_q8(s, _WINDOW_SUM, s[_SQUARE_ACCEL], c[_WINDOW_SHIFT])
    if shake_q8 > c[_STILL_ACCEL_Q8]:
        return _SHAKEN
    s[_NOISE_Q8] += (noise_q8 - s[_NOISE_Q8]) >> 3
    if s[_REST] == 0:
        return _STILL
    s[_TIP_Q8] = gravity_moved_q8(s, c)
    shake_q8 = shake_q8 >> c[_WINDOW_SHIFT]
    s[_TILT_NOISE_Q8] += shake_q8
    if s[_TIP_Q8] > c[_TIP_LIMIT_Q8] + _GRAVITY_NOISE * shake_q8:
        return _TURNING
    if s[_SEGMENT_WINDOWS]:
        change = change_q4(s, c)
        if change > 0x7FFF:
            return _SHIFTED
        if change * change > c[_CHANGE_LIMIT_Q8] + _RATE_NOISE * (noise_q8 >> c[_WINDOW_SHIFT]):
            return _SHIFTED
    return _STILL


def follow_temperature(s: ptr32, c: ptr32):
    """Smooth the temperature by a line through the windows so far, thirty at most."""
    # A thermometer's noise of a tenth of a degree, times the slope of the bias, is several mdps. A
    # line has no lag behind a steady rise; level and rise take least-squares shares of the error.
    level = (s[_REFERENCE + 3] << 4) + ((s[_WINDOW_SUM + 3] << 4) >> c[_WINDOW_SHIFT])
    level = level << 4
    error = level - s[_TEMP_LEVEL_Q8] - ((s[_TEMP_RISE_Q12] + 8) >> 4)
    far = error if error >= 0 else 0 - error
    if s[_TEMP_WINDOWS] == 0 or c[_WINDOW] == 4 or far > _FAR_Q8:
        s[_TEMP_WINDOWS] = 1
        s[_TEMP_RISE_Q12] = 0
    else:
        n = s[_TEMP_WINDOWS]
        if n < _SMOOTHED:
            n += 1
            s[_TEMP_WINDOWS] = n
        far = n * (n + 1)
        n = error * (4 * n - 2)
        level -= error - (n + (far >> 1)) // far
        n = (error * 96 + (far >> 1)) // far
        s[_TEMP_RISE_Q12] += n
    s[_TEMP_LEVEL_Q8] = level
    s[_TEMP] = (level + 128) >> 8


def judge(s: ptr32, c: ptr32) -> int:
    """Close the full window; return how many windows the still segment has that it ends, else 0."""
    # A segment's sums are then in the shared block, and the next window begins a new one of the
    # same rest, whose gravity still is the anchor: the longer a rest, the slower the turns it
    # shows. What is left of a rest that motion ends is a segment, too, if it has two windows: one
    # that a turn or a shift ends was none.
    state = classify_window(s, c)
    s[_STILLNESS] = state
    follow_temperature(s, c)
    s[_WINDOW_N] = 0
    i = s[_SEGMENT_WINDOWS]
    if state == _MOVING or state == _SHAKEN or state == _SILENT:
        s[_REST] = 0
        s[_SEGMENT_WINDOWS] = 0
        return i if i > 1 else 0
    if state != _STILL or s[_REST] == 0:
        begin(s, c, 0)
    elif i == 0:
        begin(s, c, 1)
    for i in range(3):
        total = s[_REFERENCE + 4 + i] << c[_WINDOW_SHIFT]
        total -= (s[_EFFECT_SUM_Q8 + i] + 128) >> 8
        total += s[_WINDOW_SUM + 4 + i]
        s[_SEGMENT_TOTAL + i] += total
    s[_SEGMENT_TEMP] += s[_TEMP]
    i = s[_SEGMENT_WINDOWS] + 1
    s[_SEGMENT_WINDOWS] = i
    if i < c[_SEGMENT]:
        return 0
    s[_SEGMENT_WINDOWS] = 0
    if tilts_steadily(s, c):
        s[_STILLNESS] = _TURNING
        s[_REST] = 0
        i = 0
    begin_tilt(s)
    return i


# What of a rest may be a turn: along gravity any, which only time and other poses tell from a bias;
# across it what had no time to tilt the device.


def up(s: ptr32, axis: int) -> int:
    """Return gravity along the axis where the rest began, in units of 16 LSB."""
    return clipped(s[_ANCHOR_Q4 + axis] >> 8, _MOST_G)


def size(s: ptr32) -> int:
    """Return the size of gravity where the rest began, in units of 16 LSB."""
    total = 0
    for i in range(3):
        total += up(s, i) * up(s, i)
    return root(total)


def level_q4(s: ptr32, c: ptr32) -> int:
    """Return the turn about a level axis that gravity hides yet: LSB, Q4."""
    if s[_ANCHOR_SIZE] == 0:
        return 0  # nothing is hidden across it, for there is no gravity
    moved = root(s[_TIP_Q8] + c[_TIP_LIMIT_Q8]) * c[_TILT_SPEED] // s[_ANCHOR_SIZE]
    return clipped(moved // (s[_REST] if s[_REST] else 1), 0x3FFF)


def tilting_q4(s: ptr32, c: ptr32) -> int:
    """Return the same of a rest that goes on, also of one that has no segment yet."""
    g = level_q4(s, c)
    if s[_REST] < 2 and s[_SEGMENT_WINDOWS]:
        g = g * c[_SEGMENT] // s[_SEGMENT_WINDOWS]
    return clipped(g, 0x3FFF)


def steady_q4(s: ptr32, c: ptr32) -> int:
    """Return the turn about the vertical that lasts as long as the rest, one sigma, LSB Q4."""
    # As fast a turn as the bias is as likely as that bias; of all turns as steady half end in time.
    total = c[_TURNING_LSB] * c[_TURNING_LSB]
    rate = clipped(s[_BANK_Q10] * c[_TURNING_LSB] >> 10, 0x7FF) * _BANKED
    total += rate * rate
    for i in range(3):
        rate = clipped(s[_TARGET_Q8 + i] >> 8, 0x3FFF)
        total += rate * rate >> 1
    rate = c[_TURN_HALVES]
    total = (root(total) << 4) * (2 * rate - s[_REST] % rate) // (2 * rate)
    rate = s[_REST] // rate
    return total >> rate if rate < 30 else 0


def bank_q10(s: ptr32, c: ptr32) -> int:
    """Return the tangent of the bank that makes an acceleration more than 1 g."""
    # It is the bank of an aircraft in a coordinated turn, whose load is 1 / cos(bank).
    over = clipped((s[_ANCHOR_SIZE] << 10) // c[_ONE_G], 0x3FFF) - 1024
    return root(over << 11) if over > 0 else 0


def share_q10(s: ptr32, axis: int) -> int:
    """Return which share of a turn about the vertical the axis has, without its sign."""
    share = up(s, axis)
    return ((share if share > 0 else 0 - share) << 10) // (s[_ANCHOR_SIZE] + 1)


def hidden_q4(s: ptr32, c: ptr32, axis: int) -> int:
    """Return how much of a turn the rest so far may hide on the axis: one sigma, LSB Q4."""
    turn = steady_q4(s, c)
    turn = turn if turn > s[_DRIFTED_Q4] else s[_DRIFTED_Q4]
    if s[_ANCHOR_SIZE] and s[_REST]:
        share = share_q10(s, axis) + s[_BANK_Q10]
        turn = (turn * (share if share < 1024 else 1024) >> 10) + level_q4(s, c)
    return clipped(turn, _MOST_HIDDEN_Q4)
