"""Whether a state that was stored can be one: kernels go where its words say, unasked.

A checksum says that a state is as it was written. One that a fault of a program, or a bad cell of
memory, turned before is written with a checksum as right as any.
"""

# layout: names that a board's own compiler reads
const = int
# layout: An axis
_CURRENT = const(2)
_COLDEST = const(3)
_HOTTEST = const(4)
_ORDER = const(6)
_OFFSET_Q8 = const(27)
_ESTIMATORS = const(40)
# layout: An estimator
_EST_TEMP = const(0)
_EST_MEAN_TEMP_Q4 = const(1)
_EST_BIAS_Q8 = const(2)
_EST_READINGS = const(3)
_EST_HISTOGRAM = const(5)
# layout: The corrector's settings
_AXES = const(0)
_AXIS_WORDS = const(15)
_FIRST_SHORT = const(16)
_ESTIMATORS_END = const(17)
_BINS = const(18)
_LITERAL = const(23)
_SHORT = const(26)
_ESTIMATOR_WORDS = const(28)
_STEP_LSB = const(29)
_MARGIN_LSB = const(30)
_EVERY = const(48)
_FIRST_LONG = const(49)
# layout: An axis: bits of each word, 64 more, or 96 where it has a sign
_AXIS_BITS = b"~NNpp]NNNNNN~C~~~~E~~^E~~~~x]X~ZACp]L~SS"
# layout: An estimator: bits of each word, 64 more, or 96 where it has a sign
_ESTIMATOR_BITS = b"ttxZ\\"
# layout: Values that stand for none
_FREE = const(-0x100000)
# layout: end
_MOST_READINGS = const(0x3FFF)
_NEAR_Q8 = const(513)  # an estimator's bias is a bin's mean, but for what halving rounds away


def is_sound(s, c):
    """Return whether every word that a power-on keeps of state `s` is one that can be.

    c: the settings. Each word lies in its range, and what belongs together agrees.
    """
    for axis in range(3):
        a = c[_AXES] + axis * c[_AXIS_WORDS]
        if not (_within(s, a, _AXIS_BITS) and _orders(s, c, a) and _spans(s, c, a)):
            return False
        for e in range(a + _ESTIMATORS, a + c[_ESTIMATORS_END], c[_ESTIMATOR_WORDS]):
            if not (_within(s, e, _ESTIMATOR_BITS) and _lies(s, c, a, e) and _counts(s, c, e)):
                return False
    return True


def _within(s, at, limits):
    for limit in limits:
        if s[at] >> (limit & 31) not in (0, -(limit >> 5 & 1)):
            return False
        at += 1
    return True


def _orders(s, c, a):
    """Whether each short-term estimator is in the order once, and the one in use is one."""
    step = c[_ESTIMATOR_WORDS]
    first = a + c[_FIRST_SHORT]
    order = list(s[a + _ORDER : a + _ORDER + c[_SHORT]])
    if sorted(order) != list(range(first, a + c[_FIRST_LONG], step)):
        return False
    current = s[a + _CURRENT]
    return current == 0 or current in range(first, a + c[_ESTIMATORS_END], step)


def _spans(s, c, a):
    """Whether the axis has learned at temperatures, or at none, and has an offset if it may."""
    if (c[_EVERY] or c[_LITERAL]) and s[a + _OFFSET_Q8]:
        return False
    if s[a + _COLDEST] <= s[a + _HOTTEST]:
        return True
    return s[a + _COLDEST] == 32767 and s[a + _HOTTEST] == -32768


def _lies(s, c, a, e):
    """Whether the estimator's temperatures were learned at, and are near each other."""
    temp = s[e + _EST_TEMP]
    mean = s[e + _EST_MEAN_TEMP_Q4] >> 4
    if s[e + _EST_READINGS] and not s[a + _COLDEST] <= mean <= s[a + _HOTTEST]:
        return False
    if temp == _FREE:
        return e == a + _ESTIMATORS or s[e + _EST_READINGS] == 0
    # an effect model may widen the range of an estimator after the state was loaded
    most = (c[_STEP_LSB] << 5) + c[_MARGIN_LSB]
    return e > a + _ESTIMATORS and -most <= mean - temp <= most


def _counts(s, c, e):
    """Whether the histogram's bins rise, hold what lies in it, and mean the bias."""
    h = e + _EST_HISTOGRAM
    bins = c[_BINS]
    if s[h + bins] & _MOST_READINGS:
        return False
    low = s[h] >> 14
    high = s[h + bins] >> 14
    known = 0
    near = False
    for k in range(h, h + bins):
        count = s[k] & _MOST_READINGS
        total = s[k + bins + 1]
        known += count
        if s[k] >> 14 >= s[k + 1] >> 14 or not low * count <= total <= high * count:
            return False
        if count:
            off = (total << 8) // count - s[e + _EST_BIAS_Q8]
            near = near or -_NEAR_Q8 < off < _NEAR_Q8
        elif bins > 1:
            near = True  # the bin that the bias was the mean of may have been halved away
    if s[e + _EST_READINGS] and not low << 8 <= s[e + _EST_BIAS_Q8] <= high << 8:
        return False
    return known <= s[e + _EST_READINGS] and (near or not known)
