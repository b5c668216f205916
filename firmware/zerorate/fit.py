"""The sample-weighted least-squares line through an axis' estimators, in integers.

Document 000, "a least squares fit may be performed". `local` > 0 turns it into a line through the
neighbourhood of one temperature: an estimator `d` away counts 1 / (1 + (d/local)^2) of its
samples, and samples beyond `_COUNTED` add nothing, for then drift, not noise, is what is left.

Temperatures are raw LSB in Q4, biases LSB in Q8. A fit runs in steps, each a bounded piece of work:
weigh, centre (one a point), stretch, lean (one a point), settle.
"""

try:
    from micropython import const
except ImportError:

    def const(value):
        return value


ptr32 = None


from .fixed import fraction_q27, ratio_q26, scaled

_FREE = const(-1048576)

_FIT_T0_Q4 = const(14)
_FIT_MEAN_T_Q10 = const(15)
_FIT_MEAN_B_Q11 = const(16)
_FIT_SLOPE_Q26 = const(17)
_FIT_SHIFT = const(18)
_FIT_LOW_Q4 = const(19)
_FIT_HIGH_Q4 = const(20)
_FIT_SAMPLES = const(21)
_FIT_POINTS = const(22)
_ESTIMATORS = const(32)

_TEMP = const(47)
_SUM_W = const(80)
_SUM_T = const(81)
_SUM_B = const(82)
_SUM_TT = const(83)
_SUM_TB = const(84)
_FIRST_T_Q4 = const(85)
_FIRST_B_Q8 = const(86)
_LOW_Q4 = const(87)
_HIGH_Q4 = const(88)
_SAMPLES = const(89)
_POINTS = const(90)
_STRETCH = const(91)
_WEIGHTS = const(92)  # one word an estimator, the axes follow

_FIRST_SHORT = const(14)
_END = const(15)
_ALL = const(25)
_WORDS = const(26)
_ENOUGH = const(31)
_COUNTED = const(32)
_LOCAL = const(33)
_LOCAL_SHIFT = const(42)


def weigh(s: ptr32, c: ptr32, a: int):
    """Weigh the estimators that have enough samples, for a line that serves this temperature."""
    w = _SUM_W
    while w < _WEIGHTS:
        s[w] = 0
        w += 1
    i = _WEIGHTS + 1
    e = a + c[_FIRST_SHORT]
    while e < a + c[_END]:
        w = 0
        if s[e] != _FREE and s[e + 3] >= c[_ENOUGH]:
            w = s[e + 3]
            s[_SAMPLES] += w
            if w > c[_COUNTED]:
                w = c[_COUNTED]
            if c[_LOCAL]:
                d = (s[e + 1] - (s[_TEMP] << 4)) >> c[_LOCAL_SHIFT]
                if d > 0x3FFF or d < -0x3FFF:
                    d = 0x3FFF
                w = (w * c[_LOCAL]) // (c[_LOCAL] + d * d) + 1
            if s[_POINTS] == 0:
                s[_FIRST_T_Q4] = s[e + 1]
                s[_FIRST_B_Q8] = s[e + 2]
                s[_LOW_Q4] = s[e + 1]
                s[_HIGH_Q4] = s[e + 1]
            if s[e + 1] < s[_LOW_Q4]:
                s[_LOW_Q4] = s[e + 1]
            if s[e + 1] > s[_HIGH_Q4]:
                s[_HIGH_Q4] = s[e + 1]
            s[_POINTS] += 1
        s[i] = w
        s[_SUM_W] += w
        i += 1
        e += c[_WORDS]


def centre(s: ptr32, c: ptr32, a: int, i: int):
    """Add estimator i to the weighted means, and make its weight a share of 1 in Q27."""
    w = s[_WEIGHTS + i]
    if w == 0:
        return
    w = fraction_q27(w, s[_SUM_W])
    s[_WEIGHTS + i] = w
    a += i * c[_WORDS] + _ESTIMATORS
    d = s[a + 1] - s[_FIRST_T_Q4]
    d = scaled(w, d << 6, 27)
    s[_SUM_T] += d
    d = s[a + 2] - s[_FIRST_B_Q8]
    d = scaled(w, d << 3, 27)
    s[_SUM_B] += d


def stretch(s: ptr32, c: ptr32, a: int):
    """Find the shift that makes the largest distance from the mean temperature fill 27 bits."""
    most = 0
    i = _WEIGHTS + 1
    a += c[_FIRST_SHORT]
    while i < _WEIGHTS + c[_ALL]:
        if s[i]:
            d = s[a + 1] - s[_FIRST_T_Q4]
            d = (d << 6) - s[_SUM_T]
            if d < 0:
                d = -d
            if d > most:
                most = d
        i += 1
        a += c[_WORDS]
    s[_STRETCH] = 0
    while most and most < 0x4000000:
        most = most << 1
        s[_STRETCH] += 1


def lean(s: ptr32, c: ptr32, a: int, i: int):
    """Add estimator i to the weighted variance and covariance."""
    w = s[_WEIGHTS + i]
    if w == 0:
        return
    a += i * c[_WORDS] + _ESTIMATORS
    u = ((s[a + 1] - s[_FIRST_T_Q4]) << 6) - s[_SUM_T]
    u = u << s[_STRETCH]
    v = ((s[a + 2] - s[_FIRST_B_Q8]) << 3) - s[_SUM_B]
    v = scaled(u, v, 27)
    v = scaled(w, v, 27)
    s[_SUM_TB] += v
    u = scaled(u, u, 27)
    u = scaled(w, u, 27)
    s[_SUM_TT] += u


def settle(s: ptr32, c: ptr32, a: int):
    """Write the finished line into the axis block; no points leave it empty."""
    s[a + _FIT_POINTS] = s[_POINTS]
    s[a + _FIT_SAMPLES] = s[_SAMPLES]
    s[a + _FIT_T0_Q4] = s[_FIRST_T_Q4]
    s[a + _FIT_MEAN_T_Q10] = s[_SUM_T]
    s[a + _FIT_MEAN_B_Q11] = (s[_FIRST_B_Q8] << 3) + s[_SUM_B]
    s[a + _FIT_SLOPE_Q26] = ratio_q26(s[_SUM_TB], s[_SUM_TT])
    s[a + _FIT_SHIFT] = s[_STRETCH]
    s[a + _FIT_LOW_Q4] = s[_LOW_Q4]
    s[a + _FIT_HIGH_Q4] = s[_HIGH_Q4]


def line_q8(s: ptr32, a: int, temp_q4: int) -> int:
    """Return the line's bias at `temp_q4`: LSB, Q8; far outside it is held where 28 bits end."""
    u = ((temp_q4 - s[a + _FIT_T0_Q4]) << 6) - s[a + _FIT_MEAN_T_Q10]
    most = 0xFFFFFFF >> s[a + _FIT_SHIFT]
    if u > most:
        u = most
    if u < -most:
        u = -most
    u = scaled(s[a + _FIT_SLOPE_Q26], u << s[a + _FIT_SHIFT], 26)
    return (s[a + _FIT_MEAN_B_Q11] + u + 4) >> 3
