"""The estimators of one axis: any temperature, short term and long term."""

# US 9,354,080, paragraphs on "bias estimators": estimator 0 takes every reading; 1..short are a
# least-recently-used cache of the latest temperatures; the others keep a wide range of them.
# `a` is the first word of an axis, `e` that of an estimator (docs/layout.md).

from .histogram import add, clear, halve, population, read_out_q8

# layout: names that a board's own compiler reads
const = int
ptr32 = None
# layout: The corrector's state
_LEARN_TEMP = const(23)
_CANDIDATE_THIRD = const(7)
_NEAREST = const(26)
# layout: An axis
_WAITING_SUM = const(0)
_WAITING_N = const(1)
_CURRENT = const(2)
_COLDEST = const(3)
_HOTTEST = const(4)
_LEARNED_N = const(5)
_ORDER = const(6)
_FLOOR_Q16 = const(35)
_LEAVES_Q16 = const(36)
_ESTIMATORS = const(40)
# layout: An estimator
_EST_TEMP = const(0)
_EST_MEAN_TEMP_Q4 = const(1)
_EST_BIAS_Q8 = const(2)
_EST_READINGS = const(3)
_EST_SPREAD_Q8 = const(4)
_EST_HISTOGRAM = const(5)
# layout: The corrector's settings
_FIRST_SHORT = const(16)
_ESTIMATORS_END = const(17)
_BINS = const(18)
_LITERAL = const(23)
_SHORT = const(26)
_ESTIMATOR_WORDS = const(28)
_STEP_LSB = const(29)
_MARGIN_LSB = const(30)
_PROMOTE = const(31)
_HALVE_AFTER = const(32)
_FLOOR_Q8 = const(39)
_TURN_ON_VARIANCE_Q8 = const(47)
_FIRST_LONG = const(49)
_SLOPE_Q16 = const(52)
# layout: Values that stand for none
_FREE = const(-0x100000)
# layout: end
_MOST_GIVEN = const(0x1FFFFFF)  # of 18 estimators together below 2^30


def reset(s: ptr32, c: ptr32, a: int):
    """Forget everything: no temperature seen, all estimators free and empty."""
    s[a + _CURRENT] = 0
    s[a + _COLDEST] = 32767
    s[a + _HOTTEST] = -32768
    s[a + _LEARNED_N] = 0
    s[a + _FLOOR_Q16] = c[_FLOOR_Q8] << 8
    s[a + _LEAVES_Q16] = c[_SLOPE_Q16]
    i = 0
    e = a + _ESTIMATORS
    while e < a + c[_ESTIMATORS_END]:
        s[e + _EST_TEMP] = _FREE
        s[e + _EST_MEAN_TEMP_Q4] = 0
        s[e + _EST_BIAS_Q8] = 0
        s[e + _EST_READINGS] = 0
        s[e + _EST_SPREAD_Q8] = c[_TURN_ON_VARIANCE_Q8]
        clear(s, c, e + _EST_HISTOGRAM, 0)
        if i > 0 and i <= c[_SHORT]:
            s[a + _ORDER + i - 1] = e
        e += c[_ESTIMATOR_WORDS]
        i += 1


def find(s: ptr32, c: ptr32, a: int, temp: int) -> int:
    """Return the estimator for `temp`, or 0."""
    # The one in use keeps a temperature that is a margin beyond its own degree, so that noise at
    # the boundary does not push the others out of the cache.
    half = c[_STEP_LSB] >> 1
    e = s[a + _CURRENT]
    if e > 0:
        d = temp - s[e + _EST_TEMP]
        if d <= half + c[_MARGIN_LSB] and d >= 0 - half - c[_MARGIN_LSB]:
            return e
    e = a + c[_FIRST_SHORT]
    while e < a + c[_ESTIMATORS_END]:
        d = temp - s[e + _EST_TEMP]
        if d < half and d >= 0 - half:
            return e
        e += c[_ESTIMATOR_WORDS]
    return 0


