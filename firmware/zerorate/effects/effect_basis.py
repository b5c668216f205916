"""The basis of one effect slot: what its coefficients are multiplied by, once a tick, in Q24.

Order: clamp, centre, delay, [power first], lag or memory, knot, table or power, second, decay.
The tool scales each slot so that no stage leaves +-1 (2^24), and 1 stands for the largest value
that the fitted range allows. Words of a slot: docs/layout.md.
"""

from ..arithmetic.fixed import clipped, scaled

# layout: names that a board's own compiler reads
const = int
ptr32 = None
# layout: An effect slot
_SLOT_SOURCE = const(0)
_SLOT_LOWEST_Q8 = const(1)
_SLOT_HIGHEST_Q8 = const(2)
_SLOT_CENTRE_Q8 = const(3)
_SLOT_SHIFT = const(4)
_SLOT_POWER = const(5)
_SLOT_POWER_FIRST = const(6)
_SLOT_MEMORY = const(7)
_SLOT_LAG = const(8)
_SLOT_HALF_WIDTH = const(10)
_SLOT_KNOT = const(11)
_SLOT_SECOND = const(12)
_SLOT_DECAY = const(17)
_SLOT_TABLE = const(19)
_SLOT_TABLE_FIRST = const(20)
_SLOT_TABLE_SCALE = const(21)
_SLOT_COEFFICIENT_SHIFT = const(23)
_SLOT_COEFFICIENT = const(24)
_SLOT_RING = const(27)
_SLOT_DELAY = const(28)
_SLOT_RING_STEP = const(29)
_SLOT_STARTED = const(34)
_SLOT_STATE = const(35)
_SLOT_DECAYED = const(37)
_SLOT_VALUE = const(39)
# layout: A delay's ring
_RING_NEWEST = const(0)
_RING_AGE = const(1)
_RING_KEPT = const(2)
# layout: An effect slot's memory
_MEMORY_LAG = const(1)
_MEMORY_RATE = const(3)
_MEMORY_BACKLASH = const(4)
# layout: Values that stand for none
_NO_VALUE = const(-0x3FFFFFFF)
# layout: end
_ONE_Q24 = const(0x1000000)
_RING_LENGTH = const(64)


def centred(e: ptr32, f: int) -> int:
    """Return the source at field f, held within its fitted range, less its centre, in Q24."""
    u = e[e[f + _SLOT_SOURCE]]
    if u == _NO_VALUE:
        return _NO_VALUE
    if u < e[f + _SLOT_LOWEST_Q8]:
        u = e[f + _SLOT_LOWEST_Q8]
    elif u > e[f + _SLOT_HIGHEST_Q8]:
        u = e[f + _SLOT_HIGHEST_Q8]
    u -= e[f + _SLOT_CENTRE_Q8]
    shift = e[f + _SLOT_SHIFT]
    if shift < 0:
        return u >> (0 - shift)
    return u << shift


