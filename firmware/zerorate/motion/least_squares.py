"""Bias, scale and axes by a window's rows: a Kalman filter of 18 states, one row at a time.

The hand's push is known no better than the bias, so all covariances are over the push's own
variance, which the rows themselves tell (the conjugate prior of a linear model: normal and inverse
gamma; Gelman 2013, 14.8). Its tails are Student's of four degrees of freedom, for no two windows
are alike (Lange, Little and Taylor 1989): a row that lies far off weighs less.

States: the bias, Q24 rad a node, nine entries of scale and axes by rows, Q24, the bias of the
accelerometer, Q24 g, which would pass for a tilt, and the speed along the axes of the body, Q24 g
nodes, which would pass for a bias while a walker turns. _KNOWN is packed: column n of the upper
triangle begins n (n + 1) / 2 words on.
"""

from ..arithmetic.real import add, copy, divide, multiply, pack, put, subtract, unpack

# layout: names that a board's own compiler reads
const = int
ptr32 = None
# layout: The state of the source in motion
_LENGTH = const(11)
_STAGE = const(12)
_MOTION_REASON = const(17)
_ACCEPTED = const(70)
_WINDOW_ROWS = const(88)
_STRAY = const(202)
_KNOWN = const(204)
_MEAN = const(375)
_PUSH = const(393)
_ROWS_SEEN = const(395)
_HELD_STRAY = const(396)
_HEADING_FIT = const(398)
_ROW_INNOVATION = const(400)
_EXPECTED = const(402)
_BIAS = const(404)
_SLOPE = const(410)
_T = const(416)
_T1 = const(418)
_T2 = const(420)
_T3 = const(422)
_G = const(32)
_ROW_NOISE = const(24)
_WITH = const(26)
# layout: A row of a window in motion
_SAID = const(0)
_BY_BIAS = const(1)
_ROW_WORDS = const(19)
# layout: The settings of the source in motion
_START_VARIANCE = const(14)
_LONGEST = const(16)
_SHORTEST_STAGE = const(17)
_HEADING_SPREAD = const(21)
_MATRIX_ERROR = const(26)
_FORCE_ERROR = const(28)
_PUSH_START = const(30)
_SPEED = const(35)
# layout: What a window in motion taught
_TURNED = const(4)
# layout: end
_UNKNOWNS = const(18)
_FIRST_FORCE = const(12)
_FIRST_SPEED = const(15)
_HEADING_ROW = const(2)
_CLIMB_ROW = const(5)
_CLIMB_BITS = const(-8)  # where the push is 50 mg, a climb of 0.05 m/s over a window
# squares of .01, .05 and .3 rad, times a shape's 2.66 a half node: the least a heading strays, and
# what it is taken to before a short and a full window has been seen
_FLOOR_Q24 = const(4463)
_SHORT_Q24 = const(111569)
_FULL_Q24 = const(4016484)
_GATE_SHIFT = const(4)
_SETTLED_AFTER = const(8)  # windows: a minute tells the noise
_TAILS = const(4)
_FIRST_ROWS = const(8)
_MOST_ROWS = const(128)
_OWN_SPREAD = const(20)


def forget(s: ptr32, c: ptr32):
    """Know nothing: no bias, no entries, what the settings say of all and of the push."""
    i = _KNOWN
    while i < _PUSH:
        s[i] = 0
        i += 1
    i = 0
    while i < _UNKNOWNS:
        a = _START_VARIANCE if i < 3 else _MATRIX_ERROR
        if i >= _FIRST_FORCE:
            a = _FORCE_ERROR if i < _FIRST_SPEED else _SPEED
        put(s, _T, c[a], c[a + 1])
        pack(s, known(i, i), _T)
        i += 1
    put(s, _PUSH, c[_PUSH_START], c[_PUSH_START + 1])
    s[_ROWS_SEEN] = _FIRST_ROWS
    put(s, _HEADING_FIT, 1, 0)


def known(i: int, j: int) -> int:
    """Return the word of element i, j of the covariance."""
    if i > j:
        return _KNOWN + ((i * (i + 1)) >> 1) + j
    return _KNOWN + ((j * (j + 1)) >> 1) + i


