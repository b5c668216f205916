# Generated from zerorate/step.py by `make viper`: edit that file, not this one.
"""One sample's way through the firmware, and the work that a full window leaves behind."""

import micropython


# Learning is spread over the samples of the next window, one small piece a sample, so that no
# sample waits for a whole refit.

try:
    from micropython import const
except ImportError:

    def const(value):
        return value


from .bias import curve_q8
from .estimators import learn
from .fit import centre, lean, settle, weigh
from .fixed import root
from .guard import check
from .recent import absorb, beyond_q8, grown_q8, hand_over
from .stillness import gather, judge

_SCRATCH = const(7)
_GOOD = const(8)
_ELAPSED_US = const(16)
_TOTALS = const(42)
_STILLNESS = const(46)
_SEGMENT = const(48)
_TEMP_TOTAL = const(45)
_TEMP = const(47)
_LEARN_TEMP = const(52)
_PHASE = const(53)
_OUT_Q8 = const(55)
_CARRY_Q8 = const(58)
_EFFECT_Q8 = const(61)
_TARGET_Q8 = const(67)
_QUALITY_Q8 = const(70)
_SOURCE = const(73)

_TOTAL = const(0)
_WEIGHT = const(1)
_READING = const(12)
_FROM = const(13)
_OFFSET_Q8 = const(24)
_AGE_MS = const(28)
_KIND = const(30)
_FIT_TEMP = const(31)

_AXES = const(0)
_SHIFT = const(4)
_SEGMENTS = const(5)
_SLEW_Q8 = const(11)
_PIECES = const(12)
_AXIS_WORDS = const(13)
_ALL = const(25)
_FORETOLD_Q8 = const(44)
_FLOOR_Q8 = const(37)
_STALE_LSB = const(43)
_MOST_SIGMA_Q6 = const(48)
_FULL_WEIGHT_Q12 = const(49)
_EVERY = const(46)


@micropython.viper
def correct(s: ptr32, c: ptr32, x: ptr32):
    """Subtract the bias from the frame in place.

    What rounding to whole LSB leaves over is carried to the next sample, so that no angle is lost
    in the sum. The bias follows its target no faster than the slew limit.
    """
    i = 0
    while i < 3:
        d = s[_TARGET_Q8 + i] - s[_OUT_Q8 + i]
        if d > c[_SLEW_Q8]:
            d = c[_SLEW_Q8]
        elif d < -c[_SLEW_Q8]:
            d = -c[_SLEW_Q8]
        s[_OUT_Q8 + i] += d
        d = (x[4 + i] << 8) - s[_OUT_Q8 + i] - s[_EFFECT_Q8 + i] + s[_CARRY_Q8 + i]
        x[4 + i] = (d + 128) >> 8
        s[_CARRY_Q8 + i] = d - (x[4 + i] << 8)
        i += 1


@micropython.viper
def publish(s_, c_, a: int, axis: int):
    """Write the axis' bias, source and quality for the temperature of the latest window."""
    s = ptr32(s_)
    c = ptr32(c_)
    bias = s[_TEMP]
    bias = int(curve_q8(s_, c_, a, bias)) + s[a + _OFFSET_Q8]
    if s[a + _KIND] == 0:
        return
    s[_TARGET_Q8 + axis] = bias
    if s[_SOURCE + axis] == 0:
        s[_OUT_Q8 + axis] = bias
    s[_SOURCE + axis] = s[a + _FROM] if s[a + _FROM] else s[a + _KIND]
    # flicker noise is common to all rests: no mean of theirs is better known than that
    bias = int(grown_q8(s_, a)) + (c[_FLOOR_Q8] << 1)
    bias += int(beyond_q8(s_, c_, a))
    if bias < 0x3FFFFF:
        bias = int(root(bias << 8))
    else:
        bias = int(root(bias)) << 4
    s[_QUALITY_Q8 + axis] = bias


@micropython.viper
def stale(s: ptr32, c: ptr32, a: int) -> int:
    """Return 1 if the line must be fitted again: something learned, or the temperature moved."""
    d = s[_TEMP] - s[a + _FIT_TEMP]
    if s[a + _WEIGHT] or c[_EVERY] or d > c[_STALE_LSB] or d < -c[_STALE_LSB]:
        s[a + _FIT_TEMP] = s[_TEMP]
        return 1
    return 0


