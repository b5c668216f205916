"""The sources of the effect slots: means over a tick of what the samples and the application say.

A source's value is in Q8 of its integer. Words of an input: see model.py.
"""

try:
    from micropython import const
except ImportError:

    def const(value):
        return value


ptr32 = None


_NONE = const(-0x3FFFFFFF)

_SLOW_Q8 = const(20)
_SQUARES = const(23)
_SHAKEN = const(25)
_HALF_TICKS = const(7)

_SHIFT = const(1)
_OFFSET = const(2)
_SUM = const(3)
_N = const(4)
_VALUE = const(5)
_WORDS = const(6)
_INPUTS = const(32)
_COUNT = const(1)

_VIBRATION = const(7)
_TIME = const(8)
_INSTANT = const(10)
_EXTRA = const(16)
_EXTRAS = const(104)
_MOST = const(16383)


def shake(e: ptr32, x: ptr32):
    """Add the frame's squared acceleration, less its slow part, to the tick's vibration.

    The sum has its lower 15 bits apart. Each axis counts up to 18900 LSB, 1.15 g at +-2 g.
    """
    total = 0
    i = 0
    while i < 3:
        d = x[i] << 8
        slow = e[_SLOW_Q8 + i] if e[_SHAKEN] else d
        slow += (d - slow + 16) >> 5
        e[_SLOW_Q8 + i] = slow
        d = (d - slow + 128) >> 8
        if d > 18900 or d < -18900:
            d = 18900
        total += d * d
        i += 1
    e[_SHAKEN] = 1
    e[_SQUARES] += total & 0x7FFF
    e[_SQUARES + 1] += total >> 15


def extra(e: ptr32, a: int) -> int:
    """Return what the application last said of the input's channel, in 16 bits, or _NONE."""
    v = e[_EXTRAS + e[a] - _EXTRA]
    if v == _NONE:
        return _NONE
    if v > 0x1FFFFFFF:
        v = 0x1FFFFFFF
    elif v < -0x1FFFFFFF:
        v = -0x1FFFFFFF
    v -= e[a + _OFFSET]
    a = e[a + _SHIFT]
    if a > 0:
        v = v >> a
        a = 0
    a = 0 - a
    if v > 32767 >> a:
        v = 32767 >> a
    elif v < -(32768 >> a):
        v = -(32768 >> a)
    return v << a


def accumulate(e: ptr32, x: ptr32):
    """Add the frame x, and the application's channels, to the tick."""
    a = _INPUTS
    end = a + _WORDS * e[_COUNT]
    while a < end:
        v = e[a]
        if v >= _EXTRA:
            v = extra(e, a)
        elif v >= _INSTANT:
            e[a + _VALUE] = x[(v - _INSTANT + 4) % 7] << 8
            v = _NONE
        elif v < _VIBRATION:
            v = x[v]
        elif v == _VIBRATION:
            shake(e, x)
            v = 0
        else:
            v = _NONE
        if v != _NONE and e[a + _N] < _MOST:
            e[a + _SUM] += v
            e[a + _N] += 1
        a += _WORDS


def mean_q8(total: int, n: int) -> int:
    """Return total / n in Q8 for n < 2^14, rounded."""
    sign = 1
    if total < 0:
        total = -total
        sign = -1
    return sign * (((total // n) << 8) + (((total % n) << 8) + (n >> 1)) // n)


def mean_square_q8(e: ptr32, n: int, shift: int) -> int:
    """Return the tick's vibration, LSB^2 / 2^shift in Q8, at most 2^15."""
    low = ((e[_SQUARES + 1] % n) << 15) + e[_SQUARES]
    mean = ((e[_SQUARES + 1] // n) << 15) + low // n
    e[_SQUARES] = 0
    e[_SQUARES + 1] = 0
    if mean >> shift > 32767:
        return 0x7FFFFF
    if shift >= 8:
        return mean >> (shift - 8)
    return (mean << (8 - shift)) + ((((low % n) << 8) // n) >> shift)


def close_tick(e: ptr32):
    """Turn the sums of the tick into the values of the sources; those without samples stay."""
    a = _INPUTS
    end = a + _WORDS * e[_COUNT]
    while a < end:
        if e[a + _N]:
            if e[a] == _VIBRATION:
                e[a + _VALUE] = mean_square_q8(e, e[a + _N], e[a + _SHIFT])
            else:
                e[a + _VALUE] = mean_q8(e[a + _SUM], e[a + _N])
        e[a + _SUM] = 0
        e[a + _N] = 0
        a += _WORDS


def tell_time(e: ptr32):
    """Give the source that is the time since power-on the middle of the tick, in half ticks."""
    a = _INPUTS
    end = a + _WORDS * e[_COUNT]
    while a < end:
        if e[a] == _TIME:
            shift = e[a + _SHIFT]
            if e[_HALF_TICKS] >> shift > 32767:
                e[a + _VALUE] = 0x7FFFFF
            elif shift > 8:
                e[a + _VALUE] = e[_HALF_TICKS] >> (shift - 8)
            else:
                e[a + _VALUE] = e[_HALF_TICKS] << (8 - shift)
        a += _WORDS
