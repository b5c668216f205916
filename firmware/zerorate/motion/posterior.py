"""What is published of a bias found in motion: the posterior mean under a prior.

Windows alone leave one sigma of 1 dps or more where hardly any turned out of the vertical or all
turned on. Before them most parts are within half a dps, and few at 20: a prior with Cauchy's
tails about no bias. It is a mixture of normal ones: where the bias is b, of the variance
(usual^2 + b^2) / 2. A few rounds from no bias on find both. What the filter knows stays free of it.
"""

from ..arithmetic.real import add, copy, divide, multiply, put, root_of, unpack, whole
from .least_squares import known, place
from .thermal import present

# layout: names that a board's own compiler reads
const = int
ptr32 = None
# layout: The state of the source in motion
_MOTION_BIAS_Q8 = const(73)
_MOTION_QUALITY_Q8 = const(76)
_MEAN = const(375)
_PUSH = const(393)
_SLOPE = const(410)
_T = const(416)
_T1 = const(418)
_T2 = const(420)
_T3 = const(422)
# layout: The settings of the source in motion
_LSB_A_UNIT = const(10)
_MOTION_DOCUMENT = const(20)
_USUAL = const(32)
# layout: end


def know_prior(s: ptr32):
    """Begin with no bias."""
    for i in range(0, 6, 2):
        put(s, _SLOPE + i, 0, 0)


def usual_variance(s: ptr32, c: ptr32, a: int):
    """Store at _T the prior's variance where the bias is the number at a."""
    multiply(s, _T, a, a)
    put(s, _T1, c[_USUAL], c[_USUAL + 1])
    add(s, _T, _T, _T1)
    put(s, _T, s[_T], s[_T + 1] - 1)


def variance(s: ptr32, i: int, j: int):
    """Store at _T1 the covariance of the biases of axes i and j."""
    unpack(s, _T1, known(i, j))
    multiply(s, _T1, _T1, _PUSH)


def weigh_prior(s: ptr32, c: ptr32):
    """Put the variances of filter and prior into the matrix, and beside them the bias."""
    put(s, place(3, 3), 0, 0)
    for i in range(3):
        for j in range(i, 3):
            variance(s, i, j)
            copy(s, place(i, j), _T1, 2)
        usual_variance(s, c, _SLOPE + 2 * i)
        add(s, place(i, i), place(i, i), _T)
        unpack(s, place(i, 3), _MEAN + i)


def shrink(s: ptr32, c: ptr32):
    """Take the solution of the swept matrix, times the prior's variances, as the mean."""
    for i in range(3):
        usual_variance(s, c, _SLOPE + 2 * i)
        multiply(s, _SLOPE + 2 * i, _T, place(i, 3))


def publish(s: ptr32, c: ptr32):
    """Write bias and one-sigma uncertainty of each axis, LSB in Q8."""
    for i in range(3):
        spread(s, c, i)
        present(s, i)
        put(s, _T, c[_LSB_A_UNIT], c[_LSB_A_UNIT + 1])
        multiply(s, _T1, _T1, _T)
        s[_MOTION_BIAS_Q8 + i] = whole(s, _T1, 0)
        multiply(s, _T1, _T3, _T)
        s[_MOTION_QUALITY_Q8 + i] = whole(s, _T1, 0)


def spread(s: ptr32, c: ptr32, i: int):
    """Store axis i's one sigma at _T3: the filter's and the prior's."""
    unpack(s, _T1, _MEAN + i)
    usual_variance(s, c, _T1)
    variance(s, i, i)
    if c[_MOTION_DOCUMENT] == 0:
        add(s, _T2, _T1, _T)
        divide(s, _T2, _T1, _T2)
        multiply(s, _T1, _T2, _T)
    root_of(s, _T3, _T1)