@micropython.viper
def refit(s_, c_, a: int, piece: int):
    """Do one piece of the axis' line: 2 weighs, then two points a piece, then it settles."""
    c = ptr32(c_)
    half = c[_ALL] >> 1
    piece -= 2
    if piece == 0:
        weigh(s_, c_, a)
        return
    i = ((piece - 1) << 1) + 1
    if piece <= half:
        centre(s_, c_, a, i)
        i += 1
        if i < c[_ALL]:
            centre(s_, c_, a, i)
        return
    i -= half << 1
    lean(s_, c_, a, i)
    i += 1
    if i < c[_ALL]:
        lean(s_, c_, a, i)
    if piece == half << 1:
        settle(s_, c_, a)


@micropython.viper
def advance(s_, c_):
    """Do the next piece of work: an axis absorbs, learns, refits its line and publishes."""
    s = ptr32(s_)
    c = ptr32(c_)
    last = ((c[_ALL] >> 1) << 1) + 3
    axis = (s[_PHASE] - 1) // (last + 1)
    piece = (s[_PHASE] - 1) % (last + 1)
    a = c[_AXES] + axis * c[_AXIS_WORDS]
    s[_PHASE] += 1
    if piece == 0:
        if s[a + _WEIGHT] and int(absorb(s_, c_, a)) == 0:
            s[a + _WEIGHT] = 0
    elif piece == 1:
        if s[a + _WEIGHT]:
            learn(s_, c_, a)
        if int(stale(s_, c_, a)) == 0:
            s[_PHASE] += last - 2
    elif piece < last:
        refit(s_, c_, a, piece)
    else:
        if s[a + _WEIGHT] and c[_EVERY] == 0:
            hand_over(s_, c_, a)
        s[a + _WEIGHT] = 0
        publish(s_, c_, a, axis)
        if axis == 2:
            s[_PHASE] = 0


@micropython.viper
def foresay(s: ptr32, axis: int, bias: int, quality: int):
    """Publish a bias, LSB Q8, before anything was learned; 0 takes it back."""
    s[_TARGET_Q8 + axis] = bias
    s[_OUT_Q8 + axis] = bias
    s[_QUALITY_Q8 + axis] = quality
    s[_SOURCE + axis] = 1