def touch(s: ptr32, c: ptr32, a: int, e: int):
    """Make the short-term estimator the most recently used; a long-term one has no order."""
    if e < a + c[_FIRST_LONG]:
        k = a + _ORDER
        held = e
        while s[k] != e:
            d = s[k]
            s[k] = held
            held = d
            k += 1
        s[k] = held


def third(s: ptr32, a: int, e: int) -> int:
    """Return in which third of the observed temperature range the estimator is: 0, 1 or 2."""
    span = s[a + _HOTTEST] - s[a + _COLDEST] + 1
    part = (s[e + _EST_TEMP] - s[a + _COLDEST]) * 3 // span
    if part < 0:
        return 0
    return part if part < 2 else 2


def richest(s: ptr32, c: ptr32, a: int, part: int) -> int:
    """Return the long-term estimator with most samples in that third of the range, or 0."""
    best = 0
    e = a + c[_FIRST_LONG]
    while e < a + c[_ESTIMATORS_END]:
        if s[e + _EST_TEMP] != _FREE and third(s, a, e) == part:
            if best == 0 or s[e + _EST_READINGS] > s[best + _EST_READINGS]:
                best = e
        e += c[_ESTIMATOR_WORDS]
    return best


def protected(s: ptr32, c: ptr32, a: int, e: int) -> int:
    """Return 1 if the long-term estimator is the richest of a third the candidate is not in."""
    part = third(s, a, e)
    return 1 if part != s[_CANDIDATE_THIRD] and richest(s, c, a, part) == e else 0


def outermost(s: ptr32, c: ptr32, a: int, e: int) -> int:
    """Return 1 if no other long-term estimator is colder, or none is hotter."""
    colder = 1
    hotter = 1
    d = a + c[_FIRST_LONG]
    while d < a + c[_ESTIMATORS_END]:
        if s[d + _EST_TEMP] != _FREE and s[d + _EST_TEMP] < s[e + _EST_TEMP]:
            colder = 0
        if s[d + _EST_TEMP] > s[e + _EST_TEMP]:
            hotter = 0
        d += c[_ESTIMATOR_WORDS]
    return colder | hotter


def distance(s: ptr32, c: ptr32, a: int, e: int) -> int:
    """Return how far the nearest other long-term estimator's temperature is from that of `e`."""
    nearest = 0xFFFFF
    d = a + c[_FIRST_LONG]
    while d < a + c[_ESTIMATORS_END]:
        gap = s[d + _EST_TEMP] - s[e + _EST_TEMP]
        if gap < 0:
            gap = -gap
        if d != e and gap < nearest:
            nearest = gap
        d += c[_ESTIMATOR_WORDS]
    return nearest


def most_crowded(s: ptr32, c: ptr32, a: int, e: int) -> int:
    """Return the unprotected long-term estimator with the nearest neighbour, or `e` itself."""
    # After minutes at a temperature more samples tell nothing new of it, but a temperature that
    # nobody remembers has to be guessed: the default keeps them apart, and the outermost ones.
    found = e
    s[_NEAREST] = distance(s, c, a, e)
    d = a + c[_FIRST_LONG]
    while d < a + c[_ESTIMATORS_END]:
        if distance(s, c, a, d) < s[_NEAREST] and outermost(s, c, a, d) == 0:
            if protected(s, c, a, d) == 0:
                s[_NEAREST] = distance(s, c, a, d)
                found = d
        d += c[_ESTIMATOR_WORDS]
    return found


def poorest(s: ptr32, c: ptr32, a: int, e: int) -> int:
    """Return the unprotected long-term estimator with fewest samples, fewer than `e`, or `e`."""
    found = e
    d = a + c[_FIRST_LONG]
    while d < a + c[_ESTIMATORS_END]:
        if s[d + _EST_READINGS] < s[found + _EST_READINGS] and protected(s, c, a, d) == 0:
            found = d
        d += c[_ESTIMATOR_WORDS]
    return found


