"""The window's normal equations: prior, weights, solution and its covariance.

Ten real numbers at _G: the upper triangle of a 3 x 3 matrix with a right-hand side as its fourth
column (00 01 02 0y 11 12 1y 22 2y yy). Bias in Q24 rad a node, orientation in Q12 rad.
"""

from ..arithmetic.real import add, copy, divide, multiply, put, subtract

# layout: names that a board's own compiler reads
const = int
ptr32 = None
# layout: The state of the source in motion
_STAGE = const(12)
_TAPER_SUM = const(18)
_SUMS = const(86)
_KNOWN_P = const(149)
_PRIOR = const(161)
_PRIOR_MEAN = const(173)
_BIAS = const(179)
_SLOPE = const(185)
_HELD_NOISE = const(191)
_OMEGA = const(197)
_T = const(203)
_T1 = const(205)
_T2 = const(207)
_T3 = const(209)
_NOISE_ENERGY = const(223)
_TURN_SUM = const(245)
_G = const(33)
# layout: The sums of one component
_SUM_MM = const(0)
_SUM_MY = const(6)
_SHAPES_M = const(13)
_SHAPES_Y = const(19)
_COMPONENT_WORDS = const(21)
# layout: The settings of the source in motion
_TILT_SPREAD = const(21)
_HEADING_SPREAD = const(22)
_MATRIX_ERROR = const(27)
# layout: end
# .005 and .01 rad, and .7 rad a window: beyond that a step is not linear
_FLOOR_TILT_Q24 = const(419)
_FLOOR_HEADING_Q24 = const(1678)
_LIMIT_Q24 = const(11744051)


def place(i: int, j: int) -> int:
    """Return the word of element i, j of the matrix at _G; i and j 0..3."""
    if i > j:
        return _G + 2 * (4 * j - ((j * (j + 1)) >> 1) + i)
    return _G + 2 * (4 * i - ((i * (i + 1)) >> 1) + j)


def element(s: ptr32, d: int, h: int, e: int):
    """Store at d the number at _T plus the sums of three components at word h, by their weights."""
    # e: the exponent of those sums.
    i = 0
    while i < 6:
        put(s, _T1, s[h], e)
        multiply(s, _T1, _T1, _OMEGA + i)
        add(s, _T, _T, _T1)
        h += _COMPONENT_WORDS  # eleven words: h goes on to the next component
        i += 2
    copy(s, d, _T, 2)


def matrix_element(s: ptr32, n: int):
    """Build element n of six of the matrix, in the order of the sums and the prior."""
    i = 0
    j = n
    while j > 2:
        i += 1
        j -= 3 - i
    j = place(i, j)
    copy(s, _T, _PRIOR + 2 * n, 2)
    element(s, j, _SUMS + _SUM_MM + n, 2 * s[_STAGE] - 42)


def right_side(s: ptr32, i: int):
    """Build the right-hand side's element i: the slopes, and the prior's pull to its mean."""
    d = place(i, 3)
    put(s, _T, 0, 0)
    element(s, d, _SUMS + _SUM_MY + i, s[_STAGE] - 16)
    j = 0
    while j < 3:
        subtract(s, _T1, _PRIOR_MEAN + 2 * j, _BIAS + 2 * j)
        multiply(s, _T1, _T1, prior_place(i, j))
        add(s, d, d, _T1)
        j += 1
    put(s, _G + 18, 0, 0)


def prior_place(i: int, j: int) -> int:
    """Return the word of element i, j of the prior's six numbers."""
    if i > j:
        return _PRIOR + 2 * (3 * j - ((j * (j + 1)) >> 1) + i)
    return _PRIOR + 2 * (3 * i - ((i * (i + 1)) >> 1) + j)


def sweep(s: ptr32, k: int):
    """Sweep the matrix on pivot k."""
    # After pivots 0, 1, 2 it holds the negative inverse and, in its fourth column, the solution
    # (Beaton's operator; stable for a positive definite matrix).
    d = place(k, k)
    put(s, _T, 1, 0)
    divide(s, _T, _T, d)
    for i in range(4):
        if i != k:
            sweep_row(s, k, i)
    for i in range(4):
        if i != k:
            d = place(i, k)
            multiply(s, d, d, _T)
    d = place(k, k)
    put(s, d, -s[_T], s[_T + 1])


def sweep_row(s: ptr32, k: int, i: int):
    """Take the pivot's row from row i, from the diagonal on; _T holds one over the pivot."""
    d = place(i, k)
    multiply(s, _T1, d, _T)
    for j in range(i, 4):
        if j != k:
            d = place(k, j)
            multiply(s, _T2, _T1, d)
            d = place(i, j)
            subtract(s, _T3, d, _T2)
            copy(s, d, _T3, 2)


def covariance(s: ptr32, d: int):
    """Store the negative of the six numbers of the swept matrix at d."""
    a = _G
    i = 0
    while i < 6:
        if i == 3 or i == 5:
            a += 2
        put(s, d + 2 * i, -s[a], s[a + 1])
        a += 2
        i += 1


def spread_prior(s: ptr32):
    """Put the covariance into the matrix."""
    d = _G
    for i in range(0, 20, 2):
        put(s, _G + i, 0, 0)
    for i in range(6):
        if i == 3 or i == 5:
            d += 2
        copy(s, d, _KNOWN_P + 2 * i, 2)
        d += 2


def less(s: ptr32, a: int, b: int) -> int:
    """Return 1 if the number at a is less than the one at b, else 0; uses _T3."""
    subtract(s, _T3, a, b)
    return 1 if s[_T3] < 0 else 0