@micropython.viper
def foretell(s_, c: ptr32, axis: int):
    """Publish the mean of the first rest once it is two windows long, before it is learned from.

    It is taken back at once when the rest turns out to be none.
    """
    s = ptr32(s_)
    if s[_STILLNESS] == 1 and s[_SEGMENT] > 1:
        n = s[_SEGMENT] << c[_SHIFT]
        level = (s[_TOTALS + axis] // n) << 8
        level += ((s[_TOTALS + axis] % n) << 8) // n
        foresay(s_, axis, level, c[_FORETOLD_Q8])
    elif s[_SOURCE + axis] == 1:
        foresay(s_, axis, 0, 0)
        s[_SOURCE + axis] = 0


@micropython.viper
def close(s_, c_):
    """Close a full window: what it says, and the work that follows from it."""
    s = ptr32(s_)
    c = ptr32(c_)
    while s[_PHASE]:
        advance(s_, c_)
    still = int(judge(s_, c_))
    if still:
        s[_LEARN_TEMP] = s[_TEMP_TOTAL] // c[_SEGMENTS]
    i = 0
    while i < 3:
        a = c[_AXES] + i * c[_AXIS_WORDS]
        s[a + _AGE_MS] += s[_ELAPSED_US] // 1000
        if s[a + _AGE_MS] > 0x3FFFFFF:
            s[a + _AGE_MS] = 0x3FFFFFF
        if s[a + _KIND] == 0 and c[_EVERY] == 0:
            foretell(s_, c_, i)
        if still and c[_EVERY] == 0:
            s[a + _TOTAL] = s[_TOTALS + i]
            s[a + _WEIGHT] = c[_SEGMENTS] << c[_SHIFT]
            s[a + _READING] = 0
        i += 1
    s[_ELAPSED_US] = 0
    s[_PHASE] = 1


@micropython.viper
def learn_at_once(s_, c_, x: ptr32):
    """Learn this very reading, moving or still, as the document does: it has no stillness test."""
    s = ptr32(s_)
    c = ptr32(c_)
    s[_LEARN_TEMP] = x[3]
    i = 0
    while i < 3:
        a = c[_AXES] + i * c[_AXIS_WORDS]
        s[a + _TOTAL] = x[4 + i]
        s[a + _WEIGHT] = 1
        learn(s_, c_, a)
        s[a + _WEIGHT] = 0
        i += 1


@micropython.viper
def wake(s_, c_, x: ptr32):
    """Publish at the first frame after power-on what is already known for its temperature."""
    s = ptr32(s_)
    s[_TEMP] = x[3]
    s[_PHASE] = 1
    while s[_PHASE]:
        advance(s_, c_)


@micropython.viper
def examine(s_, c_, x_, dt_us: int) -> int:
    """Return what the guard says of the frame `x`, `dt_us` after the one before."""
    return int(check(s_, c_, x_, dt_us))


@micropython.viper
def admit(s_, c_, x_, kind: int) -> int:
    """Learn from an examined frame, and do a piece of the work that waits; return its kind."""
    s = ptr32(s_)
    c = ptr32(c_)
    if kind == 0:
        if s[_GOOD] == 1:
            wake(s_, c_, x_)
        if c[_EVERY]:
            learn_at_once(s_, c_, x_)
        if int(gather(s_, c_, x_)):
            close(s_, c_)
    i = c[_PIECES]
    while i > 0 and s[_PHASE]:
        advance(s_, c_)
        i -= 1
    return kind


@micropython.viper
def finish(s_, c_, x_, kind: int) -> int:
    """Correct the frame in place and return its kind.

    Frames of all zeros or ones and beyond (see guard.py) are left as they are.
    """
    if kind < 3:
        correct(s_, c_, x_)
    return kind


@micropython.viper
def step(s_, c_, x_, dt_us: int) -> int:
    """Learn from the frame and correct it in place; return what the guard says of it."""
    kind = int(check(s_, c_, x_, dt_us))
    admit(s_, c_, x_, kind)
    if kind < 3:
        correct(s_, c_, x_)
    return kind


@micropython.viper
def speak(s: ptr32, c: ptr32, m: ptr32, w: int, axis: int):
    """Publish what another source found, whatever its quality, while nothing was learned at all."""
    if s[c[_AXES] + axis * c[_AXIS_WORDS] + _KIND] == 0:
        w += axis
        if m[w + 3] < 0x200000:
            s[_TARGET_Q8 + axis] = m[w]
            s[_OUT_Q8 + axis] = m[w]
            s[_QUALITY_Q8 + axis] = m[w + 3]
            s[_SOURCE + axis] = s[_SCRATCH]


@micropython.viper
def offer(s: ptr32, c: ptr32, m: ptr32, w: int, axis: int):
    """Let an axis absorb and learn the bias that another source found: LSB Q8 at m[w+axis].

    Its one sigma stands three words on. It weighs as many still readings as its quality is worth.
    """
    a = c[_AXES] + axis * c[_AXIS_WORDS]
    w += axis
    sigma = m[w + 3] >> 2
    if s[a + _WEIGHT] or sigma > c[_MOST_SIGMA_Q6]:
        return
    w = m[w] - s[_EFFECT_Q8 + axis]
    axis = c[_FULL_WEIGHT_Q12] // (sigma * sigma + 1)
    if axis > 256:
        axis = 256
    if axis > 0:
        s[a + _WEIGHT] = axis
        s[a + _TOTAL] = (w >> 4) * axis >> 4
        s[a + _READING] = (((sigma * sigma) >> 4) << 3) + s[_SCRATCH]


@micropython.viper
def consider(s_, c_, m_, w: int, source: int):
    """Take the bias that another source has found for three axes into the one decision."""
    s = ptr32(s_)
    while s[_PHASE]:
        advance(s_, c_)
    s[_LEARN_TEMP] = s[_TEMP]
    s[_SCRATCH] = source
    speak(s_, c_, m_, w, 0)
    speak(s_, c_, m_, w, 1)
    speak(s_, c_, m_, w, 2)
    offer(s_, c_, m_, w, 0)
    offer(s_, c_, m_, w, 1)
    offer(s_, c_, m_, w, 2)
    s[_PHASE] = 1