def regressor(s: ptr32, d: int, r: int, j: int):
    """Store at d what state j adds to row r."""
    at = _WINDOW_ROWS + _ROW_WORDS * r + _BY_BIAS + j
    if j < _FIRST_FORCE:
        put(s, d, s[at], s[_STAGE] - 15)
    elif j < _FIRST_SPEED:
        put(s, d, s[at], -14)
    else:
        put(s, d, s[at], -s[_STAGE] - 13)


def stray(s: ptr32, c: ptr32):
    """Hold how far the heading strays: what its own shapes say, no less than .8 of before."""
    put(s, _T, s[_STRAY], 12)
    multiply(s, _T, _T, _T)
    put(s, _T1, s[_STRAY + 1], 12)
    multiply(s, _T1, _T1, _T1)
    add(s, _T, _T, _T1)
    put(s, _T, s[_T], s[_T + 1] - 1)
    put(s, _T1, _FLOOR_Q24, 23 + s[_STAGE])
    add(s, _T, _T, _T1)
    put(s, _T1, 13107, -14)
    multiply(s, _HELD_STRAY, _HELD_STRAY, _T1)
    if s[_LENGTH] < c[_LONGEST]:
        put(s, _HELD_STRAY, _SHORT_Q24, 23 + s[_STAGE])
    elif s[_ACCEPTED] == 0:
        put(s, _HELD_STRAY, _FULL_Q24, 23 + s[_STAGE])
    if less(s, _HELD_STRAY, _T):
        copy(s, _HELD_STRAY, _T, 2)


def row_noise(s: ptr32, c: ptr32, r: int):
    """Store row r's variance, over the push's, at _ROW_NOISE."""
    # Half a full window was seen before, so it counts half.
    k = s[_STAGE] - c[_SHORTEST_STAGE] - 3
    if r == _CLIMB_ROW:
        k = _CLIMB_BITS
    put(s, _ROW_NOISE, 1, k + 1 if k == 0 else k)
    if r == _HEADING_ROW:
        put(s, _T, c[_HEADING_SPREAD], 1 if k == 0 else 0)
        multiply(s, _T, _T, _HELD_STRAY)
        multiply(s, _T, _T, _HEADING_FIT)
        divide(s, _ROW_NOISE, _T, _PUSH)
    copy(s, _EXPECTED, _ROW_NOISE, 2)


def innovate(s: ptr32, c: ptr32, r: int):
    """Store at _ROW_INNOVATION what row r says beyond what is known."""
    row_noise(s, c, r)
    put(s, _ROW_INNOVATION, s[_WINDOW_ROWS + _ROW_WORDS * r + _SAID], 12)
    j = 0
    while j < _UNKNOWNS:
        known_already(s, r, j)
        j += 1


def known_already(s: ptr32, r: int, j: int):
    """Take from the row's innovation what state j adds beyond the bias that is removed."""
    unpack(s, _T, _MEAN + j)
    if j < 3:
        subtract(s, _T1, _T, _BIAS + 2 * j)
        copy(s, _T, _T1, 2)
    regressor(s, _T1, r, j)
    multiply(s, _T1, _T1, _T)
    subtract(s, _T, _ROW_INNOVATION, _T1)
    copy(s, _ROW_INNOVATION, _T, 2)


def look(s: ptr32, r: int, j: int):
    """Store the covariance of row r and state j, and add its share to what is expected."""
    put(s, _T2, 0, 0)
    k = 0
    while k < _UNKNOWNS:
        regressor(s, _T, r, k)
        unpack(s, _T1, known(j, k))
        multiply(s, _T, _T, _T1)
        add(s, _T2, _T2, _T)
        k += 1
    copy(s, _WITH + 2 * j, _T2, 2)
    regressor(s, _T, r, j)
    multiply(s, _T, _T, _T2)
    add(s, _EXPECTED, _EXPECTED, _T)


def weigh(s: ptr32, r: int):
    """Learn the noise from row r; leave its weight at _EXPECTED and its weighed innovation."""
    multiply(s, _T, _ROW_INNOVATION, _ROW_INNOVATION)
    divide(s, _T, _T, _EXPECTED)
    divide(s, _T, _T, _PUSH)  # 1 is expected
    if s[_ACCEPTED] >= _SETTLED_AFTER:
        bear_outliers(s)
    put(s, _T1, 1, 0)
    divide(s, _EXPECTED, _T1, _EXPECTED)
    multiply(s, _ROW_INNOVATION, _ROW_INNOVATION, _EXPECTED)