def step(s: ptr32):
    """Take the solution as this pass' slope, no longer than the step that stays linear."""
    put(s, _T, _LIMIT_Q24, -s[_STAGE])
    copy(s, _T1, _T, 2)
    for i in range(3):
        d = place(i, 3)
        copy(s, _SLOPE + 2 * i, d, 2)
        put(s, _T2, s[d] if s[d] >= 0 else -s[d], s[d + 1])
        if less(s, _T1, _T2):
            copy(s, _T1, _T2, 2)
    divide(s, _T, _T, _T1)
    for i in range(0, 6, 2):
        multiply(s, _SLOPE + i, _SLOPE + i, _T)


def shape(s: ptr32, d: int, m: int, y: int):
    """Store at d the square of what _SLOPE leaves of a shape, with sums at m and y."""
    put(s, _T, s[y], 0)
    i = 0
    while i < 6:
        put(s, _T1, s[m], s[_STAGE] - 26)
        multiply(s, _T1, _T1, _SLOPE + i)
        subtract(s, _T2, _T, _T1)
        copy(s, _T, _T2, 2)
        m += 1  # eleven words: m goes on to the shape's next sum
        i += 2
    multiply(s, d, _T, _T)


def noise(s: ptr32, i: int):
    """Store component i's noise energy at the neighbouring shapes, with its floor, at _OMEGA."""
    # Mean squares of the shapes under the taper: .7684 and .0481 a node.
    a = _SUMS + _COMPONENT_WORDS * i
    d = _OMEGA + 2 * i
    shape(s, _T3, a + _SHAPES_M, a + _SHAPES_Y)
    put(s, _T, 10661, -14)
    multiply(s, d, _T3, _T)
    shape(s, _T3, a + _SHAPES_M + 3, a + _SHAPES_Y + 1)
    put(s, _T, 10642, -10)
    multiply(s, _T3, _T3, _T)
    add(s, _T3, _T3, d)
    put(s, _T3, s[_T3], s[_T3 + 1] - s[_STAGE])
    put(s, _T, _FLOOR_HEADING_Q24 if i == 2 else _FLOOR_TILT_Q24, 0)
    add(s, d, _T3, _T)


def weights(s: ptr32, c: ptr32):
    """Turn noise energies into weights: both tilts alike, none below what earlier windows had."""
    # The energies in use are left at _NOISE_ENERGY.
    add(s, _T, _OMEGA, _OMEGA + 2)
    put(s, _OMEGA, s[_T], s[_T + 1] - 1)
    copy(s, _OMEGA + 2, _OMEGA, 2)
    false_turn(s, c)
    for i in range(3):
        d = _OMEGA + 2 * i
        if less(s, d, _HELD_NOISE + 2 * i):
            copy(s, d, _HELD_NOISE + 2 * i, 2)
        copy(s, _NOISE_ENERGY + 2 * i, d, 2)
        weigh(s, c, i)


def false_turn(s: ptr32, c: ptr32):
    """Store at _T2 the variance of a bias that an error of scale and axes makes of the turning."""
    # Rates that come back leave none of it; the mean rate of the window all.
    put(s, _T2, 0, 0)
    for i in range(3):
        put(s, _T, s[_TURN_SUM + i], 21)
        multiply(s, _T, _T, _T)
        add(s, _T2, _T2, _T)
    put(s, _T, s[_TAPER_SUM], 0)
    multiply(s, _T, _T, _T)
    divide(s, _T2, _T2, _T)
    put(s, _T, c[_MATRIX_ERROR], c[_MATRIX_ERROR + 1])
    multiply(s, _T2, _T2, _T)


def own_squares(s: ptr32, i: int):
    """Store at _T the sum of squares of component i's three M."""
    k = 3
    square = 0
    a = _SUMS + _COMPONENT_WORDS * i
    while k > 0:
        square += s[a]
        a += k
        k -= 1
    a = 2 * s[_STAGE] - 42
    put(s, _T, square, a)


def weigh(s: ptr32, c: ptr32, i: int):
    """Replace component i's noise energy by the weight it gives beside the false turn at _T2."""
    own_squares(s, i)
    multiply(s, _T1, _T, _T2)
    put(s, _T, c[_HEADING_SPREAD] if i == 2 else c[_TILT_SPREAD], 0)
    multiply(s, _T, _T, _OMEGA + 2 * i)
    add(s, _T1, _T1, _T)
    put(s, _T, 1, 0)
    divide(s, _OMEGA + 2 * i, _T, _T1)


def held_weights(s: ptr32, c: ptr32):
    """Set the weights from the noise energies held from earlier windows."""
    put(s, _T2, 0, 0)
    for i in range(3):
        copy(s, _OMEGA + 2 * i, _HELD_NOISE + 2 * i, 2)
        weigh(s, c, i)


def own_square(s: ptr32, i: int):
    """Store the sum of squares of component i's own M at _T1; the sums are in order 00 .. 22."""
    a = _SUMS + (_COMPONENT_WORDS + 3) * i
    if i == 2:
        a -= 1
    put(s, _T1, s[a], 2 * s[_STAGE] - 42)


def own_slope(s: ptr32, i: int):
    """Store component i's own slope at _SLOPE, as US 10,451,438 takes it: no other axis."""
    own_square(s, i)
    put(s, _T, s[_SUMS + (_COMPONENT_WORDS + 1) * i + _SUM_MY], s[_STAGE] - 16)
    divide(s, _SLOPE + 2 * i, _T, _T1)


def own_variance(s: ptr32, c: ptr32, i: int):
    """Put the variance of component i's own slope on the matrix' diagonal, negative."""
    own_square(s, i)
    put(s, _T, -c[_TILT_SPREAD], 0)
    multiply(s, _T, _T, _OMEGA + 2 * i)
    d = place(i, i)
    divide(s, d, _T, _T1)
