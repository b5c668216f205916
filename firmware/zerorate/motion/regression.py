"""Sums of a weighted straight-line fit of orientation against the turns of a bias.

US 10,451,438: "performing a linear fit of the orientation ... as the function of time". A bias b
moves the orientation by M(t) b, M the integral of the rotation matrix; where the device keeps its
attitude on average that is a straight line in time. Two tilts come from the accelerometer's
gravity in the tilt frame, the heading from the turn about it. The window is tapered by
1 - t^4, so that unfinished cycles at its ends count little; what remains at the neighbouring shapes
21/5 t^2 - 1 and 15/7 t^3 - t (orthogonal under that taper) measures the noise the slope has.

Sums of one component, 21 words: 6 of M M', 3 of M y, 3 of M, 1 of y, 3 + 3 of M and 1 + 1 of y
with the two shapes.
"""

from ..arithmetic.fixed import scaled

# layout: names that a board's own compiler reads
const = int
ptr32 = None
# layout: The state of the source in motion
_TAPER_SUM = const(18)
_TAPER = const(60)
_SHAPE_2 = const(61)
_SHAPE_3 = const(62)
_CENTRE = const(214)
_VERTICAL = const(242)
_M = const(203)
_WM = const(206)
# layout: The sums of one component
_SUM_MY = const(6)
_SUM_M = const(9)
_SUM_Y = const(12)
_SHAPES_M = const(13)
_SHAPES_Y = const(19)
# layout: end


def taper(s: ptr32, k: int, stage: int, even: int):
    """Write the weight and the two shapes times the taper of node k of 2^stage, Q10."""
    # even: the weight itself is 1, as in the document; the shapes stay tapered.
    t = (2 * k + 1 - (1 << stage)) << (10 - stage)
    square = (t * t) >> 10
    weight = 1024 - (square * square >> 10)
    s[_SHAPE_2] = ((21 * square // 5 - 1024) * weight) >> 10
    s[_SHAPE_3] = ((((15 * square // 7 - 1024) * t) >> 10) * weight) >> 10
    if even:
        weight = 1024
    s[_TAPER] = weight
    s[_TAPER_SUM] += weight


def regressors(s: ptr32, row: int, shift: int):
    """Write a row of M to scratch words."""
    for i in range(3):
        s[_M + i] = (s[row + i] + (1 << (shift - 1))) >> shift


def look_past_vertical(s: ptr32):
    """Take from the row of M what a bias about the vertical would turn."""
    # That becomes a tilt by the swing alone, and so does what the swing does to the force: where
    # tilts are quiet and the heading is not, they would tell the heading's bias, and wrongly.
    part = s[_M] * s[_VERTICAL] + s[_M + 1] * s[_VERTICAL + 1]
    part = (part + s[_M + 2] * s[_VERTICAL + 2] + 0x2000) >> 14
    for i in range(3):
        s[_M + i] -= (part * s[_VERTICAL + i] + 0x2000) >> 14


def first_sums(s: ptr32, a: int, y: int):
    """Add a node to the sums at a that are linear in M and y, y in Q12 within 15 bits."""
    i = 0
    while i < 3:
        s[_WM + i] = (s[_TAPER] * s[_M + i] + 512) >> 10
        s[a + _SUM_MY + i] += (s[_WM + i] * y + 512) >> 10
        s[a + _SUM_M + i] += s[_WM + i]
        s[a + _SHAPES_M + i] += (s[_SHAPE_2] * s[_M + i] + 512) >> 10
        s[a + _SHAPES_M + 3 + i] += (s[_SHAPE_3] * s[_M + i] + 512) >> 10
        i += 1
    s[a + _SUM_Y] += (s[_TAPER] * y + 512) >> 10
    s[a + _SHAPES_Y] += (s[_SHAPE_2] * y + 512) >> 10
    s[a + _SHAPES_Y + 1] += (s[_SHAPE_3] * y + 512) >> 10


def second_sums(s: ptr32, a: int):
    """Add a node to the six sums at a that are square in M."""
    at = a
    i = 0
    while i < 3:
        k = i
        while k < 3:
            d = (s[_WM + i] * s[_M + k] + 512) >> 10
            s[at] += d
            at += 1
            k += 1
        i += 1


def mean(s: ptr32, total: int) -> int:
    """Return the weighted mean whose weighted sum is `total`, of 21 bits."""
    return (total << 8) // (s[_TAPER_SUM] >> 2)


def refer(s: ptr32, d: int, a: int, mean: int):
    """Take (the word at a times mean) >> 10 from the word at d."""
    taken = scaled(s[a] << 5, mean, 15)
    s[d] -= taken


def centre(s: ptr32, a: int, row: int, shift: int):
    """Refer the sums at a to the weighted means, and the next traversal's M to its mean."""
    # The mean of y replaces its sum. The row of the matrix at _CENTRE is where M begins.
    s[a + _SUM_Y] = mean(s, s[a + _SUM_Y])
    i = 0
    while i < 3:
        s[_M + i] = mean(s, s[a + _SUM_M + i])
        s[_CENTRE + row + i] -= s[_M + i] << shift
        i += 1
    i = 0
    row = a  # eleven words: row is from here on the square sums' word, shift that of a sum of M
    s[_WM] = s[a + _SUM_Y]
    while i < 3:
        shift = a + _SUM_M + i
        refer(s, shift - 3, shift, s[_WM])
        row = centre_row(s, shift, row, i)
        i += 1


def centre_row(s: ptr32, a: int, h: int, k: int) -> int:
    """Refer a row of the square sums, from word h on, to the means; return where the next is."""
    while k < 3:
        refer(s, h, a, s[_M + k])
        h += 1  # eleven words: h and k go on through the row
        k += 1
    return h
