"""The basis of one effect slot: what its coefficients are multiplied by, once a tick, in Q24.

Order: clamp, centre, delay, [power first], lag or memory, knot, table or power, second source,
decay.
The tool scales each slot so that no stage leaves +-1 (2^24), and 1 stands for the largest value
that the fitted range allows. Words of a slot: see model.py.
"""

try:
    from micropython import const
except ImportError:

    def const(value):
        return value


ptr32 = None


from .fixed import scaled

_NONE = const(-0x3FFFFFFF)
_ONE = const(0x1000000)

_POWER = const(5)
_POWER_FIRST = const(6)
_MEMORY = const(7)
_LAG = const(8)
_HALF_WIDTH = const(10)
_KNOT = const(11)
_SECOND = const(12)
_DECAY = const(17)
_TABLE = const(19)
_COEFFICIENT_SHIFT = const(23)
_COEFFICIENT = const(24)
_RING = const(27)
_DELAY = const(28)
_STEP = const(29)
_STARTED = const(34)
_STATE = const(35)
_DECAYED = const(37)
_VALUE = const(39)

_KEPT = const(64)

_LAGGED = const(1)
_RATE = const(3)
_BACKLASH = const(4)


def centred(e: ptr32, f: int) -> int:
    """Return the source at field f, held within its fitted range, less its centre, in Q24."""
    u = e[e[f]]
    if u == _NONE:
        return _NONE
    if u < e[f + 1]:
        u = e[f + 1]
    elif u > e[f + 2]:
        u = e[f + 2]
    u -= e[f + 3]
    f = e[f + 4]
    if f < 0:
        return u >> (0 - f)
    return u << f


def delayed(e: ptr32, a: int, u: int) -> int:
    """Return u of so many ticks ago, and keep this one; before the first tick u was as then.

    The ring keeps one of so many ticks; between two a straight line is taken.
    """
    ring = e[a + _RING]
    if e[a + _STARTED] == 0:
        e[ring] = 0
        e[ring + 1] = 0
        while e[ring] < _KEPT:
            e[ring + 2 + e[ring]] = u
            e[ring] += 1
        e[ring] = 0
    elif e[ring + 1] == 0:
        e[ring] = (e[ring] + 1) & 63
        e[ring + 2 + e[ring]] = u
    u = e[a + _DELAY] - e[ring + 1]
    e[ring + 1] = (e[ring + 1] + 1) % e[a + _STEP]
    a = e[a + _STEP]
    return between(e, ring, u // a, u % a, a)


def between(e: ptr32, ring: int, back: int, part: int, step: int) -> int:
    """Return what the ring kept so many steps back, and a part of a step farther back."""
    u = e[ring + 2 + ((e[ring] - back) & 63)]
    d = e[ring + 2 + ((e[ring] - back - 1) & 63)] - u
    if d < 0:
        return u - ((((0 - d) >> 4) * part // step) << 4)
    return u + (((d >> 4) * part // step) << 4)


def power(v: int, n: int) -> int:
    """Return v to the n, 1..3, in Q24."""
    u = v
    while n > 1:
        u = scaled(u, v, 24)
        n -= 1
    return u


def approach(e: ptr32, z: int, f: int, u: int):
    """Move the first-order lag at z by e[f] / 2^(15 + e[f+1]) of its way to u.

    The word behind z keeps what is below a unit, so that no lag is too long to arrive.
    """
    d = u - e[z]
    u = e[f + 1] + 3
    t = (d >> 12) * e[f]
    d = (d & 0xFFF) * e[f] + e[z + 1]
    f = t >> u
    d += (t - (f << u)) << 12
    u += 12
    t = d >> u
    e[z] += f + t
    e[z + 1] = d - (t << u)


def start(e: ptr32, a: int, u: int):
    """Begin the slot's memory at its first tick of the power-on."""
    e[a + _STARTED] = 1
    e[a + _STATE] = u
    e[a + _STATE + 1] = 0
    e[a + _DECAYED] = _ONE
    e[a + _DECAYED + 1] = 0


def remembered(e: ptr32, a: int, u: int) -> int:
    """Return u with the slot's lag or memory: see model.term of the tools, the float reference."""
    kind = e[a + _MEMORY]
    a += _STATE
    if kind <= _RATE:
        approach(e, a, a - _STATE + _LAG, u)
        return e[a] if kind == _LAGGED else u - e[a]
    p = e[a]
    if kind == _BACKLASH:
        kind = e[a - _STATE + _HALF_WIDTH]
        if p < u - kind:
            p = u - kind
        elif p > u + kind:
            p = u + kind
    elif p < u:
        p = u
    e[a] = p
    return p - u


def looked_up(e: ptr32, a: int, v: int) -> int:
    """Return what the slot's table of nine equally spaced points says at v, held at its ends."""
    table = e[a + _TABLE]
    v = scaled(v - e[a + _TABLE + 1], e[a + _TABLE + 2], e[a + _TABLE + 3])
    if v <= 0:
        return e[table]
    if v >= 8 * _ONE:
        return e[table + 8]
    table += v >> 24
    return e[table] + scaled(e[table + 1] - e[table], v & 0xFFFFFF, 24)


def basis(e: ptr32, a: int) -> int:
    """Run the slot at word a for a tick; return its value in Q24, 0 while a source is unknown."""
    v = centred(e, a)
    w = _ONE
    if e[a + _SECOND]:
        w = centred(e, a + _SECOND)
    if v == _NONE or w == _NONE:
        return 0
    if e[a + _RING]:
        v = delayed(e, a, v)
    if e[a + _POWER_FIRST]:
        v = power(v, e[a + _POWER])
    if e[a + _STARTED] == 0:
        start(e, a, v)
    if e[a + _MEMORY]:
        v = remembered(e, a, v)
    if e[a + _KNOT] != _NONE:
        v -= e[a + _KNOT]
        if v < 0:
            v = 0
    if e[a + _TABLE]:
        v = looked_up(e, a, v)
    elif e[a + _POWER_FIRST] == 0:
        v = power(v, e[a + _POWER])
    if e[a + _SECOND]:
        v = scaled(v, w, 24)
    if e[a + _DECAY]:
        v = scaled(v, e[a + _DECAYED], 24)
        approach(e, a + _DECAYED, a + _DECAY, 0)
    return v


def contribute(e: ptr32, a: int, to: int):
    """Add the slot's value times its coefficients to three sums in Q14 LSB."""
    add_times(e, e[a + _VALUE], a + _COEFFICIENT, e[a + _COEFFICIENT_SHIFT], to)


def add_times(e: ptr32, v: int, a: int, shift: int, to: int):
    """Add v times the three coefficients at word a to three sums in Q14 LSB."""
    i = 3
    while i > 0:
        d = scaled(v, e[a], shift)
        d += e[to]
        if d > 0x1FFFFFFF:
            d = 0x1FFFFFFF
        elif d < -0x1FFFFFFF:
            d = -0x1FFFFFFF
        e[to] = d
        to += 1
        a += 1
        i -= 1
