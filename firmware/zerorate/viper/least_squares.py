# Generated from zerorate/least_squares.py by `make viper`: edit that file, not this one.
"""The window's normal equations: prior, weights, solution and its covariance.

Ten real numbers at _G: the upper triangle of a 3 x 3 matrix with a right-hand side as its fourth
column (00 01 02 0y 11 12 1y 22 2y yy). Bias in Q24 rad a node, orientation in Q12 rad.
"""

import micropython


try:
    from micropython import const
except ImportError:

    def const(value):
        return value


from .real import add, copy, divide, multiply, put, subtract

_STAGE = const(12)
_SUMS = const(85)
_G = const(148)
_P = const(168)
_PRIOR = const(180)
_PRIOR_MEAN = const(192)
_BIAS = const(198)
_D = const(204)
_HOLD = const(210)
_OMEGA = const(216)
_T = const(222)
_T1 = const(224)
_T2 = const(226)
_T3 = const(228)

_WALK = const(12)
_FLOOR_TILT = const(16)
_FLOOR_HEADING = const(18)
_SPREAD = const(25)
_LIMIT = const(26)


@micropython.viper
def place(i: int, j: int) -> int:
    """Return the word of element i, j of the matrix at _G; i and j 0..3."""
    if i > j:
        return _G + 2 * (4 * j - ((j * (j + 1)) >> 1) + i)
    return _G + 2 * (4 * i - ((i * (i + 1)) >> 1) + j)


@micropython.viper
def element(s_, d: int, prior: int, h: int, e: int):
    """Store at d the prior's number plus the sums of three components at word h, by their weights.

    e: the exponent of those sums.
    """
    s = ptr32(s_)
    if prior:
        copy(s_, _T, prior, 2)
    else:
        put(s_, _T, 0, 0)
    i = 0
    while i < 3:
        put(s_, _T1, s[h + 21 * i], e)
        multiply(s_, _T1, _T1, _OMEGA + 2 * i)
        add(s_, _T, _T, _T1)
        i += 1
    copy(s_, d, _T, 2)


@micropython.viper
def matrix_element(s_, n: int):
    """Build element n of six of the matrix, in the order of the sums and the prior."""
    s = ptr32(s_)
    i = 0
    j = n
    while j > 2:
        i += 1
        j -= 3 - i
    element(s_, int(int(place(i, j))), _PRIOR + 2 * n, _SUMS + n, 2 * (s[_STAGE] - 26 - 3 + 3) + 10)


@micropython.viper
def right_side(s_, i: int):
    """Build the right-hand side's element i: the slopes, and the prior's pull to its mean."""
    s = ptr32(s_)
    d = int(int(place(i, 3)))
    element(s_, d, 0, _SUMS + 6 + i, s[_STAGE] - 26 + 10)
    j = 0
    while j < 3:
        subtract(s_, _T1, _PRIOR_MEAN + 2 * j, _BIAS + 2 * j)
        multiply(s_, _T1, _T1, int(int(prior_place(i, j))))
        add(s_, d, d, _T1)
        j += 1
    put(s_, int(int(place(3, 3))), 0, 0)


@micropython.viper
def prior_place(i: int, j: int) -> int:
    """Return the word of element i, j of the prior's six numbers."""
    if i > j:
        return _PRIOR + 2 * (3 * j - ((j * (j + 1)) >> 1) + i)
    return _PRIOR + 2 * (3 * i - ((i * (i + 1)) >> 1) + j)


@micropython.viper
def sweep(s_, k: int):
    """Sweep the matrix on pivot k.

    After pivots 0, 1, 2 it holds the negative inverse and, in its fourth column, the solution
    (Beaton's operator; stable for a positive definite matrix).
    """
    s = ptr32(s_)
    put(s_, _T, 1, 0)
    divide(s_, _T, _T, int(int(place(k, k))))
    i = 0
    while i < 4:
        if i != k:
            sweep_row(s_, k, i)
        i += 1
    i = 0
    while i < 4:
        if i != k:
            multiply(s_, int(int(place(i, k))), int(int(place(i, k))), _T)
        i += 1
    put(s_, int(int(place(k, k))), -s[_T], s[_T + 1])


@micropython.viper
def sweep_row(s_, k: int, i: int):
    """Take the pivot's row from row i, from the diagonal on; _T holds one over the pivot."""
    multiply(s_, _T1, int(int(place(i, k))), _T)
    j = i
    while j < 4:
        if j != k:
            multiply(s_, _T2, _T1, int(int(place(k, j))))
            subtract(s_, _T3, int(int(place(i, j))), _T2)
            copy(s_, int(int(place(i, j))), _T3, 2)
        j += 1


@micropython.viper
def covariance(s_, d: int):
    """Store the negative of the six numbers of the swept matrix at d."""
    s = ptr32(s_)
    i = 0
    while i < 3:
        j = i
        while j < 3:
            put(s_, d, -s[int(int(place(i, j)))], s[int(int(place(i, j))) + 1])
            d += 2
            j += 1
        i += 1


