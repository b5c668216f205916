"""One sample's way through the firmware, and the work that a full window leaves behind."""

# Learning is spread over the samples of the next window, a piece a sample, so that no sample waits
# for all of it. What an axis without anything to learn does is small: three share a sample.
#
# Of all kernels: a bytecode frame of more than eleven words (parameters, locals, what an expression
# holds) takes heap at every call. Only where none is left a parameter stands for a second thing,
# and a remark that begins "eleven words" says for what (host_tests/runtimes/test_kernel_rules.py).

from ..arithmetic.fixed import root
from .bias import curve_q8
from .estimators import find, learn_anywhere, learn_here
from .fit import bend, draw_line
from .guard import check
from .recent import (
    absorb,
    beyond_q8,
    gain_q14,
    grown_q8,
    keep_level,
    left_q8,
    mean_noise_q8,
    suspect_turn,
)
from .stillness import gather, hidden_q4, judge, seems_still, tilting_q4

# layout: names that a board's own compiler reads
const = int
ptr32 = None
# layout: The corrector's state
_COUNTS = const(8)
_ELAPSED_US = const(16)
_WINDOW_N = const(17)
_WORK = const(18)
_STILLNESS = const(19)
_SEGMENT_WINDOWS = const(21)
_TEMP = const(22)
_LEARN_TEMP = const(23)
_WINDOW_SUM = const(38)
_EFFECT_SUM_Q8 = const(52)
_REFERENCE = const(55)
_OUT_Q8 = const(63)
_TARGET_Q8 = const(66)
_QUALITY_Q8 = const(69)
_CARRY_Q8 = const(72)
_EFFECT_Q8 = const(75)
_SOURCE = const(78)
_SEGMENT_TEMP = const(84)
_TILTING_Q4 = const(86)
_SEGMENT_TOTAL = const(100)
_OFFERED_SOURCE = const(7)
_MEAN_NOISE_Q8 = const(26)
_GROWN_Q8 = const(27)
# layout: An axis
_WAITING_SUM = const(0)
_WAITING_N = const(1)
_OFFER = const(12)
_OFFSET_FROM = const(13)
_OFFSET_Q8 = const(27)
_OFFSET_VARIANCE_Q8 = const(28)
_OFFSET_AGE_MS = const(31)
_KIND = const(33)
_LINE_TEMP = const(34)
_FLOOR_Q16 = const(35)
_LEFT_Q4 = const(37)
_DOUBT_Q4 = const(38)
_HELD_Q4 = const(39)
_ESTIMATORS = const(40)
# layout: An estimator
_EST_SPREAD_Q8 = const(4)
# layout: The corrector's settings
_AXES = const(0)
_WINDOW = const(3)
_WINDOW_SHIFT = const(4)
_SLEW_Q8 = const(13)
_WORK_A_SAMPLE = const(14)
_AXIS_WORDS = const(15)
_LITERAL = const(23)
_GATE_Q4 = const(40)
_STALE_LSB = const(45)
_PROVISIONAL_Q8 = const(46)
_EVERY = const(48)
_MOST_SIGMA_Q6 = const(50)
_FULL_WEIGHT_Q12 = const(51)
# layout: What a window was
_STILL = const(1)
# layout: Values that stand for none
_NO_VALUE = const(-0x3FFFFFFF)
# layout: end
_TO_ABSORB = const(0)
_TO_LEARN_HERE = const(1)
_TO_DRAW = const(2)
_TO_BEND = const(3)


def sigma_q8(s: ptr32, c: ptr32, a: int) -> int:
    """Return one sigma of the axis' bias at the temperature of the latest window, LSB Q8."""
    # Flicker noise: each octave from a sample to a segment holds half of what segments differ by.
    variance = (c[_WINDOW_SHIFT] + 3) * (s[a + _FLOOR_Q16] >> 4) >> 5
    variance += s[_GROWN_Q8]
    doubt = s[a + _DOUBT_Q4]
    doubt = doubt if doubt > s[a + _HELD_Q4] else s[a + _HELD_Q4]
    if doubt < 0x1000:
        variance += doubt * doubt
        doubt = 0
    doubt = doubt << 4
    return doubt + (root(variance << 8) if variance < 0x3FFFFF else root(variance) << 4)


