"""The sources of the effect slots: what the samples and the application say, now or in a tick.

A source's value is in Q8 of its integer. Words of an input: docs/layout.md.
"""

from ..arithmetic.fixed import clipped

# layout: names that a board's own compiler reads
const = int
ptr32 = None
# layout: The effect model and its running state
_INPUT_COUNT = const(8)
_HALF_TICKS = const(14)
_SLOW_Q8 = const(27)
_SQUARES = const(30)
_SLOW_BEGUN = const(32)
_INPUTS = const(39)
_CHANNELS = const(111)
# layout: An input of the effect model
_INPUT_KIND = const(0)
_INPUT_SHIFT = const(1)
_INPUT_OFFSET = const(2)
_INPUT_SUM = const(3)
_INPUT_N = const(4)
_INPUT_VALUE_Q8 = const(5)
_INPUT_WORDS = const(6)
# layout: Sources of effects: an acceleration, the temperature, a mean rate, ..., a channel
_KIND_VIBRATION = const(7)
_KIND_TIME = const(8)
_KIND_INSTANT = const(10)
_KIND_CHANNEL = const(16)
_KIND_CHANNEL_NOW = const(24)
# layout: Values that stand for none
_NO_VALUE = const(-0x3FFFFFFF)
# layout: end
_MOST_SAMPLES = const(16383)


def shake(e: ptr32, x: ptr32):
    """Add the frame's squared acceleration, less its slow part, to the tick's vibration."""
    # The sum has its lower 15 bits apart. Each axis counts up to 18900 LSB, 1.15 g at +-2 g.
    total = 0
    for i in range(3):
        d = x[i] << 8
        slow = e[_SLOW_Q8 + i] if e[_SLOW_BEGUN] else d
        slow += (d - slow + 16) >> 5
        e[_SLOW_Q8 + i] = slow
        d = (d - slow + 128) >> 8
        if d > 18900 or d < -18900:
            d = 18900
        total += d * d
    e[_SLOW_BEGUN] = 1
    e[_SQUARES] += total & 0x7FFF
    e[_SQUARES + 1] += total >> 15


def extra(e: ptr32, a: int) -> int:
    """Return what the application last said of the input's channel, in 16 bits, or _NO_VALUE."""
    v = e[_CHANNELS + (e[a + _INPUT_KIND] & 7)]
    if v == _NO_VALUE:
        return _NO_VALUE
    v = clipped(v, 0x1FFFFFFF) - e[a + _INPUT_OFFSET]
    left = 0 - e[a + _INPUT_SHIFT]
    if left < 0:
        v = v >> (0 - left)
        left = 0
    if v > 32767 >> left:
        v = 32767 >> left
    elif v < -(32768 >> left):
        v = -(32768 >> left)
    return v << left


def accumulate(e: ptr32, x: ptr32):
    """Add the frame x, and the application's channels, to the tick."""
    a = _INPUTS
    end = a + _INPUT_WORDS * e[_INPUT_COUNT]
    while a < end:
        v = e[a + _INPUT_KIND]
        if v >= _KIND_CHANNEL:
            v = extra(e, a)
            if v != _NO_VALUE and e[a + _INPUT_KIND] >= _KIND_CHANNEL_NOW:
                e[a + _INPUT_VALUE_Q8] = v << 8
                v = _NO_VALUE
        elif v >= _KIND_INSTANT:
            e[a + _INPUT_VALUE_Q8] = x[(v - _KIND_INSTANT + 4) % 7] << 8
            v = _NO_VALUE
        elif v < _KIND_VIBRATION:
            v = x[v]
        elif v == _KIND_VIBRATION:
            shake(e, x)
            v = 0
        else:
            v = _NO_VALUE
        if v != _NO_VALUE and e[a + _INPUT_N] < _MOST_SAMPLES:
            e[a + _INPUT_SUM] += v
            e[a + _INPUT_N] += 1
        a += _INPUT_WORDS


def mean_q8(total: int, n: int) -> int:
    """Return total / n in Q8 for n < 2^14, rounded."""
    sign = 1 if total >= 0 else -1
    size = sign * total
    return sign * (((size // n) << 8) + (((size % n) << 8) + (n >> 1)) // n)


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
    end = a + _INPUT_WORDS * e[_INPUT_COUNT]
    while a < end:
        if e[a + _INPUT_N]:
            if e[a + _INPUT_KIND] == _KIND_VIBRATION:
                e[a + _INPUT_VALUE_Q8] = mean_square_q8(e, e[a + _INPUT_N], e[a + _INPUT_SHIFT])
            else:
                e[a + _INPUT_VALUE_Q8] = mean_q8(e[a + _INPUT_SUM], e[a + _INPUT_N])
        e[a + _INPUT_SUM] = 0
        e[a + _INPUT_N] = 0
        a += _INPUT_WORDS


def tell_time(e: ptr32):
    """Give the source that is the time since power-on the middle of the tick, in half ticks."""
    a = _INPUTS
    end = a + _INPUT_WORDS * e[_INPUT_COUNT]
    while a < end:
        if e[a + _INPUT_KIND] == _KIND_TIME:
            shift = e[a + _INPUT_SHIFT]
            if e[_HALF_TICKS] >> shift > 32767:
                e[a + _INPUT_VALUE_Q8] = 0x7FFFFF
            elif shift > 8:
                e[a + _INPUT_VALUE_Q8] = e[_HALF_TICKS] >> (shift - 8)
            else:
                e[a + _INPUT_VALUE_Q8] = e[_HALF_TICKS] << (8 - shift)
        a += _INPUT_WORDS
