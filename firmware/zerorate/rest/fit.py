"""The sample-weighted least-squares line through an axis' estimators, in integers."""

# US 9,354,080, "a least squares fit may be performed". `local` > 0 turns it into a line through
# the neighbourhood of one temperature: an estimator `d` away counts 1 / (1 + (d/local)^2) of its
# samples, and samples beyond `_MOST_COUNTED` add nothing, for then drift, not noise, is what is
# left. At a slow rate all are scaled up, so that a few samples still tell near from far.
#
# Temperatures are raw LSB in Q4, biases LSB in Q8. Distances over temperature are
# shifted left until the range fills 26 bits; the two sums of products float, for a point may weigh
# 65000 times another.

from ..arithmetic.fixed import clipped, floating_ratio_q26, fraction_q27, room, scaled

# layout: names that a board's own compiler reads
const = int
ptr32 = None
# layout: The corrector's state
_TEMP = const(22)
_FIT_SUM_T = const(26)
_FIT_SUM_B_Q11 = const(27)
_FIT_SUM_TT = const(28)
_FIT_SUM_TB = const(30)
_FIT_FIRST_T_Q4 = const(32)
_FIT_FIRST_B_Q8 = const(33)
_FIT_LOW_Q4 = const(34)
_FIT_HIGH_Q4 = const(35)
_FIT_SAMPLES = const(36)
_FIT_POINTS = const(37)
_FIT_WEIGHTS = const(103)
_BEND_SQUARE_Q14 = const(26)
_BEND_CUBE_Q14 = const(27)
_BEND_NORM_Q18 = const(28)
_BEND_DOT_Q12 = const(29)
_BEND_LEFT_Q6 = const(30)
_FIT_SUM_W = const(103)
# layout: An axis
_LINE_T0_Q4 = const(14)
_LINE_MEAN_T = const(15)
_LINE_MEAN_B_Q11 = const(16)
_LINE_SLOPE_Q26 = const(17)
_LINE_SHIFT = const(18)
_LINE_LOW_Q4 = const(19)
_LINE_HIGH_Q4 = const(20)
_LINE_SAMPLES = const(21)
_LINE_POINTS = const(22)
_PARABOLA_Q6 = const(23)
_PARABOLA_MEAN_Q14 = const(24)
_PARABOLA_SKEW_Q14 = const(25)
_ESTIMATORS = const(40)
# layout: An estimator
_EST_TEMP = const(0)
_EST_MEAN_TEMP_Q4 = const(1)
_EST_BIAS_Q8 = const(2)
_EST_READINGS = const(3)
# layout: The corrector's settings
_FIRST_SHORT = const(16)
_ESTIMATORS_END = const(17)
_LITERAL = const(23)
_ESTIMATOR_COUNT = const(27)
_ESTIMATOR_WORDS = const(28)
_ENOUGH_TO_FIT = const(33)
_MOST_COUNTED = const(34)
_LOCAL = const(35)
_LOCAL_SHIFT = const(44)
_NEAR = const(53)
# layout: Values that stand for none
_FREE = const(-0x100000)
# layout: end
_POINTS_OF_A_BEND = const(5)


