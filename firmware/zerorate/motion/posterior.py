"""What is published of a bias found in motion: the posterior mean under a prior.

Windows alone leave one sigma of 1 dps or more where hardly any turned out of the vertical or all
turned on. Before them most parts are within half a dps, and few at 20: a prior with Cauchy's
tails about no bias. It is a mixture of normal ones: where the bias is b, of the variance
(usual^2 + b^2) / 2. A few rounds from no bias on find both. What the filter knows stays free of it.
"""

from ..arithmetic.real import add, copy, divide, multiply, put, root_of, whole
from .least_squares import place, spread_prior
from .regression import mean
from .thermal import present, variance_at

# layout: names that a board's own compiler reads
const = int
ptr32 = None
# layout: The state of the source in motion
_MOTION_BIAS_Q8 = const(71)
_MOTION_QUALITY_Q8 = const(74)
_SLOPE = const(185)
_T = const(203)
_T1 = const(205)
_T2 = const(207)
_MISFIT_Q16 = const(241)
_TURN_SUM = const(245)
_TURN_MEAN = const(248)
_G = const(33)
# layout: The settings of the source in motion
_LSB_A_UNIT = const(10)
_MOTION_DOCUMENT = const(20)
_MATRIX_ERROR = const(27)
_USUAL = const(29)
# layout: end


def know_prior(s: ptr32):
    """Begin with no bias: the posterior mean stands where the slopes stood."""
    for i in range(0, 6, 2):
        put(s, _SLOPE + i, 0, 0)


def usual_variance(s: ptr32, c: ptr32, a: int):
    """Store at _T the prior's variance where the bias is the number at a."""
    multiply(s, _T, a, a)
    put(s, _T1, c[_USUAL], c[_USUAL + 1])
    add(s, _T, _T, _T1)
    put(s, _T, s[_T], s[_T + 1] - 1)


def follow_turn(s: ptr32, i: int):
    """Follow the mean turn of the windows by what each of them taught of axis i's bias."""
    a = variance_at(i)
    add(s, _T, a, place(i, i))  # less the variance that the window leaves
    divide(s, _T, _T, a)
    a = whole(s, _T, 14)
    follow_component(s, i, 0, a)
    follow_component(s, i, 1, a)
    follow_component(s, i, 2, a)


def follow_component(s: ptr32, i: int, k: int, gain: int):
    """Move component k of axis i's mean turn towards the window's by a gain, Q14."""
    a = _TURN_MEAN + 3 * i + k
    turn = mean(s, s[_TURN_SUM + k]) - s[a]
    s[a] += (gain * turn + 0x2000) >> 14


def filter_variance(s: ptr32, c: ptr32, i: int):
    """Store at _T1 the variance of axis i: the filter's, and what no number of windows removes."""
    # Scale and axes are the same in every window, so their error stays with the mean turn.
    square = 0
    for a in range(_TURN_MEAN + 3 * i, _TURN_MEAN + 3 * i + 3):
        square += s[a] * s[a]
    put(s, _T2, square, 22)
    put(s, _T1, c[_MATRIX_ERROR], c[_MATRIX_ERROR + 1])
    multiply(s, _T2, _T2, _T1)
    put(s, _T1, s[_MISFIT_Q16], -14)
    multiply(s, _T1, _T1, variance_at(i))
    add(s, _T1, _T1, _T2)


def weigh_prior(s: ptr32, c: ptr32):
    """Put the variances of filter and prior into the matrix, and the filter's bias beside them."""
    spread_prior(s)
    put(s, _T, s[_MISFIT_Q16], -14)
    for i in range(0, 18, 2):
        multiply(s, _G + i, _G + i, _T)
    for i in range(3):
        d = place(i, i)
        filter_variance(s, c, i)
        copy(s, d, _T1, 2)
        usual_variance(s, c, _SLOPE + 2 * i)
        add(s, d, d, _T)
        d = place(i, 3)
        present(s, i)
        copy(s, d, _T1, 2)


def shrink(s: ptr32, c: ptr32):
    """Take the solution of the swept matrix, times the prior's variances, as the mean."""
    for i in range(3):
        usual_variance(s, c, _SLOPE + 2 * i)
        multiply(s, _SLOPE + 2 * i, _T, place(i, 3))


def publish(s: ptr32, c: ptr32):
    """Write bias and one-sigma uncertainty of each axis, LSB in Q8."""
    for i in range(3):
        present(s, i)
        if c[_MOTION_DOCUMENT]:
            copy(s, _SLOPE + 2 * i, _T1, 2)
        spread(s, c, i)
        put(s, _T, c[_LSB_A_UNIT], c[_LSB_A_UNIT + 1])
        multiply(s, _T1, _SLOPE + 2 * i, _T)
        s[_MOTION_BIAS_Q8 + i] = whole(s, _T1, 0)
        multiply(s, _T1, _T2, _T)
        s[_MOTION_QUALITY_Q8 + i] = whole(s, _T1, 0)


def spread(s: ptr32, c: ptr32, i: int):
    """Store one sigma at _T2: the filter's and the prior's, where the bias is the number at _T1."""
    usual_variance(s, c, _T1)
    filter_variance(s, c, i)
    if c[_MOTION_DOCUMENT] == 0:
        add(s, _T2, _T1, _T)
        divide(s, _T2, _T1, _T2)
        multiply(s, _T1, _T2, _T)
    root_of(s, _T2, _T1)