def victim(s: ptr32, c: ptr32, a: int, e: int) -> int:
    """Return the long-term estimator that the short-term one `e` may replace, or `e` itself."""
    s[_CANDIDATE_THIRD] = third(s, a, e)
    d = a + c[_FIRST_LONG]
    while d < a + c[_ESTIMATORS_END]:
        if s[d + _EST_TEMP] == _FREE:
            return d
        d += c[_ESTIMATOR_WORDS]
    if c[_LITERAL]:
        return poorest(s, c, a, e)
    return most_crowded(s, c, a, e)


def copy(s: ptr32, c: ptr32, to: int, e: int):
    """Copy one estimator over another."""
    for i in range(c[_ESTIMATOR_WORDS]):
        s[to + i] = s[e + i]


def make_room(s: ptr32, c: ptr32, a: int, temp: int) -> int:
    """Return a short-term estimator made free for `temp`; the one it was may become long-term."""
    e = s[a + _ORDER - 1 + c[_SHORT]]
    if s[e + _EST_TEMP] != _FREE and s[e + _EST_READINGS] >= c[_PROMOTE]:
        k = victim(s, c, a, e)
        if k != e:
            copy(s, c, k, e)
    # centres lie on a grid, so that the same temperature comes back to the same estimator
    s[e + _EST_TEMP] = (temp + (c[_STEP_LSB] >> 1)) // c[_STEP_LSB] * c[_STEP_LSB]
    s[e + _EST_MEAN_TEMP_Q4] = temp << 4
    s[e + _EST_READINGS] = 0
    s[e + _EST_SPREAD_Q8] = s[a + _ESTIMATORS + _EST_SPREAD_Q8]
    return e


def feed(s: ptr32, c: ptr32, a: int, e: int):
    """Add the axis' waiting readings to the estimator and renew what is kept of it."""
    if s[e + _EST_READINGS] == 0:
        k = s[a + _WAITING_SUM] // s[a + _WAITING_N]
        clear(s, c, e + _EST_HISTOGRAM, k)
        s[e + _EST_MEAN_TEMP_Q4] = s[_LEARN_TEMP] << 4
    if add(s, c, e + _EST_HISTOGRAM, a) == 0:
        return
    if s[e + _EST_READINGS] < _MOST_GIVEN:
        s[e + _EST_READINGS] += s[a + _WAITING_N]
    s[e + _EST_BIAS_Q8] = read_out_q8(s, e + _EST_HISTOGRAM, c[_BINS])
    k = population(s, e + _EST_HISTOGRAM, c[_BINS])
    if k < s[a + _WAITING_N]:
        k = s[a + _WAITING_N]
    k = ((s[_LEARN_TEMP] << 4) - s[e + _EST_MEAN_TEMP_Q4]) * s[a + _WAITING_N] // k
    s[e + _EST_MEAN_TEMP_Q4] += k


def age(s: ptr32, c: ptr32, a: int):
    """Halve the counts of the long-term estimators, so that an old outlier does not stay."""
    e = a + c[_FIRST_LONG]
    while e < a + c[_ESTIMATORS_END]:
        halve(s, e + _EST_HISTOGRAM, c[_BINS])
        s[e + _EST_READINGS] = s[e + _EST_READINGS] >> 1
        e += c[_ESTIMATOR_WORDS]


def learn_anywhere(s: ptr32, c: ptr32, a: int):
    """Learn the axis' waiting readings in the estimator of any temperature."""
    temp = s[_LEARN_TEMP]
    if temp < s[a + _COLDEST]:
        s[a + _COLDEST] = temp
    if temp > s[a + _HOTTEST]:
        s[a + _HOTTEST] = temp
    feed(s, c, a, a + _ESTIMATORS)


def learn_here(s: ptr32, c: ptr32, a: int):
    """Learn them in the estimator of their temperature; where there is none one is made free."""
    temp = s[_LEARN_TEMP]
    e = find(s, c, a, temp)
    if e == 0:
        e = make_room(s, c, a, temp)
    touch(s, c, a, e)
    s[a + _CURRENT] = e
    feed(s, c, a, e)
    s[a + _LEARNED_N] += s[a + _WAITING_N]
    if s[a + _LEARNED_N] >= c[_HALVE_AFTER]:
        s[a + _LEARNED_N] = 0
        age(s, c, a)
