"""How the bias found in motion follows the temperature, between one window and the next.

Beside each bias the filter has its slope over temperature, which rows move through the bias. A bias
carried along its slope does not lag behind a ramp, and what the ramp teaches of the slope costs no
more than its covariance with the bias.

Three packed numbers an axis at _TEMP_SLOPES: the slope, its covariance with the bias, its variance,
in Q24 rad a node and raw LSB of the thermometer; both over the push's variance.
"""

from ..arithmetic.real import add, copy, divide, multiply, pack, put, subtract, unpack
from .least_squares import known

# layout: names that a board's own compiler reads
const = int
ptr32 = None
# layout: The state of the source in motion
_FILLED = const(9)
_AGE_NODES = const(69)
_MEAN = const(375)
_PUSH = const(393)
_ROW_INNOVATION = const(400)
_EXPECTED = const(402)
_BIAS = const(404)
_SLOPE = const(410)
_T = const(416)
_T1 = const(418)
_T2 = const(420)
_T3 = const(422)
_TEMP_SLOPES = const(427)
_TEMP_Q8 = const(436)
_THEN_TEMP_Q8 = const(437)
_NOW_TEMP_Q8 = const(438)
_WITH = const(26)
_TEMP_SLOPE = const(410)
_TEMP_SLOPE_COVARIANCE = const(412)
_TEMP_SLOPE_VARIANCE = const(414)
# layout: The settings of the source in motion
_BIAS_WALK = const(12)
_TEMP_SLOPE_START = const(23)
_BEND = const(25)
# layout: end


def forget_slopes(s: ptr32, c: ptr32):
    """Know no slope: 0, with the variance that the settings give it."""
    put(s, _T, c[_TEMP_SLOPE_START], c[_TEMP_SLOPE_START + 1])
    divide(s, _TEMP_SLOPE_VARIANCE, _T, _PUSH)
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
    """Store at _T1 axis i's bias, which stands at _SLOPE for then, at the present temperature."""
    put(s, _T1, s[_NOW_TEMP_Q8] - s[_THEN_TEMP_Q8], -8)
    unpack(s, _T2, _TEMP_SLOPES + 3 * i)
    multiply(s, _T1, _T1, _T2)
    add(s, _T1, _T1, _SLOPE + 2 * i)


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


def carry(s: ptr32, c: ptr32, learned: int):
    """Carry what is known to this window's temperature and time, unless nothing is."""
    i = 0
    put(s, _T, s[_TEMP_Q8] - s[_THEN_TEMP_Q8], -8)
    put(s, _T2, c[_BIAS_WALK], c[_BIAS_WALK + 1])
    put(s, _T1, s[_AGE_NODES], 0)
    multiply(s, _T3, _T2, _T1)
    divide(s, _T3, _T3, _PUSH)
    while i < 3 and learned:
        carry_axis(s, c, i)
        i += 1
    s[_THEN_TEMP_Q8] = s[_TEMP_Q8]
    s[_AGE_NODES] = 0


def carry_axis(s: ptr32, c: ptr32, i: int):
    """Carry an axis by the change of temperature at _T and the walked variance at _T3."""
    d = _TEMP_SLOPES + 3 * i
    unpack_slope(s, d)
    multiply(s, _T1, _TEMP_SLOPE, _T)
    add(s, _BIAS + 2 * i, _BIAS + 2 * i, _T1)
    unpack(s, _T2, _MEAN + i)
    add(s, _T1, _T1, _T2)
    pack(s, _MEAN + i, _T1)
    multiply(s, _T1, _TEMP_SLOPE_VARIANCE, _T)
    add(s, _T2, _TEMP_SLOPE_COVARIANCE, _T1)
    add(s, _T1, _TEMP_SLOPE_COVARIANCE, _T2)
    put(s, _TEMP_SLOPE_COVARIANCE, s[_T2], s[_T2 + 1])
    multiply(s, _T1, _T1, _T)
    # the covariances of the axes stay, so a variance must not shrink under them
    put(s, _T1, s[_T1] if s[_T1] > 0 else 0, s[_T1 + 1])
    add(s, _T1, _T1, _T3)
    unpack(s, _T2, known(i, i))
    add(s, _T1, _T1, _T2)
    pack(s, known(i, i), _T1)
    bend(s, c)
    pack_slope(s, d)


def bend(s: ptr32, c: ptr32):
    """Let the slope's variance grow, for a curve bends."""
    i = s[_T] if s[_T] >= 0 else -s[_T]
    put(s, _T1, i, s[_T + 1] - c[_BEND])
    put(s, _T2, c[_TEMP_SLOPE_START], c[_TEMP_SLOPE_START + 1])
    multiply(s, _T1, _T1, _T2)
    divide(s, _T1, _T1, _PUSH)
    add(s, _TEMP_SLOPE_VARIANCE, _TEMP_SLOPE_VARIANCE, _T1)


def learn_slope(s: ptr32, i: int):
    """Let a row move axis i's slope, too, by its regression on the bias."""
    # what a row tells of a slope goes through its own axis' bias, or axes that no row tells apart
    # would be taken for known
    d = _TEMP_SLOPES + 3 * i
    unpack_slope(s, d)
    unpack(s, _T, known(i, i))
    divide(s, _T, _TEMP_SLOPE_COVARIANCE, _T)
    multiply(s, _T, _T, _WITH + 2 * i)
    multiply(s, _T1, _T, _ROW_INNOVATION)
    add(s, _TEMP_SLOPE, _TEMP_SLOPE, _T1)
    multiply(s, _T1, _T, _EXPECTED)
    multiply(s, _T, _T, _T1)
    subtract(s, _T2, _TEMP_SLOPE_VARIANCE, _T)
    put(s, _TEMP_SLOPE_VARIANCE, s[_T2] if s[_T2] > 0 else 0, s[_T2 + 1])
    multiply(s, _T1, _T1, _WITH + 2 * i)
    subtract(s, _T2, _TEMP_SLOPE_COVARIANCE, _T1)
    copy(s, _TEMP_SLOPE_COVARIANCE, _T2, 2)
    pack_slope(s, d)