def weigh(s: ptr32, c: ptr32, a: int):
    """Weigh the estimators that have enough samples, for a line that serves this temperature."""
    w = _FIT_SUM_T
    while w <= _FIT_POINTS:
        s[w] = 0
        w += 1
    s[_FIT_SUM_W] = 0
    i = _FIT_WEIGHTS + 1
    e = a + c[_FIRST_SHORT]
    while e < a + c[_ESTIMATORS_END]:
        w = 0
        if s[e + _EST_TEMP] != _FREE and s[e + _EST_READINGS] >= c[_ENOUGH_TO_FIT]:
            w = s[e + _EST_READINGS]
            s[_FIT_SAMPLES] += w
            if w > c[_MOST_COUNTED]:
                w = c[_MOST_COUNTED]
            if c[_LOCAL]:
                d = (s[e + _EST_MEAN_TEMP_Q4] - (s[_TEMP] << 4)) >> c[_LOCAL_SHIFT]
                if d > 0x3FFF or d < -0x3FFF:
                    d = 0x3FFF
                w = (w * c[_NEAR]) // (c[_LOCAL] + d * d) + 1
            if s[_FIT_POINTS] == 0:
                s[_FIT_FIRST_T_Q4] = s[e + _EST_MEAN_TEMP_Q4]
                s[_FIT_FIRST_B_Q8] = s[e + _EST_BIAS_Q8]
                s[_FIT_LOW_Q4] = s[e + _EST_MEAN_TEMP_Q4]
                s[_FIT_HIGH_Q4] = s[e + _EST_MEAN_TEMP_Q4]
            if s[e + _EST_MEAN_TEMP_Q4] < s[_FIT_LOW_Q4]:
                s[_FIT_LOW_Q4] = s[e + _EST_MEAN_TEMP_Q4]
            if s[e + _EST_MEAN_TEMP_Q4] > s[_FIT_HIGH_Q4]:
                s[_FIT_HIGH_Q4] = s[e + _EST_MEAN_TEMP_Q4]
            s[_FIT_POINTS] += 1
        s[i] = w
        s[_FIT_SUM_W] += w
        i += 1
        e += c[_ESTIMATOR_WORDS]
    # the shift that makes the range of temperatures fill 26 bits
    s[a + _LINE_SHIFT] = room(s[_FIT_HIGH_Q4] - s[_FIT_LOW_Q4]) - 1


def within(s: ptr32, t: int) -> int:
    """Return `t` held in the range that was weighed: readings learned since may have moved it."""
    if t < s[_FIT_LOW_Q4]:
        return s[_FIT_LOW_Q4]
    if t > s[_FIT_HIGH_Q4]:
        return s[_FIT_HIGH_Q4]
    return t


def centre(s: ptr32, c: ptr32, a: int, i: int):
    """Add estimator i to the weighted means."""
    w = s[_FIT_WEIGHTS + i]
    if w == 0:
        return
    w = fraction_q27(w, s[_FIT_SUM_W])
    e = a + i * c[_ESTIMATOR_WORDS] + _ESTIMATORS
    d = s[e + _EST_MEAN_TEMP_Q4]
    d = within(s, d) - s[_FIT_FIRST_T_Q4]
    d = d << s[a + _LINE_SHIFT]
    d = scaled(w, d, 27)
    s[_FIT_SUM_T] += d
    d = s[e + _EST_BIAS_Q8] - s[_FIT_FIRST_B_Q8]
    d = scaled(w, d << 3, 27)
    s[_FIT_SUM_B_Q11] += d


def add_product(s: ptr32, k: int, p: int, r: int):
    """Add p * r, each below 2^27, to the floating sum at the word in k's low 7 bits."""
    # The sum is mantissa and shift; by how much p is shifted already stands above those bits.
    h = k >> 7
    at = k & 127
    if p == 0 or r == 0:
        return
    i = room(r)
    p = scaled(p, r << i, 27)  # eleven words: p is from here on the product
    h += i - 2
    i = room(p)
    p = p << i >> 2
    h += i
    if s[at] == 0:
        s[at + 1] = h
    i = h - s[at + 1]
    if i >= 0:
        p = p >> (i if i < 30 else 30)
    else:
        s[at] = s[at] >> (0 - i if i > -30 else 30)
        s[at + 1] = h
    s[at] += p