def bear_outliers(s: ptr32):
    """Let a row that lies far off, by its square at _T, weigh less, and tell less of the noise."""
    put(s, _T1, 1, _GATE_SHIFT)
    if less(s, _T1, _T):
        s[_MOTION_REASON] = _TURNED
    put(s, _T1, _TAILS, 0)
    add(s, _T1, _T1, _T)
    put(s, _T2, 0x10000000 // (_TAILS + 1), -28)
    multiply(s, _T1, _T1, _T2)
    divide(s, _T, _T, _T1)
    multiply(s, _T1, _T1, _ROW_NOISE)
    subtract(s, _T2, _T1, _ROW_NOISE)
    add(s, _EXPECTED, _EXPECTED, _T2)
    copy(s, _ROW_NOISE, _T1, 2)


def follow_noise(s: ptr32, r: int):
    """Follow the push, or how the heading strays, by what row r's square at _T is beyond one."""
    if r == _CLIMB_ROW:
        return
    put(s, _T1, 1, 0)
    subtract(s, _T3, _T, _T1)
    if r == _HEADING_ROW:
        multiply(s, _T3, _T3, _ROW_NOISE)
        multiply(s, _T3, _T3, _EXPECTED)  # its own share of what was expected
        multiply(s, _T3, _T3, _HEADING_FIT)
        put(s, _T1, s[_ROWS_SEEN], -2)
        divide(s, _T3, _T3, _T1)
        add(s, _HEADING_FIT, _HEADING_FIT, _T3)
        return
    s[_ROWS_SEEN] += 1 if s[_ROWS_SEEN] < _MOST_ROWS else 0
    multiply(s, _T3, _T3, _PUSH)
    put(s, _T1, s[_ROWS_SEEN], 0)
    divide(s, _T3, _T3, _T1)
    add(s, _PUSH, _PUSH, _T3)


def move(s: ptr32):
    """Move every state by the weighed innovation."""
    for j in range(_UNKNOWNS):
        multiply(s, _T, _WITH + 2 * j, _ROW_INNOVATION)
        unpack(s, _T1, _MEAN + j)
        add(s, _T, _T, _T1)
        pack(s, _MEAN + j, _T)


def narrow(s: ptr32, n: int):
    """Take from column n of the covariance what the row told."""
    multiply(s, _T1, _WITH + 2 * n, _EXPECTED)
    i = 0
    while i <= n:
        multiply(s, _T, _T1, _WITH + 2 * i)
        unpack(s, _T2, known(i, n))
        subtract(s, _T3, _T2, _T)
        pack(s, known(i, n), _T3)
        i += 1


def place(i: int, j: int) -> int:
    """Return the word of element i, j of the matrix at _G; i and j 0..3."""
    if i > j:
        return _G + 2 * (4 * j - ((j * (j + 1)) >> 1) + i)
    return _G + 2 * (4 * i - ((i * (i + 1)) >> 1) + j)


def sweep(s: ptr32, k: int):
    """Sweep the matrix on pivot k."""
    # After pivots 0, 1, 2 its fourth column is the solution (Beaton's operator; stable for a
    # positive definite matrix).
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


def less(s: ptr32, a: int, b: int) -> int:
    """Return 1 if the number at a is less than the one at b, else 0; uses _T3."""
    subtract(s, _T3, a, b)
    return 1 if s[_T3] < 0 else 0


def own_slope(s: ptr32, i: int):
    """Store at _SLOPE the bias that component i's own slope tells, as US 10,451,438 takes it."""
    # Its variance is that of the noise beside it, twenty times: a walk has as much in a slope.
    put(s, _T, 6 * s[_WINDOW_ROWS + _ROW_WORDS * i], 12 - 2 * s[_STAGE])
    add(s, _SLOPE + 2 * i, _BIAS + 2 * i, _T)
    put(s, _T, s[_WINDOW_ROWS + _ROW_WORDS * (3 + i) if i < 2 else _STRAY], 12)
    multiply(s, _T, _T, _T)
    put(s, _T1, _OWN_SPREAD * 10, 0 - 4 * s[_STAGE])
    multiply(s, _T, _T, _T1)
    pack(s, known(i, i), _T)