def moved_by_rest_q8(s: ptr32, c: ptr32, a: int, bias: int) -> int:
    """Return the bias, LSB Q8, moved by the rest so far, before that is learned or was none."""
    # A power-on begins with a bias known to some hundredth of a dps; a second of rest knows more. A
    # rest that lies two sigma off is rather a slow turn that gravity does not show yet.
    error = (a - c[_AXES]) // c[_AXIS_WORDS]
    error = (segment_mean_q8(s, c, error) - bias) >> 4
    n = s[_SEGMENT_WINDOWS] << c[_WINDOW_SHIFT]
    s[_MEAN_NOISE_Q8] = mean_noise_q8(s, c, a, n)
    if error > c[_GATE_Q4] or error < -c[_GATE_Q4]:
        return bias
    if error * error >> 2 > s[_GROWN_Q8] + s[_MEAN_NOISE_Q8]:
        return bias
    n = gain_q14(s[_GROWN_Q8], s[_MEAN_NOISE_Q8])
    s[_GROWN_Q8] = left_q8(s, n)
    error = n * error >> 10
    n = n * s[_TILTING_Q4] >> 14
    s[_GROWN_Q8] += n * n
    return bias + error


def publish(s: ptr32, c: ptr32, a: int, axis: int):
    """Write the axis' bias, source and quality for the temperature of the latest window."""
    bias = curve_q8(s, c, a, s[_TEMP]) + s[a + _OFFSET_Q8]
    if s[a + _KIND] == 0:
        return
    s[_GROWN_Q8] = grown_q8(s, a) + beyond_q8(s, c, a)
    if s[_STILLNESS] == _STILL and s[_SEGMENT_WINDOWS] and c[_EVERY] == 0 and c[_LITERAL] == 0:
        bias = moved_by_rest_q8(s, c, a, bias)
    s[_TARGET_Q8 + axis] = bias
    if s[_SOURCE + axis] == 0:
        s[_OUT_Q8 + axis] = bias
    s[_SOURCE + axis] = s[a + _OFFSET_FROM] if s[a + _OFFSET_FROM] else s[a + _KIND]
    s[_QUALITY_Q8 + axis] = sigma_q8(s, c, a)


def segment_mean_q8(s: ptr32, c: ptr32, axis: int) -> int:
    """Return the mean rate of the segment so far, LSB Q8."""
    n = s[_SEGMENT_WINDOWS] << c[_WINDOW_SHIFT]
    total = s[_SEGMENT_TOTAL + axis]
    whole = total // n
    return (whole << 8) + ((total - whole * n) << 8) // n


def stale(s: ptr32, c: ptr32, a: int) -> int:
    """Return 1 if the line must be fitted again: something learned, or the temperature moved."""
    d = s[_TEMP] - s[a + _LINE_TEMP]
    if s[a + _WAITING_N] or c[_EVERY] or d > c[_STALE_LSB] or d < -c[_STALE_LSB]:
        s[a + _LINE_TEMP] = s[_TEMP]
        return 1
    return 0


def advance(s: ptr32, c: ptr32):
    """Do the next piece of work; axes that have next to nothing to do are done on the way."""
    # An axis absorbs a segment and learns it for any temperature; learns it for its temperature;
    # draws its line again; bends it and publishes.
    axis = (s[_WORK] - 1) >> 2
    piece = (s[_WORK] - 1) & 3
    busy = 0
    while busy == 0 and axis < 3:
        a = c[_AXES] + axis * c[_AXIS_WORDS]
        busy = 1
        if piece == _TO_LEARN_HERE:
            learn_here(s, c, a)
            piece = _TO_DRAW
        elif piece == _TO_ABSORB and s[a + _WAITING_N]:
            piece = _TO_LEARN_HERE
            if absorb(s, c, a):
                learn_anywhere(s, c, a)
            else:
                s[a + _WAITING_N] = 0  # held back
                piece = _TO_DRAW
        elif piece < _TO_BEND and stale(s, c, a):
            draw_line(s, c, a)
            piece = _TO_BEND
        else:
            if piece < _TO_BEND:
                busy = 0
            else:
                bend(s, c, a)
            if s[a + _WAITING_N] and c[_EVERY] == 0 and c[_LITERAL] == 0:
                keep_level(s, c, a)
            s[a + _WAITING_N] = 0
            publish(s, c, a, axis)
            axis += 1
            piece = _TO_ABSORB
    s[_WORK] = (axis << 2) + piece + 1 if axis < 3 else 0


def publish_provisional(s: ptr32, axis: int, bias: int, quality: int):
    """Publish a bias, LSB Q8, before anything was learned; 0 takes it back."""
    s[_TARGET_Q8 + axis] = bias
    s[_OUT_Q8 + axis] = bias
    s[_QUALITY_Q8 + axis] = quality
    s[_SOURCE + axis] = 1