def add_covariance(s: ptr32, c: ptr32, a: int, i: int):
    """Add estimator i to the weighted variance and covariance."""
    w = s[_FIT_WEIGHTS + i]
    k = s[a + _LINE_SHIFT]
    # eleven words: a is from here on its first word, then its bias; i its temperature
    a += i * c[_ESTIMATOR_WORDS] + _ESTIMATORS
    i = s[a + _EST_MEAN_TEMP_Q4]
    i = within(s, i) - s[_FIT_FIRST_T_Q4]
    i = (i << k) - s[_FIT_SUM_T]
    a = ((s[a + _EST_BIAS_Q8] - s[_FIT_FIRST_B_Q8]) << 3) - s[_FIT_SUM_B_Q11]
    k = room(w)  # the shifts
    w <<= k
    k += room(i)
    w = scaled(w, i << room(i), 27)
    k = (k << 7) + _FIT_SUM_TT
    add_product(s, k, w, i)
    add_product(s, k + _FIT_SUM_TB - _FIT_SUM_TT, w, a)


def settle(s: ptr32, c: ptr32, a: int):
    """Write the finished line into the axis block; no points leave it empty."""
    s[a + _LINE_POINTS] = s[_FIT_POINTS]
    s[a + _LINE_SAMPLES] = s[_FIT_SAMPLES]
    s[a + _LINE_T0_Q4] = s[_FIT_FIRST_T_Q4]
    s[a + _LINE_MEAN_T] = s[_FIT_SUM_T]
    s[a + _LINE_MEAN_B_Q11] = (s[_FIT_FIRST_B_Q8] << 3) + s[_FIT_SUM_B_Q11]
    slope = s[_FIT_SUM_TT + 1] - s[_FIT_SUM_TB + 1]
    slope = floating_ratio_q26(s[_FIT_SUM_TB], s[_FIT_SUM_TT], slope)
    s[a + _LINE_SLOPE_Q26] = slope
    s[a + _LINE_LOW_Q4] = s[_FIT_LOW_Q4]
    s[a + _LINE_HIGH_Q4] = s[_FIT_HIGH_Q4]
    s[a + _PARABOLA_Q6] = 0


def along_q14(s: ptr32, a: int, t: int) -> int:
    """Return how far the temperature, Q4, is from the line's mean one, in ranges of its points."""
    off = t - s[a + _LINE_T0_Q4]
    return ((off << s[a + _LINE_SHIFT]) - s[a + _LINE_MEAN_T]) >> 12


def parabola_q14(s: ptr32, a: int, t: int) -> int:
    """Return the parabola that no line through the weighted points holds any of."""
    parabola = (t * t - s[a + _PARABOLA_SKEW_Q14] * t >> 14) - s[a + _PARABOLA_MEAN_Q14]
    return clipped(parabola, 0x7FFF)


def share_q13(s: ptr32, i: int) -> int:
    """Return the weight of estimator i, of less than 2^14 where lines are bent, among all."""
    w = s[_FIT_WEIGHTS + i]
    return (w << 13) // s[_FIT_SUM_W] if w else 0


def add_moments(s: ptr32, c: ptr32, a: int, i: int):
    """Add estimator i to the weighted mean square and cube of `along_q14`."""
    w = share_q13(s, i)
    if w == 0:
        return
    # eleven words: i is from here on its temperature, then how far along the line that is
    i = s[a + i * c[_ESTIMATOR_WORDS] + _ESTIMATORS + _EST_MEAN_TEMP_Q4]
    i = along_q14(s, a, within(s, i))
    s[_BEND_SQUARE_Q14] += ((i * i >> 12) * w + 0x4000) >> 15
    s[_BEND_CUBE_Q14] += ((i * i >> 13) * i >> 13) * w + 0x2000 >> 15


def add_parabola(s: ptr32, c: ptr32, a: int, i: int):
    """Add estimator i to the squares of parabola and remainder, and to their product."""
    w = share_q13(s, i)
    if w == 0:
        return
    # eleven words: i is from here on its first word, then its temperature, then its parabola
    i = a + i * c[_ESTIMATOR_WORDS] + _ESTIMATORS
    left = s[i + _EST_BIAS_Q8]
    i = within(s, s[i + _EST_MEAN_TEMP_Q4])
    left = (left - line_q8(s, a, i) + 2) >> 2
    left = clipped(left, 0x1FFF)  # LSB, Q6
    i = along_q14(s, a, i)
    i = parabola_q14(s, a, i)
    i = clipped(i, 0x3FFF)
    s[_BEND_NORM_Q18] += ((i * i >> 11) * w + 0x800) >> 12
    s[_BEND_DOT_Q12] += ((i * left >> 10) * w + 0x400) >> 11
    s[_BEND_LEFT_Q6] += ((left * left >> 10) * w + 0x100) >> 9


