"""The bias at this temperature: which estimator, line or aggregate speaks for it."""

# US 9,354,080, paragraphs on the determination of the bias: the estimator of this temperature where
# it is stable and more stable than the fit, else the fit, else the temperature-independent one.

from .estimators import find
from .fit import bent_q8, line_q8

# layout: names that a board's own compiler reads
const = int
ptr32 = None
# layout: An axis
_LINE_LOW_Q4 = const(19)
_LINE_HIGH_Q4 = const(20)
_LINE_SAMPLES = const(21)
_LINE_POINTS = const(22)
_BEYOND = const(32)
_KIND = const(33)
_ESTIMATORS = const(40)
# layout: An estimator
_EST_BIAS_Q8 = const(2)
_EST_READINGS = const(3)
# layout: The corrector's settings
_LITERAL = const(23)
_ENOUGH_TO_FIT = const(33)
_STABLE = const(36)
_SHARE_Q8 = const(37)
_BEYOND_Q4 = const(38)
_EVERY = const(48)
# layout: Where a bias comes from
NONE = const(0)
ANY_TEMPERATURE = const(1)
FIT = const(2)
HERE = const(3)
IN_MOTION = const(4)
GRAVITY = const(5)
# layout: end


def choose(s: ptr32, c: ptr32, a: int, temp: int) -> int:
    """Return the source of the bias at `temp` and note whether it lies beyond the fitted range."""
    s[a + _BEYOND] = 0
    e = find(s, c, a, temp)
    if e > 0:
        e = s[e + _EST_READINGS]
        if e >= c[_STABLE] and e >= (s[a + _LINE_SAMPLES] >> 8) * c[_SHARE_Q8]:
            return HERE
    if s[a + _LINE_POINTS]:
        e = (temp << 4) + c[_BEYOND_Q4]
        if e < s[a + _LINE_LOW_Q4]:
            s[a + _BEYOND] = 1
        e = (temp << 4) - c[_BEYOND_Q4]
        if e > s[a + _LINE_HIGH_Q4]:
            s[a + _BEYOND] = 1
        return FIT
    e = s[a + _ESTIMATORS + _EST_READINGS]
    # by the document it must be stable; a vetted rest is worth something from the first on
    if e >= c[_ENOUGH_TO_FIT] or (e > 0 and c[_EVERY] == 0):
        return ANY_TEMPERATURE
    return NONE


def curve_q8(s: ptr32, c: ptr32, a: int, temp: int) -> int:
    """Return the learned bias at `temp`: LSB, Q8; 0 while there is none."""
    # By the document a stable estimator of this temperature speaks alone. By default it speaks with
    # its neighbours, through the local line, which also knows how the bias changes within a degree.
    kind = choose(s, c, a, temp)
    if kind == HERE and c[_LITERAL] == 0 and s[a + _LINE_POINTS]:
        kind = FIT
    s[a + _KIND] = kind
    if kind == NONE:
        return 0
    if kind == HERE:
        kind = find(s, c, a, temp)
        return s[kind + _EST_BIAS_Q8]
    if kind == ANY_TEMPERATURE:
        return s[a + _ESTIMATORS + _EST_BIAS_Q8]
    kind = bent_q8(s, a, temp << 4)
    return line_q8(s, a, temp << 4) + kind
