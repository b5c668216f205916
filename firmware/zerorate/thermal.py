"""How the bias found in motion follows the temperature, between one window and the next.

A Kalman filter of two states an axis, bias and slope over temperature: the window's least squares
are its measurement. A bias carried along its slope does not lag behind a ramp, and what the ramp
teaches of the slope costs no more than its covariance with the bias.

Three packed numbers an axis from _SLOPE on: the slope, its covariance with the bias, its variance;
in Q24 rad a node and raw LSB of the thermometer.
"""

try:
    from micropython import const
except ImportError:

    def const(value):
        return value


ptr32 = None


from .least_squares import place
from .real import add, divide, multiply, pack, put, subtract, unpack

_FILLED = const(9)
_AGE = const(66)
_P = const(148)
_PRIOR_MEAN = const(172)
_BIAS = const(178)
_T = const(202)
_T1 = const(204)
_T2 = const(206)
_T3 = const(208)
_SLOPE = const(228)
_TEMP_Q8 = const(237)
_THEN_Q8 = const(238)
_NOW_Q8 = const(239)
# free where these are in use: the passes' slopes, and the prior not yet inverted
_K = const(184)
_C = const(186)
_V = const(188)
_BENT = const(160)

_WALK = const(12)
_SLOPE_VARIANCE = const(23)
_BEND = const(25)


def forget_slopes(s: ptr32, c: ptr32):
    """Know no slope: 0, with the variance that the settings give it."""
    i = 0
    put(s, _V, c[_SLOPE_VARIANCE], c[_SLOPE_VARIANCE + 1])
    while i < 9:
        s[_SLOPE + i] = 0
        s[_SLOPE + i + 1] = 0
        pack(s, _SLOPE + i + 2, _V)
        i += 3


def follow_temperature(s: ptr32, temp: int):
    """Follow the thermometer: closely, and as far behind as a window's middle is behind its end."""
    temp = temp << 8
    if s[_FILLED] == 0:
        s[_TEMP_Q8] = temp
        s[_NOW_Q8] = temp
    s[_TEMP_Q8] += (temp - s[_TEMP_Q8] + 32) >> 6
    s[_NOW_Q8] += (temp - s[_NOW_Q8] + 2) >> 2


def present(s: ptr32, i: int):
    """Store at _T1 the bias of axis i at the present temperature, for _BIAS is of the window's."""
    put(s, _T1, s[_NOW_Q8] - s[_THEN_Q8], -8)
    unpack(s, _T2, _SLOPE + 3 * i)
    multiply(s, _T1, _T1, _T2)
    add(s, _T1, _T1, _BIAS + 2 * i)


def unpack_slope(s: ptr32, a: int):
    """Bring the axis' three numbers at word a to where they are worked with."""
    unpack(s, _K, a)
    unpack(s, _C, a + 1)
    unpack(s, _V, a + 2)


def pack_slope(s: ptr32, a: int):
    """Put them back."""
    pack(s, a, _K)
    pack(s, a + 1, _C)
    pack(s, a + 2, _V)


def carry(s: ptr32, c: ptr32, known: int):
    """Carry what is known to this window's temperature and time, unless nothing is."""
    i = 0
    put(s, _T, s[_TEMP_Q8] - s[_THEN_Q8], -8)
    put(s, _T2, c[_WALK], c[_WALK + 1])
    put(s, _T1, s[_AGE], 0)
    multiply(s, _T3, _T2, _T1)
    while i < 3 and known:
        carry_axis(s, c, i)
        i += 1
    s[_THEN_Q8] = s[_TEMP_Q8]
    s[_AGE] = 0


def variance_at(i: int) -> int:
    """Return the word of the bias' variance of axis i."""
    return _P + i * (7 - i)


def carry_axis(s: ptr32, c: ptr32, i: int):
    """Carry an axis by the change of temperature at _T and the walked variance at _T3."""
    d = _SLOPE + 3 * i
    unpack_slope(s, d)
    multiply(s, _T1, _K, _T)
    add(s, _PRIOR_MEAN + 2 * i, _PRIOR_MEAN + 2 * i, _T1)
    multiply(s, _T1, _V, _T)
    add(s, _T2, _C, _T1)
    add(s, _T1, _C, _T2)
    multiply(s, _T1, _T1, _T)
    # the covariances of the axes stay, so a variance must not shrink under them
    put(s, _T1, s[_T1] if s[_T1] > 0 else 0, s[_T1 + 1])
    add(s, _T1, _T1, _T3)
    i = int(variance_at(i))
    add(s, i, i, _T1)
    bend(s, c)
    put(s, _C, s[_T2], s[_T2 + 1])
    pack_slope(s, d)


def bend(s: ptr32, c: ptr32):
    """Let the slope's variance grow, for a curve bends."""
    i = s[_T] if s[_T] >= 0 else -s[_T]
    put(s, _T1, i, s[_T + 1] - c[_BEND])
    put(s, _BENT, c[_SLOPE_VARIANCE], c[_SLOPE_VARIANCE + 1])
    multiply(s, _T1, _T1, _BENT)
    add(s, _V, _V, _T1)


def learn_slopes(s: ptr32):
    """Learn from how the window moved each bias; its covariance is still in the swept matrix."""
    i = 0
    while i < 3:
        learn_slope(s, i)
        i += 1


def learn_slope(s: ptr32, i: int):
    """Move the slope by its regression on the bias, and condition its variance."""
    d = _SLOPE + 3 * i
    unpack_slope(s, d)
    a = int(variance_at(i))
    divide(s, _T, _C, a)
    subtract(s, _T1, _BIAS + 2 * i, _PRIOR_MEAN + 2 * i)
    multiply(s, _T1, _T1, _T)
    add(s, _K, _K, _T1)
    i = int(place(i, i))
    add(s, _T1, a, i)
    multiply(s, _T1, _T1, _T)
    multiply(s, _T1, _T1, _T)
    subtract(s, _T2, _V, _T1)
    put(s, _V, s[_T2] if s[_T2] > 0 else 0, s[_T2 + 1])
    put(s, _T1, -s[i], s[i + 1])
    multiply(s, _C, _T, _T1)
    pack_slope(s, d)
