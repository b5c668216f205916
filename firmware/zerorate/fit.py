"""The sample-weighted least-squares line through an axis' estimators, in integers."""

# Document 000, "a least squares fit may be performed". `local` > 0 turns it into a line through
# the neighbourhood of one temperature: an estimator `d` away counts 1 / (1 + (d/local)^2) of its
# samples, and samples beyond `_COUNTED` add nothing, for then drift, not noise, is what is left.
# At a slow rate all are scaled up, so that a few samples still tell near from far.
#
# Temperatures are raw LSB in Q4, biases LSB in Q8. Distances over temperature are
# shifted left until the range fills 26 bits; the two sums of products float, for a point may weigh
# 65000 times another.

try:
    from micropython import const
except ImportError:

    def const(value):
        return value


ptr32 = None


from .fixed import floating_ratio_q26, fraction_q27, room, scaled

_FREE = const(-1048576)

_FIT_T0_Q4 = const(14)
_FIT_MEAN_T = const(15)
_FIT_MEAN_B_Q11 = const(16)
_FIT_SLOPE_Q26 = const(17)
_FIT_SHIFT = const(18)
_FIT_LOW_Q4 = const(19)
_FIT_HIGH_Q4 = const(20)
_FIT_SAMPLES = const(21)
_FIT_POINTS = const(22)
_ESTIMATORS = const(32)

_TEMP = const(47)
_SUM_T = const(80)
_SUM_B = const(81)
_SUM_TT = const(82)  # and by how much it is shifted left
_SUM_TB = const(84)  # and by how much it is shifted left
_FIRST_T_Q4 = const(86)
_FIRST_B_Q8 = const(87)
_LOW_Q4 = const(88)
_HIGH_Q4 = const(89)
_SAMPLES = const(90)
_POINTS = const(91)
_WEIGHTS = const(92)  # one word an estimator, the axes follow
_SUM_W = const(92)  # in the place of the first, which has no temperature

_FIRST_SHORT = const(14)
_END = const(15)
_ALL = const(25)
_WORDS = const(26)
_ENOUGH = const(31)
_COUNTED = const(32)
_LOCAL = const(33)
_LOCAL_SHIFT = const(42)
_NEAR = const(51)


def weigh(s: ptr32, c: ptr32, a: int):
    """Weigh the estimators that have enough samples, for a line that serves this temperature."""
    w = _SUM_T
    while w <= _SUM_W:
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
                w = (w * c[_NEAR]) // (c[_LOCAL] + d * d) + 1
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


def stretch(s: ptr32) -> int:
    """Return the shift that makes the range of temperatures fill 26 bits."""
    w = s[_HIGH_Q4] - s[_LOW_Q4]
    w = room(w)
    return w - 1


def within(s: ptr32, t: int) -> int:
    """Return `t` held in the range that was weighed: readings learned since may have moved it."""
    if t < s[_LOW_Q4]:
        return s[_LOW_Q4]
    if t > s[_HIGH_Q4]:
        return s[_HIGH_Q4]
    return t


def centre(s: ptr32, c: ptr32, a: int, i: int):
    """Add estimator i to the weighted means."""
    w = s[_WEIGHTS + i]
    if w == 0:
        return
    d = s[_SUM_W]
    w = fraction_q27(w, d)
    a += i * c[_WORDS] + _ESTIMATORS
    d = s[a + 1]
    d = within(s, d) - s[_FIRST_T_Q4]
    d = d << stretch(s)
    d = scaled(w, d, 27)
    s[_SUM_T] += d
    d = s[a + 2] - s[_FIRST_B_Q8]
    d = scaled(w, d << 3, 27)
    s[_SUM_B] += d


def add_product(s: ptr32, k: int, p: int, r: int):  # inline
    """Add p * r, each below 2^27, to the floating sum at the word in k's low 7 bits.

    The sum is mantissa and shift; by how much p is shifted already stands above those bits.
    """
    h = k >> 7
    k = k & 127
    if p == 0 or r == 0:
        return
    i = room(r)
    p = scaled(p, r << i, 27)
    h += i - 2
    i = room(p)
    p = p << i >> 2
    h += i
    if s[k] == 0:
        s[k + 1] = h
    i = h - s[k + 1]
    if i >= 0:
        p = p >> (i if i < 30 else 30)
    else:
        s[k] = s[k] >> (0 - i if i > -30 else 30)
        s[k + 1] = h
    s[k] += p


def lean(s: ptr32, c: ptr32, a: int, i: int):  # call
    """Add estimator i to the weighted variance and covariance."""
    w = s[_WEIGHTS + i]
    a += i * c[_WORDS] + _ESTIMATORS
    i = s[a + 1]
    i = within(s, i) - s[_FIRST_T_Q4]
    i = (i << stretch(s)) - s[_SUM_T]
    a = ((s[a + 2] - s[_FIRST_B_Q8]) << 3) - s[_SUM_B]
    k = room(w)
    w = scaled(w << k, i << room(i), 27)
    k = ((k + room(i)) << 7) + _SUM_TT
    add_product(s, k, w, i)
    add_product(s, k + _SUM_TB - _SUM_TT, w, a)


def settle(s: ptr32, c: ptr32, a: int):
    """Write the finished line into the axis block; no points leave it empty."""
    s[a + _FIT_POINTS] = s[_POINTS]
    s[a + _FIT_SAMPLES] = s[_SAMPLES]
    s[a + _FIT_T0_Q4] = s[_FIRST_T_Q4]
    s[a + _FIT_MEAN_T] = s[_SUM_T]
    s[a + _FIT_MEAN_B_Q11] = (s[_FIRST_B_Q8] << 3) + s[_SUM_B]
    slope = s[_SUM_TT + 1] - s[_SUM_TB + 1]
    slope = floating_ratio_q26(s[_SUM_TB], s[_SUM_TT], slope)
    s[a + _FIT_SLOPE_Q26] = slope
    s[a + _FIT_SHIFT] = stretch(s)
    s[a + _FIT_LOW_Q4] = s[_LOW_Q4]
    s[a + _FIT_HIGH_Q4] = s[_HIGH_Q4]


def draw_line(s: ptr32, c: ptr32, a: int):
    """Fit the axis' line through its estimators."""
    weigh(s, c, a)
    i = 1
    while i < c[_ALL]:
        centre(s, c, a, i)
        i += 1
    i = 1
    while i < c[_ALL]:
        if s[_WEIGHTS + i]:
            lean(s, c, a, i)
        i += 1
    settle(s, c, a)


def line_q8(s: ptr32, a: int, temp_q4: int) -> int:
    """Return the line's bias at `temp_q4`: LSB, Q8; far outside it is held where 27 bits end."""
    u = temp_q4 - s[a + _FIT_T0_Q4]
    most = 0x7FFFFFF >> s[a + _FIT_SHIFT]
    if u > most:
        u = most
    if u < 0 - most:
        u = 0 - most
    u = (u << s[a + _FIT_SHIFT]) - s[a + _FIT_MEAN_T]
    u = scaled(s[a + _FIT_SLOPE_Q26], u, 26)
    return (s[a + _FIT_MEAN_B_Q11] + u + 4) >> 3