def publish_first_rest(s: ptr32, c: ptr32, axis: int):
    """Publish the mean of the first rest once it is two windows long, before it is learned from."""
    # One of the first windows of a power-on is enough: few are switched on in motion. It is taken
    # back at once when the rest turns out to be none. Another source's bias stands.
    if s[_SOURCE + axis] > 1:
        return
    if s[_STILLNESS] == _STILL and (s[_SEGMENT_WINDOWS] > 1 or s[_COUNTS] >> 2 < c[_WINDOW]):
        level = segment_mean_q8(s, c, axis)
        publish_provisional(s, axis, level, c[_PROVISIONAL_Q8])
        level = hidden_q4(s, c, axis) << 4
        s[_QUALITY_Q8 + axis] += level
    elif s[_SOURCE + axis] == 1:
        publish_provisional(s, axis, 0, 0)
        s[_SOURCE + axis] = 0


def publish_first_glance(s: ptr32, c: ptr32):
    """Publish the mean of the very first frames, a quarter of a window, if they seem still."""
    # The window's end confirms it or takes it back.
    shift = c[_WINDOW_SHIFT] - 2
    if c[_EVERY] or seems_still(s, c, shift) == 0:
        return
    i = 0
    while i < 3:
        if s[_SOURCE + i] == 0:
            bias = (s[_REFERENCE + 4 + i] << 8) - (s[_EFFECT_SUM_Q8 + i] >> shift)
            bias += (s[_WINDOW_SUM + 4 + i] << 8) >> shift
            publish_provisional(s, i, bias, c[_PROVISIONAL_Q8] << 1)
            bias = hidden_q4(s, c, i) << 4
            s[_QUALITY_Q8 + i] += bias
        i += 1


def end_window(s: ptr32, c: ptr32):
    """Close a full window: what it says, and the work that follows from it."""
    while s[_WORK]:
        advance(s, c)
    still = judge(s, c)
    if s[_STILLNESS] == _STILL and s[_SEGMENT_WINDOWS]:
        s[_TILTING_Q4] = tilting_q4(s, c)  # once for the three axes
    if still:
        s[_LEARN_TEMP] = s[_SEGMENT_TEMP] // still
    elapsed_ms = s[_ELAPSED_US] // 1000
    for i in range(3):
        a = c[_AXES] + i * c[_AXIS_WORDS]
        s[a + _OFFSET_AGE_MS] += elapsed_ms
        if s[a + _OFFSET_AGE_MS] > 0x3FFFFFF:
            s[a + _OFFSET_AGE_MS] = 0x3FFFFFF
        if still == 0 and s[a + _KIND] == 0 and c[_EVERY] == 0:
            publish_first_rest(s, c, i)
        if still and c[_EVERY] == 0:
            s[a + _WAITING_SUM] = s[_SEGMENT_TOTAL + i]
            s[a + _WAITING_N] = still << c[_WINDOW_SHIFT]
    if still and c[_EVERY] == 0:
        suspect_turn(s, c)
    s[_ELAPSED_US] = 0
    s[_WORK] = 1


def learn_at_once(s: ptr32, c: ptr32, x: ptr32):
    """Learn this very reading, moving or still, as the document does: it has no stillness test."""
    s[_LEARN_TEMP] = x[3]
    for i in range(3):
        a = c[_AXES] + i * c[_AXIS_WORDS]
        if s[a + _WAITING_N] == 0:  # else what another source found is being learned
            s[a + _WAITING_SUM] = x[4 + i]
            s[a + _WAITING_N] = 1
            learn_anywhere(s, c, a)
            learn_here(s, c, a)
            s[a + _WAITING_N] = 0


def power_on(s: ptr32, c: ptr32, axis: int):
    """Know the bias as well as this part repeats at this temperature, until a rest tells more."""
    a = c[_AXES] + axis * c[_AXIS_WORDS]
    if s[a + _LEFT_Q4] == _NO_VALUE:
        e = find(s, c, a, s[_TEMP])
        if e == 0:
            e = a + _ESTIMATORS
        s[a + _OFFSET_VARIANCE_Q8] = s[e + _EST_SPREAD_Q8]


def begin(s: ptr32, c: ptr32, x: ptr32):
    """Speak for the first frame's temperature, or each one's where windows are long."""
    # They are long at a few hertz, four frames. The first quarter of a window may already rest.
    if s[_COUNTS] == 1 or c[_WINDOW] == 4:
        s[_TEMP] = x[3]
        power_on(s, c, 0)
        power_on(s, c, 1)
        power_on(s, c, 2)
        s[_WORK] = 1
        while s[_WORK]:
            advance(s, c)
    if s[_WINDOW_N] == c[_WINDOW] >> 2 and s[_COUNTS] >> 2 < c[_WINDOW]:
        publish_first_glance(s, c)


