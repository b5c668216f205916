"""Sums of a weighted straight-line fit of orientation against the turns of a bias.

Document 002: "performing a linear fit of the orientation ... as the function of time". A bias b
moves the orientation by M(t) b, M the integral of the rotation matrix; where the device keeps its
attitude on average that is a straight line in time. Two tilts come from the accelerometer's
gravity in the level frame, the heading from the turn about it. The window is tapered by
(1 - t^2)^2, so that unfinished cycles at its ends count little; what remains at the neighbouring
shapes 7 t^2 - 1 and 3 t^3 - t (orthogonal under that taper) measures the noise the slope has.

Sums of one component, 21 words: 6 of M M', 3 of M y, 3 of M, 1 of y, 3 + 3 of M and 1 + 1 of y
with the two shapes.
"""

try:
    from micropython import const
except ImportError:

    def const(value):
        return value


ptr32 = None


from .fixed import scaled

_TOTAL = const(18)
_SUM_R = const(42)
_WEIGHT = const(60)
_SECOND = const(61)
_THIRD = const(62)
_M = const(222)
_WM = const(225)
_CENTRE = const(230)

_S = const(6)
_A = const(9)
_MEAN = const(12)
_SHAPES_M = const(13)
_SHAPES_Y = const(19)


def taper(s: ptr32, k: int, stage: int):
    """Write the weight and the two shapes times the weight of node k of 2^stage, Q10."""
    t = (2 * k + 1 - (1 << stage)) << (10 - stage)
    square = (t * t) >> 10
    weight = ((1024 - square) * (1024 - square)) >> 10
    s[_WEIGHT] = weight
    s[_SECOND] = ((7 * square - 1024) * weight) >> 10
    s[_THIRD] = ((((3 * square - 1024) * t) >> 10) * weight) >> 10
    s[_TOTAL] += weight


def regressors(s: ptr32, row: int, shift: int):
    """Write a row of M and the weight times it to scratch words."""
    i = 0
    while i < 3:
        m = (s[row + i] + (1 << (shift - 1))) >> shift
        s[_M + i] = m
        s[_WM + i] = (s[_WEIGHT] * m + 512) >> 10
        i += 1


def first_sums(s: ptr32, a: int, y: int):
    """Add a node to the sums at a that are linear in M and y, y in Q12 within 15 bits."""
    i = 0
    while i < 3:
        s[a + _S + i] += (s[_WM + i] * y + 512) >> 10
        s[a + _A + i] += s[_WM + i]
        s[a + _SHAPES_M + i] += (s[_SECOND] * s[_M + i] + 512) >> 10
        s[a + _SHAPES_M + 3 + i] += (s[_THIRD] * s[_M + i] + 512) >> 10
        i += 1
    s[a + _MEAN] += (s[_WEIGHT] * y + 512) >> 10
    s[a + _SHAPES_Y] += (s[_SECOND] * y + 512) >> 10
    s[a + _SHAPES_Y + 1] += (s[_THIRD] * y + 512) >> 10


def second_sums(s: ptr32, a: int):
    """Add a node to the six sums at a that are square in M."""
    i = 0
    while i < 3:
        k = i
        while k < 3:
            s[a] += (s[_WM + i] * s[_M + k] + 512) >> 10
            a += 1
            k += 1
        i += 1


def mean(s: ptr32, total: int) -> int:
    """Return the weighted mean whose weighted sum is `total`, of 21 bits."""
    return (total << 8) // (s[_TOTAL] >> 2)


def centre(s: ptr32, a: int, row: int, shift: int):
    """Refer the sums at a to the weighted means, and the next traversal's M to its mean.

    The mean of y replaces its sum. The row of the matrix at _CENTRE is where M begins.
    """
    y = int(mean(s, s[a + _MEAN]))
    s[a + _MEAN] = y
    h = a
    i = 0
    while i < 3:
        s[_M + i] = int(mean(s, s[a + _A + i]))
        s[_CENTRE + row + i] -= s[_M + i] << shift
        s[a + _S + i] -= int(scaled(s[a + _A + i] << 5, y, 15))
        i += 1
    i = 0
    while i < 3:
        h = int(centre_row(s, a, h, i))
        i += 1


def centre_row(s: ptr32, a: int, h: int, i: int) -> int:
    """Refer row i of the square sums at word h to the means; return where the next row is."""
    k = i
    while k < 3:
        s[h] -= int(scaled(s[a + _A + i] << 5, s[_M + k], 15))
        h += 1
        k += 1
    return h
