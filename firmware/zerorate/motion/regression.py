"""What a window says of its rates, and what an error of them adds to that, in six rows.

An error e of the rate turns the frame by the integral of R e, so a tilt or a heading y by one of
its components. Under a bell w over the window that is, by parts, - integral w' y = integral w R e:
neither where the window began nor what is constant counts, and the hand's push only by what of it
is as slow as the window. Two bells, (1 - t^2)^3 and 2 t (1 - t^2)^3, give two rows each of the two
tilts and one of the heading. The heading's second row, and a third shape, hold nothing of a bias
in one pose: they measure how far the heading strays.

A speed v that is constant in the body adds the derivative of R v to the force, by parts the bell's
second derivative times R v to each tilt. Where a walker turns by w it is w^2 v / g, whichever way
he turns: 0.5 rad/s at 1.2 m/s are 1.8 dps about the axis across his way. The sixth row says that
nobody climbs: the mean of R v along the vertical is zero.

A row is 19 words: what it says, then what the bias adds, and what the entries of scale and axes
add, by rows: R e with e of one axis, and that times each rate. A bias f of the accelerometer adds
R f to the force, so a level component of it to each tilt.
"""

# layout: names that a board's own compiler reads
const = int
ptr32 = None
# layout: The state of the source in motion
_HALF = const(18)
_R = const(32)
_BELLS = const(41)
_SHAPES = const(43)
_CURVES = const(46)
_HALF_BEFORE = const(48)
_Y = const(51)
_WINDOW_ROWS = const(88)
_STRAY = const(202)
# layout: A row of a window in motion
_BY_BIAS = const(1)
_BY_ENTRIES = const(4)
_BY_FORCE = const(13)
_BY_SPEED = const(16)
_ROW_WORDS = const(19)
# layout: end
_CLIMB_ROW = const(5)


def weights(s: ptr32, k: int, stage: int, document: int):
    """Write both bells and the shapes of node k of 2^stage, Q10."""
    # US 10,451,438 fits a line in time itself.
    t = (2 * k + 1 - (1 << stage)) << (10 - stage)
    square = (t * t) >> 10
    rest = 1024 - square
    falls = (rest * rest) >> 10
    s[_BELLS] = (rest * falls) >> 10
    s[_BELLS + 1] = (2 * t * s[_BELLS]) >> 10
    s[_SHAPES] = t if document else (6 * t * falls) >> 10
    s[_SHAPES + 1] = (2 * (7 * square - 1024) * falls) >> 10
    s[_CURVES] = (6 * rest * (5 * square - 1024)) >> 10
    s[_CURVES + 1] = (((12 * t * rest) >> 10) * (7 * square - 3072)) >> 10
    s[_SHAPES + 2] = (((11 * t * falls) >> 10) * (3 * square - 1024)) >> 10


def rows(s: ptr32):
    """Add the node at its start, R, Y and half its turn, to the rows."""
    for i in range(3):
        s[_HALF_BEFORE + i] += s[_HALF + i]  # of both nodes: a turn of R is seen at its middle
    row(s, 0, 0, _WINDOW_ROWS)
    row(s, 0, 1, _WINDOW_ROWS + _ROW_WORDS)
    row(s, 0, 2, _WINDOW_ROWS + 2 * _ROW_WORDS)
    row(s, 1, 0, _WINDOW_ROWS + 3 * _ROW_WORDS)
    row(s, 1, 1, _WINDOW_ROWS + 4 * _ROW_WORDS)
    for i in range(2):
        s[_STRAY + i] += (s[_SHAPES + 1 + i] * s[_Y + 2] + 512) >> 10
    for i in range(3):
        s[_HALF_BEFORE + i] = s[_HALF + i]


def row(s: ptr32, q: int, i: int, a: int):
    """Add to the row at a what component i says under bell q."""
    part = (s[_SHAPES + q] * s[_Y + i] + 512) >> 10
    s[a] += part
    j = 0
    while j < 3:
        part = (s[_BELLS + q] * s[_R + 3 * i + j] + 512) >> 10
        s[a + _BY_BIAS + j] += part
        tell(s, a + _BY_ENTRIES + 3 * j, part)
        if i < 2:
            part = (s[_SHAPES + q] * s[_R + 3 - 3 * i + j] + 512) >> 10
            s[a + _BY_FORCE + j] += part if i else 0 - part
            part = (s[_CURVES + q] * s[_R + 3 - 3 * i + j] + 512) >> 10
            s[a + _BY_SPEED + j] += part if i else 0 - part
        else:
            s[_WINDOW_ROWS + _CLIMB_ROW * _ROW_WORDS + _BY_SPEED + j] += part
        j += 1


def tell(s: ptr32, at: int, part: int):
    """Add to three words what entries add to a rate that the node shows by `part`."""
    k = 0
    while k < 3:
        s[at + k] += (part * s[_HALF_BEFORE + k] + 0x2000) >> 14
        k += 1
