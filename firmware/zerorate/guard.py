"""Is this frame a real reading? Facts: mpu6050 family, faults seen on real buses."""

try:
    from micropython import const
except ImportError:

    def const(value):
        return value


ptr32 = None


# layout: The corrector's state
_FRAME = const(0)
_COUNTS = const(8)
_ELAPSED_US = const(16)
_WINDOW_N = const(17)
_DIRTY = const(18)
_REST = const(34)
# layout: The corrector's settings
_LEAP_US = const(1)
_JUMP_LSB = const(2)
# layout: What the guard says of a frame
GOOD = const(0)
REPEAT = const(1)
RAIL = const(2)
ALL_ZERO = const(3)
ALL_ONES = const(4)
TEMPERATURE_JUMP = const(5)
TIME_STOOD_STILL = const(6)
TIME_LEAPT = const(7)
# layout: end

_MOST_US = const(0x1FFFFFFF)  # two of them fit 31 bits: repeats may come for hours


def check(s: ptr32, c: ptr32, x: ptr32, dt_us: int) -> int:
    """Return the kind of the frame `x` and count it; only GOOD frames may be learned from.

    A repeat is passed over; every other
    fault also ends the rest that is being watched, because what stands beside a broken frame may
    be broken too.
    """
    differ = 0
    fresh = 0
    jump = x[3] - s[_FRAME + 3]
    i = 0
    while i < 7:
        if x[i] != x[0]:
            differ = 1
        if x[i] != s[_FRAME + i]:
            fresh = 1
        s[_FRAME + i] = x[i]
        i += 1
    i = GOOD
    if differ == 0 and (x[0] == 0 or x[0] == -1):
        i = ALL_ZERO - x[0]
    elif s[_COUNTS] == 0:
        i = GOOD  # nothing came before it
    elif dt_us <= 0:
        i = TIME_STOOD_STILL
    elif dt_us > c[_LEAP_US]:
        i = TIME_LEAPT
    elif fresh == 0:
        i = REPEAT
    elif jump >= c[_JUMP_LSB] or jump <= -c[_JUMP_LSB]:
        i = TEMPERATURE_JUMP
    if i == GOOD:
        jump = 4
        while jump < 7:
            if x[jump] > 32766 or x[jump] < -32767:
                i = RAIL
            jump += 1
    i += _COUNTS
    jump = s[i] + 1
    s[i] = jump & 0x1FFFFFFF
    i -= _COUNTS
    if i > REPEAT:
        s[_WINDOW_N] = 0
        s[_DIRTY] = 0
        s[_REST] = 0
    elif dt_us > 0 and dt_us <= c[_LEAP_US]:
        dt_us += s[_ELAPSED_US]
        s[_ELAPSED_US] = dt_us if dt_us < _MOST_US else _MOST_US
    return i