def significant(s: ptr32, parabola: int) -> int:
    """Return the parabola, LSB Q6, less where it explains little more than it leaves."""
    # Of eight points that lie on a line a parabola takes a sixth of what noise there is.
    explained = (parabola * (clipped(s[_BEND_DOT_Q12], 0x1FFFF) >> 2)) >> 10
    noise = s[_BEND_LEFT_Q6] - explained
    if noise <= 0:
        return parabola
    if noise >= explained:
        return 0
    return parabola * (((explained - noise) << 9) // explained) >> 9


def bend(s: ptr32, c: ptr32, a: int):
    """Bend the line just drawn where five estimators tell how, less where they tell little."""
    # Its weights stand, whatever was learned since they were taken.
    if s[a + _LINE_POINTS] < _POINTS_OF_A_BEND:
        return
    s[_BEND_SQUARE_Q14] = 0
    s[_BEND_CUBE_Q14] = 0
    s[_BEND_NORM_Q18] = 1
    s[_BEND_DOT_Q12] = 0
    s[_BEND_LEFT_Q6] = 0
    for i in range(1, c[_ESTIMATOR_COUNT]):
        add_moments(s, c, a, i)
    s[a + _PARABOLA_MEAN_Q14] = s[_BEND_SQUARE_Q14]
    s[a + _PARABOLA_SKEW_Q14] = (s[_BEND_CUBE_Q14] << 14) // (s[_BEND_SQUARE_Q14] + 1)
    for i in range(1, c[_ESTIMATOR_COUNT]):
        add_parabola(s, c, a, i)
    i = (clipped(s[_BEND_DOT_Q12], 0x1FFFF) << 12) // s[_BEND_NORM_Q18]
    i = clipped(i, 0x7FFF)
    s[a + _PARABOLA_Q6] = i if c[_LITERAL] else significant(s, i)


def bent_q8(s: ptr32, a: int, t: int) -> int:
    """Return what the bend adds to the line at `t`, Q4; farther out than a quarter it is held."""
    if s[a + _PARABOLA_Q6] == 0:
        return 0
    margin = (s[a + _LINE_HIGH_Q4] - s[a + _LINE_LOW_Q4]) >> 2
    at = t
    if at > s[a + _LINE_HIGH_Q4] + margin:
        at = s[a + _LINE_HIGH_Q4] + margin
    if at < s[a + _LINE_LOW_Q4] - margin:
        at = s[a + _LINE_LOW_Q4] - margin
    at = along_q14(s, a, at)
    return parabola_q14(s, a, at) * s[a + _PARABOLA_Q6] >> 12


def draw_line(s: ptr32, c: ptr32, a: int):
    """Fit the axis' line through its estimators, straight until `bend` is called."""
    weigh(s, c, a)
    for i in range(1, c[_ESTIMATOR_COUNT]):
        centre(s, c, a, i)
    for i in range(1, c[_ESTIMATOR_COUNT]):
        if s[_FIT_WEIGHTS + i]:
            add_covariance(s, c, a, i)
    settle(s, c, a)


def line_q8(s: ptr32, a: int, temp_q4: int) -> int:
    """Return the line's bias at `temp_q4`: LSB, Q8; far outside it is held where 27 bits end."""
    u = temp_q4 - s[a + _LINE_T0_Q4]
    u = clipped(u, 0x7FFFFFF >> s[a + _LINE_SHIFT])
    u = (u << s[a + _LINE_SHIFT]) - s[a + _LINE_MEAN_T]
    u = scaled(s[a + _LINE_SLOPE_Q26], u, 26)
    return (s[a + _LINE_MEAN_B_Q11] + u + 4) >> 3