@micropython.viper
def spread_prior(s_, c: ptr32, nodes: int):
    """Put the covariance, grown by the bias' random walk over so many nodes, into the matrix."""
    i = 0
    p = _P
    while i < 3:
        j = i
        while j < 3:
            copy(s_, int(int(place(i, j))), p, 2)
            p += 2
            j += 1
        put(s_, int(int(place(i, 3))), 0, 0)
        put(s_, _T, c[_WALK], c[_WALK + 1])
        put(s_, _T1, nodes, 0)
        multiply(s_, _T, _T, _T1)
        add(s_, int(int(place(i, i))), int(int(place(i, i))), _T)
        i += 1
    put(s_, int(int(place(3, 3))), 0, 0)


@micropython.viper
def magnitude(s_, a: int):
    """Make the number at a positive."""
    s = ptr32(s_)
    if s[a] < 0:
        put(s_, a, -s[a], s[a + 1])


@micropython.viper
def less(s_, a: int, b: int) -> int:
    """Return 1 if the number at a is less than the one at b, else 0; uses _T3."""
    s = ptr32(s_)
    subtract(s_, _T3, a, b)
    if s[_T3] < 0:
        return 1
    return 0


@micropython.viper
def step(s_, c: ptr32):
    """Take the solution as this pass' slope at _D, no longer than the step that stays linear."""
    s = ptr32(s_)
    i = 0
    put(s_, _T, c[_LIMIT], c[_LIMIT + 1] - s[_STAGE])
    copy(s_, _T1, _T, 2)
    while i < 3:
        copy(s_, _D + 2 * i, int(int(place(i, 3))), 2)
        copy(s_, _T2, _D + 2 * i, 2)
        magnitude(s_, _T2)
        if int(int(less(s_, _T1, _T2))):
            copy(s_, _T1, _T2, 2)
        i += 1
    divide(s_, _T, _T, _T1)
    i = 0
    while i < 6:
        multiply(s_, _D + i, _D + i, _T)
        i += 2


@micropython.viper
def shape(s_, d: int, m: int, y: int):
    """Store at d what the slope at _D leaves of a shape, whose sums are at m and y."""
    s = ptr32(s_)
    put(s_, _T, s[y], 0)
    i = 0
    while i < 3:
        put(s_, _T1, s[m + i], s[_STAGE] - 26)
        multiply(s_, _T1, _T1, _D + 2 * i)
        subtract(s_, _T2, _T, _T1)
        copy(s_, _T, _T2, 2)
        i += 1
    multiply(s_, d, _T, _T)


@micropython.viper
def noise(s_, c: ptr32, i: int):
    """Store component i's noise energy at the neighbouring shapes, with its floor, at _OMEGA.

    Mean squares of the shapes under the taper: .7111 and .0277 a node.
    """
    s = ptr32(s_)
    d = _OMEGA + 2 * i
    a = _SUMS + 21 * i
    shape(s_, d, a + 13, a + 19)
    put(s_, _T, 11520, -14 - s[_STAGE])
    multiply(s_, d, d, _T)
    shape(s_, _T3, a + 16, a + 20)
    put(s_, _T, 18482, -10 - s[_STAGE])
    multiply(s_, _T3, _T3, _T)
    add(s_, d, d, _T3)
    a = _FLOOR_TILT
    if i == 2:
        a = _FLOOR_HEADING
    put(s_, _T, c[a], c[a + 1])
    add(s_, d, d, _T)


@micropython.viper
def weights(s_, c_):
    """Turn noise energies into weights: both tilts alike, none below what earlier windows had.

    The energies in use are left at _G, as six words.
    """
    s = ptr32(s_)
    add(s_, _T, _OMEGA, _OMEGA + 2)
    put(s_, _OMEGA, s[_T], s[_T + 1] - 1)
    copy(s_, _OMEGA + 2, _OMEGA, 2)
    i = 0
    while i < 6:
        if int(int(less(s_, _OMEGA + i, _HOLD + i))):
            copy(s_, _OMEGA + i, _HOLD + i, 2)
        copy(s_, _G + i, _OMEGA + i, 2)
        weigh(s_, c_, _OMEGA + i)
        i += 2


@micropython.viper
def weigh(s_, c: ptr32, a: int):
    """Replace a noise energy by the weight it gives."""
    put(s_, _T, c[_SPREAD], 0)
    multiply(s_, _T1, _T, a)
    put(s_, _T, 1, 0)
    divide(s_, a, _T, _T1)


@micropython.viper
def held_weights(s_, c_):
    """Set the weights from the noise energies held from earlier windows."""
    i = 0
    while i < 6:
        copy(s_, _OMEGA + i, _HOLD + i, 2)
        weigh(s_, c_, _OMEGA + i)
        i += 2