def delayed(e: ptr32, a: int, u: int) -> int:
    """Return u of so many ticks ago, and keep this one; before the first tick u was as then."""
    # The ring keeps one of so many ticks; between two a straight line is taken.
    ring = e[a + _SLOT_RING]
    if e[a + _SLOT_STARTED] == 0:
        e[ring + _RING_NEWEST] = 0
        e[ring + _RING_AGE] = 0
        while e[ring + _RING_NEWEST] < _RING_LENGTH:
            e[ring + _RING_KEPT + e[ring + _RING_NEWEST]] = u
            e[ring + _RING_NEWEST] += 1
        e[ring + _RING_NEWEST] = 0
    elif e[ring + _RING_AGE] == 0:
        e[ring + _RING_NEWEST] = (e[ring + _RING_NEWEST] + 1) & 63
        e[ring + _RING_KEPT + e[ring + _RING_NEWEST]] = u
    ago = e[a + _SLOT_DELAY] - e[ring + _RING_AGE]
    # eleven words: a is from here on how many ticks a step has
    a = e[a + _SLOT_RING_STEP]
    e[ring + _RING_AGE] = (e[ring + _RING_AGE] + 1) % a
    return between(e, ring, e[ring + _RING_NEWEST] - ago // a, ago % a, a)


def between(e: ptr32, ring: int, place: int, part: int, step: int) -> int:
    """Return what the ring kept at a place, and a part of a step farther back."""
    u = e[ring + _RING_KEPT + (place & 63)]
    d = e[ring + _RING_KEPT + ((place - 1) & 63)] - u
    if d < 0:
        return u - ((((0 - d) >> 4) * part // step) << 4)
    return u + (((d >> 4) * part // step) << 4)


def power(v: int, n: int) -> int:
    """Return v to the n, 1..3, in Q24."""
    u = v
    factors = n
    while factors > 1:
        u = scaled(u, v, 24)
        factors -= 1
    return u


def approach(e: ptr32, z: int, f: int, u: int):
    """Move the first-order lag at z by e[f] / 2^(15 + e[f+1]) of its way to u."""
    # The word behind z keeps what is below a unit, so that no lag is too long to arrive.
    d = u - e[z]
    shift = e[f + 1] + 3
    t = (d >> 12) * e[f]
    d = (d & 0xFFF) * e[f] + e[z + 1]
    # eleven words: f is from here on the way in whole units, t what is left of it
    f = t >> shift
    d += (t - (f << shift)) << 12
    t = d >> shift + 12
    f += t
    e[z] += f
    e[z + 1] = d - (t << shift + 12)


def start(e: ptr32, a: int, u: int):
    """Begin the slot's memory at its first tick of the power-on."""
    e[a + _SLOT_STARTED] = 1
    e[a + _SLOT_STATE] = u
    e[a + _SLOT_STATE + 1] = 0
    e[a + _SLOT_DECAYED] = _ONE_Q24
    e[a + _SLOT_DECAYED + 1] = 0


def remembered(e: ptr32, a: int, u: int) -> int:
    """Return u with the slot's lag or memory: see model.term of the tools, the float reference."""
    kind = e[a + _SLOT_MEMORY]
    if kind <= _MEMORY_RATE:
        approach(e, a + _SLOT_STATE, a + _SLOT_LAG, u)
        p = e[a + _SLOT_STATE]
        return p if kind == _MEMORY_LAG else u - p
    p = e[a + _SLOT_STATE]
    if kind == _MEMORY_BACKLASH:
        half = e[a + _SLOT_HALF_WIDTH]
        if p < u - half:
            p = u - half
        elif p > u + half:
            p = u + half
    elif p < u:
        p = u
    e[a + _SLOT_STATE] = p
    return p - u


def looked_up(e: ptr32, a: int, v: int) -> int:
    """Return what the slot's table of nine equally spaced points says at v, held at its ends."""
    at = e[a + _SLOT_TABLE_SCALE]
    at = scaled(v - e[a + _SLOT_TABLE_FIRST], at, e[a + _SLOT_TABLE_SCALE + 1])
    table = e[a + _SLOT_TABLE]
    if at <= 0:
        return e[table]
    if at >= 8 * _ONE_Q24:
        return e[table + 8]
    table += at >> 24
    return e[table] + scaled(e[table + 1] - e[table], at & 0xFFFFFF, 24)


def basis(e: ptr32, a: int) -> int:
    """Run the slot at word a for a tick; return its value in Q24, 0 while a source is unknown."""
    v = centred(e, a)
    w = _ONE_Q24
    if e[a + _SLOT_SECOND]:
        w = centred(e, a + _SLOT_SECOND)
    if v == _NO_VALUE or w == _NO_VALUE:
        return 0
    if e[a + _SLOT_RING]:
        v = delayed(e, a, v)
    if e[a + _SLOT_POWER_FIRST]:
        v = power(v, e[a + _SLOT_POWER])
    if e[a + _SLOT_STARTED] == 0:
        start(e, a, v)
    if e[a + _SLOT_MEMORY]:
        v = remembered(e, a, v)
    if e[a + _SLOT_KNOT] != _NO_VALUE:
        v -= e[a + _SLOT_KNOT]
        if v < 0:
            v = 0
    if e[a + _SLOT_TABLE]:
        v = looked_up(e, a, v)
    elif e[a + _SLOT_POWER_FIRST] == 0:
        v = power(v, e[a + _SLOT_POWER])
    if e[a + _SLOT_SECOND]:
        v = scaled(v, w, 24)
    if e[a + _SLOT_DECAY]:
        v = scaled(v, e[a + _SLOT_DECAYED], 24)
        approach(e, a + _SLOT_DECAYED, a + _SLOT_DECAY, 0)
    return v


def contribute(e: ptr32, a: int, to: int):
    """Add the slot's value times its coefficients to three sums in Q14 LSB."""
    shift = e[a + _SLOT_COEFFICIENT_SHIFT]
    add_times(e, e[a + _SLOT_VALUE], a + _SLOT_COEFFICIENT, shift, to)


def add_times(e: ptr32, v: int, a: int, shift: int, to: int):
    """Add v times the three coefficients at word a to three sums in Q14 LSB."""
    i = 3
    while i > 0:
        d = scaled(v, e[a], shift) + e[to]
        e[to] = clipped(d, 0x1FFFFFFF)
        to += 1  # eleven words: to and a go on to the next axis
        a += 1
        i -= 1