def admit(s: ptr32, c: ptr32, x: ptr32, kind: int) -> int:
    """Learn from an examined frame, and do a piece of the work that waits; return its kind."""
    if kind == 0:
        if gather(s, c, x):
            end_window(s, c)
        if s[_COUNTS] >> 2 < c[_WINDOW] or c[_WINDOW] == 4:
            begin(s, c, x)
        if c[_EVERY]:
            learn_at_once(s, c, x)
    i = c[_WORK_A_SAMPLE]
    while s[_WORK] and i > 0:
        advance(s, c)
        i -= 1
    return kind


def finish(s: ptr32, c: ptr32, x: ptr32, kind: int) -> int:
    """Subtract the bias from the frame in place and return its kind."""
    # What rounding to whole LSB leaves over is carried to the next sample, so that no angle is lost
    # in the sum. The bias follows its target no faster than the slew limit. Frames of all zeros or
    # ones and beyond (see guard.py) are left as they are.
    i = 0
    if kind > 2:
        return kind
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
    return kind


def step(s: ptr32, c: ptr32, x: ptr32, dt_us: int) -> int:
    """Learn from the frame and correct it in place; return what the guard says of it."""
    kind = check(s, c, x, dt_us)
    admit(s, c, x, kind)
    return finish(s, c, x, kind)


def publish_offer(s: ptr32, c: ptr32, m: ptr32, w: int, axis: int):
    """Publish what another source found before anything was learned, if only roughly known."""
    # Eight times the uncertainty that may teach; beyond that a guess was often worse than none.
    if s[c[_AXES] + axis * c[_AXIS_WORDS] + _KIND] == 0:
        at = w + axis
        if s[_SOURCE + axis] and s[_SOURCE + axis] != s[_OFFERED_SOURCE]:
            if m[at + 3] >= s[_QUALITY_Q8 + axis]:
                return
        if m[at + 3] >> 5 < c[_MOST_SIGMA_Q6]:
            s[_TARGET_Q8 + axis] = m[at]
            if s[_SOURCE + axis] == 0:
                s[_OUT_Q8 + axis] = m[at]
            s[_QUALITY_Q8 + axis] = m[at + 3]
            s[_SOURCE + axis] = s[_OFFERED_SOURCE]


def readings_worth(c: ptr32, sigma: int) -> int:
    """Return for how many still readings a bias of that one sigma counts, at most 256."""
    n = c[_FULL_WEIGHT_Q12] // (sigma * sigma + 1)
    return n if n < 256 else 256


def sum_readings(s: ptr32, a: int):
    """Turn the bias that waits, LSB Q4, into the sum of so many readings, LSB."""
    # in two parts: the whole product would not fit
    bias_q4 = s[a + _WAITING_SUM]
    n = s[a + _WAITING_N]
    s[a + _WAITING_SUM] = (bias_q4 >> 4) * n + ((bias_q4 & 15) * n >> 4)


def offer(s: ptr32, c: ptr32, m: ptr32, w: int, axis: int):
    """Let an axis absorb and learn the bias that another source found: LSB Q8 at m[w+axis]."""
    # Its one sigma stands three words on. It weighs as many still readings as its quality is worth.
    a = c[_AXES] + axis * c[_AXIS_WORDS]
    sigma = m[w + 3 + axis] >> 2
    if s[a + _WAITING_N] or sigma > c[_MOST_SIGMA_Q6]:
        return
    s[a + _WAITING_N] = readings_worth(c, sigma)
    if s[a + _WAITING_N]:
        s[a + _WAITING_SUM] = m[w + axis] >> 4
        sum_readings(s, a)
        s[a + _OFFER] = (((sigma * sigma) >> 4) << 3) + s[_OFFERED_SOURCE]


def consider(s: ptr32, c: ptr32, m: ptr32, w: int, source: int):
    """Take the bias that another source has found for three axes into the one decision."""
    while s[_WORK]:
        advance(s, c)
    s[_LEARN_TEMP] = s[_TEMP]
    s[_OFFERED_SOURCE] = source
    publish_offer(s, c, m, w, 0)
    publish_offer(s, c, m, w, 1)
    publish_offer(s, c, m, w, 2)
    offer(s, c, m, w, 0)
    offer(s, c, m, w, 1)
    offer(s, c, m, w, 2)
    s[_WORK] = 1
