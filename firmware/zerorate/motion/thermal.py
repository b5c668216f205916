"""How the bias found in motion follows the temperature, between one window and the next.

A Kalman filter of two states an axis, bias and slope over temperature: the window's least squares
are its measurement. A bias carried along its slope does not lag behind a ramp, and what the ramp
teaches of the slope costs no more than its covariance with the bias.

Three packed numbers an axis at _TEMP_SLOPES: the slope, its covariance with the bias, its variance,
in Q24 rad a node and raw LSB of the thermometer.
"""

from ..arithmetic.real import add, divide, multiply, pack, put, subtract, unpack
from .least_squares import place

# layout: names that a board's own compiler reads
const = int
ptr32 = None
# layout: The state of the source in motion
_FILLED = const(9)
_AGE_NODES = const(67)
_KNOWN_P = const(149)
_PRIOR_MEAN = const(173)
_BIAS = const(179)
_T = const(203)
_T1 = const(205)
_T2 = const(207)
_T3 = const(209)
_TEMP_SLOPES = const(229)
_TEMP_Q8 = const(238)
_THEN_TEMP_Q8 = const(239)
_NOW_TEMP_Q8 = const(240)
_BENT = const(161)
_TEMP_SLOPE = const(185)
_TEMP_SLOPE_COVARIANCE = const(187)
_TEMP_SLOPE_VARIANCE = const(189)
# layout: The settings of the source in motion
_BIAS_WALK = const(12)
_TEMP_SLOPE_START = const(24)
_BEND = const(26)
# layout: end


def forget_slopes(s: ptr32, c: ptr32):
    """Know no slope: 0, with the variance that the settings give it."""
    put(s, _TEMP_SLOPE_VARIANCE, c[_TEMP_SLOPE_START], c[_TEMP_SLOPE_START + 1])
    for i in range(0, 9, 3):
        s[_TEMP_SLOPES + i] = 0
        s[_TEMP_SLOPES + i + 1] = 0
        pack(s, _TEMP_SLOPES + i + 2, _TEMP_SLOPE_VARIANCE)


def follow_temperature(s: ptr32, temp: int):
    """Follow the thermometer: closely, and as far behind as a window's middle is behind its end."""
    temp_q8 = temp << 8
    if s[_FILLED] == 0:
        s[_TEMP_Q8] = temp_q8
        s[_NOW_TEMP_Q8] = temp_q8
    s[_TEMP_Q8] += (temp_q8 - s[_TEMP_Q8] + 32) >> 6
    s[_NOW_TEMP_Q8] += (temp_q8 - s[_NOW_TEMP_Q8] + 2) >> 2


def present(s: ptr32, i: int):
    """Store at _T1 the bias of axis i at the present temperature, for _BIAS is of the window's."""
    put(s, _T1, s[_NOW_TEMP_Q8] - s[_THEN_TEMP_Q8], -8)
    unpack(s, _T2, _TEMP_SLOPES + 3 * i)
    multiply(s, _T1, _T1, _T2)
    add(s, _T1, _T1, _BIAS + 2 * i)


def unpack_slope(s: ptr32, a: int):
    """Bring the axis' three numbers at word a to where they are worked with."""
    unpack(s, _TEMP_SLOPE, a)
    unpack(s, _TEMP_SLOPE_COVARIANCE, a + 1)
    unpack(s, _TEMP_SLOPE_VARIANCE, a + 2)


def pack_slope(s: ptr32, a: int):
    """Put them back."""
    pack(s, a, _TEMP_SLOPE)
    pack(s, a + 1, _TEMP_SLOPE_COVARIANCE)
    pack(s, a + 2, _TEMP_SLOPE_VARIANCE)


def carry(s: ptr32, c: ptr32, known: int):
    """Carry what is known to this window's temperature and time, unless nothing is."""
    i = 0
    put(s, _T, s[_TEMP_Q8] - s[_THEN_TEMP_Q8], -8)
    put(s, _T2, c[_BIAS_WALK], c[_BIAS_WALK + 1])
    put(s, _T1, s[_AGE_NODES], 0)
    multiply(s, _T3, _T2, _T1)
    while i < 3 and known:
        carry_axis(s, c, i)
        i += 1
    s[_THEN_TEMP_Q8] = s[_TEMP_Q8]
    s[_AGE_NODES] = 0


def variance_at(i: int) -> int:
    """Return the word of the bias' variance of axis i."""
    return _KNOWN_P + i * (7 - i)


def carry_axis(s: ptr32, c: ptr32, i: int):
    """Carry an axis by the change of temperature at _T and the walked variance at _T3."""
    d = _TEMP_SLOPES + 3 * i
    unpack_slope(s, d)
    multiply(s, _T1, _TEMP_SLOPE, _T)
    add(s, _PRIOR_MEAN + 2 * i, _PRIOR_MEAN + 2 * i, _T1)
    multiply(s, _T1, _TEMP_SLOPE_VARIANCE, _T)
    add(s, _T2, _TEMP_SLOPE_COVARIANCE, _T1)
    add(s, _T1, _TEMP_SLOPE_COVARIANCE, _T2)
    multiply(s, _T1, _T1, _T)
    # the covariances of the axes stay, so a variance must not shrink under them
    put(s, _T1, s[_T1] if s[_T1] > 0 else 0, s[_T1 + 1])
    add(s, _T1, _T1, _T3)
    v = variance_at(i)
    add(s, v, v, _T1)
    bend(s, c)
    put(s, _TEMP_SLOPE_COVARIANCE, s[_T2], s[_T2 + 1])
    pack_slope(s, d)


def bend(s: ptr32, c: ptr32):
    """Let the slope's variance grow, for a curve bends."""
    i = s[_T] if s[_T] >= 0 else -s[_T]
    put(s, _T1, i, s[_T + 1] - c[_BEND])
    put(s, _BENT, c[_TEMP_SLOPE_START], c[_TEMP_SLOPE_START + 1])
    multiply(s, _T1, _T1, _BENT)
    add(s, _TEMP_SLOPE_VARIANCE, _TEMP_SLOPE_VARIANCE, _T1)


def learn_slope(s: ptr32, i: int):
    """Move the slope by its regression on the bias, and condition its variance."""
    # the covariance of how the window moved each bias is still in the swept matrix
    d = _TEMP_SLOPES + 3 * i
    unpack_slope(s, d)
    a = variance_at(i)
    divide(s, _T, _TEMP_SLOPE_COVARIANCE, a)
    subtract(s, _T1, _BIAS + 2 * i, _PRIOR_MEAN + 2 * i)
    multiply(s, _T1, _T1, _T)
    add(s, _TEMP_SLOPE, _TEMP_SLOPE, _T1)
    i = place(i, i)  # eleven words: i is from here on its variance's word in the swept matrix
    add(s, _T1, a, i)
    multiply(s, _T1, _T1, _T)
    multiply(s, _T1, _T1, _T)
    subtract(s, _T2, _TEMP_SLOPE_VARIANCE, _T1)
    put(s, _TEMP_SLOPE_VARIANCE, s[_T2] if s[_T2] > 0 else 0, s[_T2 + 1])
    put(s, _T1, -s[i], s[i + 1])
    multiply(s, _TEMP_SLOPE_COVARIANCE, _T, _T1)
    pack_slope(s, d)
