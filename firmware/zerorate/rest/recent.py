"""What the curve over temperature does not explain lately: turn-on offset, lag, drift."""

# One number an axis, added to the learned curve: a random walk seen through the mean of every still
# segment, weighed by a scalar Kalman filter. How fast it walks is learned from how far each segment
# lies from what was expected. A segment that lies implausibly far is learned only when it insists:
# a constant turn about the vertical looks just like it, but does not last. A turn is along
# gravity, while a bias that jumps has a direction of its own in the body.
#
# Variances are LSB^2 in Q8, the walk LSB^2/s in Q16.

from ..arithmetic.fixed import clipped, scaled
from .bias import curve_q8
from .estimators import find
from .stillness import hidden_q4, level_q4, share_q10, up

# layout: names that a board's own compiler reads
const = int
ptr32 = None
# layout: The corrector's state
_REST = const(20)
_TEMP = const(22)
_LEARN_TEMP = const(23)
_DRIFTED_Q4 = const(24)
_ANCHOR_SIZE = const(25)
_RESTS = const(62)
_TARGET_Q8 = const(66)
_NOISE_Q8 = const(81)
_MOVED_Q8 = const(88)
_BANK_Q10 = const(89)
_MEAN_NOISE_Q8 = const(26)
_GROWN_Q8 = const(27)
# layout: The last words before the axes
_TURN_ON_OFFSET_Q8 = const(-3)
# layout: An axis
_WAITING_SUM = const(0)
_WAITING_N = const(1)
_OFFER = const(12)
_OFFSET_FROM = const(13)
_LINE_LOW_Q4 = const(19)
_LINE_HIGH_Q4 = const(20)
_LINE_POINTS = const(22)
_CURVE_BEFORE_Q8 = const(26)
_OFFSET_Q8 = const(27)
_OFFSET_VARIANCE_Q8 = const(28)
_WALK_Q16 = const(29)
_SUSPECT = const(30)
_OFFSET_AGE_MS = const(31)
_KIND = const(33)
_FLOOR_Q16 = const(35)
_LEAVES_Q16 = const(36)
_LEFT_Q4 = const(37)
_DOUBT_Q4 = const(38)
_HELD_Q4 = const(39)
_ESTIMATORS = const(40)
# layout: An estimator
_EST_READINGS = const(3)
_EST_SPREAD_Q8 = const(4)
# layout: The corrector's settings
_AXES = const(0)
_WINDOW_SHIFT = const(4)
_SEGMENT = const(5)
_AXIS_WORDS = const(15)
_LITERAL = const(23)
_FLOOR_Q8 = const(39)
_GATE_Q4 = const(40)
_INSIST = const(41)
_WALK_LEAST_Q16 = const(42)
_WALK_MOST_Q16 = const(43)
_PROVISIONAL_Q8 = const(46)
_TURN_ON_VARIANCE_Q8 = const(47)
_EVERY = const(48)
_TURN_HALVES = const(55)
_ONE_G = const(57)
# layout: Values that stand for none
_NO_VALUE = const(-0x3FFFFFFF)
# layout: end
_MOST_DOUBT_Q4 = const(0x7FFFF)
_MOST_Q10 = const(724)  # half of its square: that axis is judged by its own error
_LEANT_Q10 = const(51)  # by the accelerometer's own offset, some 50 mg
_NEIGHBOURS_MS = const(4000)  # segments of one rest follow each other faster
_STEEPEST_Q16 = const(4095)  # times the farthest temperature it fits 31 bits


def grown_q8(s: ptr32, a: int) -> int:
    """Return the offset's variance now: what it was, and what it has walked since."""
    # Three seconds more than since the segment's end: a mean tells of its middle.
    seconds = (s[a + _OFFSET_AGE_MS] >> 10) + 3
    seconds = seconds if seconds < 2047 else 2047
    return s[a + _OFFSET_VARIANCE_Q8] + (((s[a + _WALK_Q16] >> 4) * seconds) >> 4)


def mean_noise_q8(s: ptr32, c: ptr32, a: int, n: int) -> int:
    """Return the variance of the mean of n still readings: their noise, and what no rest shows."""
    # A rest shorter than a segment hides a slow turn from gravity, half as long twice as much of
    # it.
    shorter = (c[_SEGMENT] << c[_WINDOW_SHIFT]) // n
    variance = s[a + _FLOOR_Q16] >> 8
    if shorter > 1:
        shorter = clipped(shorter * (c[_PROVISIONAL_Q8] >> 4) // 10, 0x3FFF)
        variance += shorter * shorter
    return s[_NOISE_Q8] // (3 * n) + variance


def waiting_noise_q8(s: ptr32, c: ptr32, a: int) -> int:
    """Return the same of the segment that waits."""
    return mean_noise_q8(s, c, a, s[a + _WAITING_N])


def beyond_q8(s: ptr32, c: ptr32, a: int) -> int:
    """Return the variance that this temperature adds where it lies outside the fitted range."""
    d = (s[_TEMP] << 4) - s[a + _LINE_HIGH_Q4]
    if d < 0:
        d = s[a + _LINE_LOW_Q4] - (s[_TEMP] << 4)
    if d < 0 or s[a + _LINE_POINTS] == 0:
        return 0
    sigma = clipped((clipped(d, 0x3FFFF) * s[a + _LEAVES_Q16]) >> 16, 0x3FFF)
    return sigma * sigma


def error_q4(s: ptr32, c: ptr32, a: int) -> int:
    """Return how far the waiting segment lies from what was expected: LSB, Q4."""
    before = s[_LEARN_TEMP]
    before = curve_q8(s, c, a, before)
    s[a + _CURVE_BEFORE_Q8] = before
    mean = s[a + _WAITING_SUM] % s[a + _WAITING_N]
    mean = (mean << 8) // s[a + _WAITING_N]
    mean += (s[a + _WAITING_SUM] // s[a + _WAITING_N]) << 8
    return (mean - before - s[a + _OFFSET_Q8]) >> 4


def move_offset(s: ptr32, a: int, by: int):
    """Move the axis' offset, LSB Q8; it stays within twice what a word of the sensor says."""
    s[a + _OFFSET_Q8] = clipped(s[a + _OFFSET_Q8] + by, 0xFFFFFF)


def well_known(s: ptr32, c: ptr32, a: int) -> int:
    """Return 1 if the axis has learned from as long a rest as must insist, and since power-on."""
    if s[a + _LEFT_Q4] == _NO_VALUE:
        return 0
    n = c[_INSIST] * c[_SEGMENT]
    return 1 if s[a + _ESTIMATORS + _EST_READINGS] >> c[_WINDOW_SHIFT] >= n else 0


def off_q1(s: ptr32, c: ptr32, axis: int) -> int:
    """Return how far the waiting segment lies from the bias that is subtracted: LSB, Q1."""
    a = c[_AXES] + axis * c[_AXIS_WORDS]
    n = s[a + _WAITING_N]
    mean = s[a + _WAITING_SUM]
    mean = ((mean // n) << 8) + ((mean % n) << 8) // n
    return clipped((mean - s[_TARGET_Q8 + axis]) >> 7, 0x3FFF)


def suspect_turn(s: ptr32, c: ptr32):
    """Note for the waiting segment of every axis what it may hide, and whether it may be a turn."""
    turn = may_turn(s, c)
    for axis in range(3):
        note(s, c, axis, turn)


def may_turn(s: ptr32, c: ptr32) -> int:
    """Return 1 if the segment may be a turn; leave at _GROWN_Q8 the one it shows: LSB, Q1."""
    # It may where its error is along gravity, or too small to show yet, and the bias is well known:
    # from as long a rest as must insist, and found again since power-on. Along: within 22 degrees,
    # and the bank that more than 1 g tells. It shows one beyond the gate.
    g = s[_ANCHOR_SIZE]
    if g == 0:
        return 0
    turn = 0
    aside = 0
    i = 0
    while i < 3:
        off = off_q1(s, c, i)
        aside += off * off
        off = off * up(s, i)
        turn += off
        i += 1
    turn = clipped(turn // g, 0x6FFF)  # gravity of a few LSB is rounded down to less
    aside -= turn * turn
    off = turn if turn > 0 else 0 - turn
    s[_GROWN_Q8] = turn if off > c[_GATE_Q4] >> 3 else 0
    off = s[_BANK_Q10]
    turn = turn * clipped(410 + off, 1024) >> 10
    g = level_q4(s, c) >> 2  # Q1, twice
    return 1 if aside <= turn * turn + g * g else 0


def note(s: ptr32, c: ptr32, axis: int, turn: int):
    """As suspect_turn, for one axis."""
    # _OFFER: minus four times what the segment may hide, LSB Q4, minus 2 where the axis shares more
    # of a turn that is seen along gravity than its noise is, and minus 1 where it may be a turn.
    a = c[_AXES] + axis * c[_AXIS_WORDS]
    share = hidden_q4(s, c, axis)
    s[a + _OFFER] = 0 - 4 * share
    if turn and well_known(s, c, a):
        share = shares(s, c, a, axis)
        share += share + 1
        s[a + _OFFER] -= share


def shares(s: ptr32, c: ptr32, a: int, axis: int) -> int:
    """Return 1 if the axis shares more of the turn that is seen than its noise, but not most."""
    if s[_GROWN_Q8] == 0:
        return 0
    share = share_q10(s, axis)
    if share >= _MOST_Q10:
        return 0
    share = clipped(s[_GROWN_Q8] * (share + _LEANT_Q10) >> 7, 0x7FFF)
    return 1 if share * share > waiting_noise_q8(s, c, a) else 0


def hold(s: ptr32, a: int, error: int) -> int:
    """Note the error that is held back; return how many segments before it agreed with it."""
    far = clipped(error if error > 0 else 0 - error, _MOST_DOUBT_Q4)
    off = far - s[a + _HELD_Q4]
    s[a + _HELD_Q4] = far
    far = far >> 3
    return 0 if off > far or off < 0 - far else s[a + _SUSPECT]


def insists(s: ptr32, c: ptr32, a: int, error: int) -> int:
    """Hold the implausible segment back; return 1 once such ones have lasted long enough."""
    # What may be a turn does not count before ten halvings: of a thousand turns one lasts so long.
    # What is none goes on counting in another pose, where a turn would be about another axis.
    n = hold(s, a, error)
    if n or (s[a + _OFFER] & 1) == 0 or s[_REST] > 10 * c[_TURN_HALVES]:
        n += 1
    s[a + _SUSPECT] = n
    return 1 if n >= c[_INSIST] else 0


def plausible(s: ptr32, c: ptr32, a: int, error: int) -> int:
    """Return 1 if the error is within the gate or six sigma, or has insisted long enough."""
    # A temperature at which nothing was learned yet widens the six sigma by the slope that is left.
    # A rest that motion ended early has two sigma: gravity had no time to show a slow turn. What
    # may be a turn has three.
    share = 36
    far = clipped(error, 0x7FFF)
    if s[a + _WAITING_N] < c[_SEGMENT] << c[_WINDOW_SHIFT]:
        share = 4
    elif s[a + _OFFER] & 1:
        share = 9
    elif far <= c[_GATE_Q4] and far >= -c[_GATE_Q4]:
        far = 0
    far = far * far // share
    share = beyond_q8(s, c, a)
    if far <= s[_GROWN_Q8] + s[_MEAN_NOISE_Q8] + share:
        s[a + _SUSPECT] = 0
        return 1
    if insists(s, c, a, error) == 0:
        return 0
    s[a + _SUSPECT] = 0
    move_offset(s, a, error << 4)
    # it jumped at whatever temperature: that is no slope of its curve
    share = c[_AXES] + _TURN_ON_OFFSET_Q8 + (a - c[_AXES]) // c[_AXIS_WORDS]
    s[share] = clipped(s[share] + (error << 4), 0xFFFFFF)
    return 2


def learn_walk(s: ptr32, c: ptr32, a: int, error: int):
    """Learn the speed of the walk from the squared error that noise does not explain."""
    excess = error * error - s[a + _OFFSET_VARIANCE_Q8]
    excess -= s[_MEAN_NOISE_Q8]
    guess = beyond_q8(s, c, a)  # eleven words: the variance of a guess at this temperature
    # of one point no slope is known: a jump to another temperature is the curve's, and no walk
    if s[a + _LINE_POINTS] > 1 or excess >> 4 > guess or excess < c[_TURN_ON_VARIANCE_Q8] << 2:
        rewalk(s, c, a, excess)


def rewalk(s: ptr32, c: ptr32, a: int, excess: int):
    """Move the speed of the walk towards what such an excess over the offset's age tells."""
    age = (s[a + _OFFSET_AGE_MS] >> 6) + 1
    speed = (clipped(excess, 0x1FFFFF) << 8) // age
    speed = clipped(speed, 0x17FFFFF) << 4  # forty times it, the share of a short age, fits
    speed = speed if speed < c[_WALK_MOST_Q16] else c[_WALK_MOST_Q16]
    # long gaps tell more of the walk than neighbours do, and one of them little
    age = age if age < 1023 else 1023
    speed = (speed - s[a + _WALK_Q16]) >> 4
    share = age * age
    share = share // ((share + 0x100000) >> 10)
    share = share if share > 24 else 24
    speed = (speed * share >> 12) << 4
    s[a + _WALK_Q16] += speed
    if s[a + _WALK_Q16] < c[_WALK_LEAST_Q16]:
        s[a + _WALK_Q16] = c[_WALK_LEAST_Q16]


def gain_q14(variance: int, noise: int) -> int:
    """Return variance / (variance + noise) in Q14."""
    v = variance
    n = noise
    while v + n > 0x7FFF:
        v = v >> 1
        n = n >> 1
    return (v << 14) // (v + n + 1)


def left_q8(s: ptr32, gain: int) -> int:
    """Return the variance that a segment taken with that gain, Q14, leaves."""
    noise = s[_MEAN_NOISE_Q8]
    return gain * (noise >> 14) + (gain * (noise & 0x3FFF) + 0x2000 >> 14)


def relearn_slope(s: ptr32, c: ptr32, a: int, square: int):
    """Learn how fast the bias leaves the line, where most of what was expected is that."""
    # Of three errors one is beyond one sigma, so it rises by twice what it falls. By the document
    # the line is straight through all, and what it leaves here says nothing of elsewhere.
    away = beyond_q8(s, c, a)
    known = s[_GROWN_Q8] + s[_MEAN_NOISE_Q8]
    if away > known >> 1 and c[_LITERAL] == 0:
        slope = s[a + _LEAVES_Q16]
        if square > known + away:
            slope += (slope >> 4) + 1
        else:
            slope -= slope >> 5
        s[a + _LEAVES_Q16] = clipped(slope, _STEEPEST_Q16)


def approach(s: ptr32, k: int, found: int, shift: int):
    """Move a learned word towards what was found now."""
    s[k] += (found - s[k]) >> shift


def relearn_floor(s: ptr32, c: ptr32, a: int, error: int):
    """Learn by how much rests differ beyond their white noise and the walk."""
    # What was believed first counts eight times; of what was learned the latest 128. Half the
    # squared difference of neighbours is its own; an error after a gap counts by the share it has.
    d = error - s[a + _LEFT_Q4]
    d = clipped(d, 0x3FFF)
    d = (d * d >> 1) - (s[a + _WALK_Q16] >> 8)
    weight = 0x8000
    if s[a + _OFFSET_AGE_MS] > _NEIGHBOURS_MS:
        d = error * error - s[_GROWN_Q8]
        n = s[_GROWN_Q8] + s[_MEAN_NOISE_Q8]
        weight = (s[a + _FLOOR_Q16] >> 8) + c[_FLOOR_Q8]
        weight = gain_q14(weight, n) << 3
    n = 3 * s[a + _WAITING_N]
    d = clipped(d - s[_NOISE_Q8] // n, c[_FLOOR_Q8] << 6)
    n = c[_SEGMENT] << c[_WINDOW_SHIFT]
    n = s[a + _ESTIMATORS + _EST_READINGS] // n + 8
    d = ((d << 8) - s[a + _FLOOR_Q16]) // (n if n < 128 else 128)
    d = scaled(d, weight, 15)
    s[a + _FLOOR_Q16] += d
    if s[a + _FLOOR_Q16] < 0x100:
        s[a + _FLOOR_Q16] = 0x100


def relearn_spread(s: ptr32, c: ptr32, a: int, square: int):
    """Learn how far this power-on began from what was known, here and at any temperature."""
    d = clipped(square - s[_MEAN_NOISE_Q8], 0x3FFFFFF)
    d = d if d > 0 else 0
    approach(s, a + _ESTIMATORS + _EST_SPREAD_Q8, d, 2)
    e = s[_LEARN_TEMP]
    e = find(s, c, a, e)
    if e:
        approach(s, e + _EST_SPREAD_Q8, d, 2)


def doubt(s: ptr32, a: int, error: int):
    """Let a segment of that error, LSB Q4, tell how much of the bias may still be a turn."""
    hidden = (0 - s[a + _OFFER]) >> 2
    held = s[a + _DOUBT_Q4]
    if error * error // 9 > s[_GROWN_Q8] + s[_MEAN_NOISE_Q8]:
        # it moves the bias, perhaps by a turn
        far = error if error > 0 else 0 - error
        hidden = hidden if hidden < far else far
        held = held if held > hidden else hidden
    elif s[a + _LEFT_Q4] == _NO_VALUE:
        held = 0  # no turn begins again as it was before a power-off
    elif s[_DRIFTED_Q4] or held > hidden:
        held = hidden
    s[a + _DOUBT_Q4] = held


def calibrate(s: ptr32, c: ptr32, a: int, error: int):
    """Learn from a segment's error, LSB Q4, how sure of its bias this very part may be."""
    relearn_slope(s, c, a, error * error)
    doubt(s, a, error)
    if s[a + _LEFT_Q4] == _NO_VALUE:
        relearn_spread(s, c, a, error * error)
    elif s[a + _OFFSET_FROM] == 0:
        relearn_floor(s, c, a, error)


def drift(s: ptr32, c: ptr32, a: int, by: int):
    """Note that the offset moves by so much, LSB Q8: along gravity a slow turn moves it as well."""
    # From a rest's second segment on, for the first may move it by what the power-on begins off.
    # More than three sigma of that in one rest may be a turn that began slowly.
    moved = clipped(by, 0x3FFFF) * up(s, (a - c[_AXES]) // c[_AXIS_WORDS])
    moved = s[_MOVED_Q8] + (moved + (c[_ONE_G] >> 1)) // c[_ONE_G]
    if s[_REST] < 2 or s[_REST] > 10 * c[_TURN_HALVES]:
        moved = 0
        s[_DRIFTED_Q4] = 0
    s[_MOVED_Q8] = moved
    moved = clipped((moved if moved > 0 else 0 - moved) >> 4, 0x7FFF)
    if moved > s[_DRIFTED_Q4] and moved * moved // 9 > c[_TURN_ON_VARIANCE_Q8]:
        s[_DRIFTED_Q4] = moved


def follow(s: ptr32, c: ptr32, a: int, error: int):
    """Move the offset towards the error by the Kalman gain, and learn the walk from the error."""
    learn_walk(s, c, a, error)
    gain = gain_q14(s[_GROWN_Q8], s[_MEAN_NOISE_Q8])
    by = (gain * error) >> 10
    move_offset(s, a, by)
    drift(s, c, a, by)
    s[a + _LEFT_Q4] = error - (by >> 4)
    s[a + _OFFSET_VARIANCE_Q8] = left_q8(s, gain)


def level_q8(s: ptr32, c: ptr32, a: int) -> int:
    """Return the axis' turn-on offset, LSB in Q8: what the curve must not learn of it."""
    # What the first minute of rests lies off the curve, less the share that the curve itself may be
    # off where it is asked beyond what it has learned.
    k = c[_AXES] + _TURN_ON_OFFSET_Q8 + (a - c[_AXES]) // c[_AXIS_WORDS]
    if s[_RESTS] < c[_INSIST]:
        off = clipped(s[a + _OFFSET_Q8] >> 4, 0x3FFF)
        usual = off * off
        usual = usual if usual > c[_TURN_ON_VARIANCE_Q8] else c[_TURN_ON_VARIANCE_Q8]
        s[k] = beyond_q8(s, c, a)
        usual = gain_q14(s[k], usual)
        s[k] = s[a + _OFFSET_Q8] - (off * usual >> 10)
    return s[k]


def remove_turn_on(s: ptr32, c: ptr32, a: int):
    """Take the turn-on offset out of what the estimators are about to learn."""
    if a == c[_AXES] and s[_RESTS] < c[_INSIST]:
        s[_RESTS] += 1
    off = level_q8(s, c, a)
    n = s[a + _WAITING_N]
    off = s[a + _WAITING_SUM] - ((off >> 8) * n + ((off & 0xFF) * n + 128 >> 8))
    s[a + _WAITING_SUM] = clipped(off, n * 0x7FFF)


def contradicts(s: ptr32, c: ptr32, a: int, error: int, noise: int) -> int:
    """Return 1 if another source lies beyond the gate and three sigma; hold it back."""
    # It may be a turn as well, so it must last as long as a rest that may be one.
    known = clipped(s[a + _DOUBT_Q4], 0x3FFF)
    known = known * known + noise
    far = beyond_q8(s, c, a)
    known += far
    far = grown_q8(s, a)
    known += clipped(far, 0xFFFFFFF)
    far = clipped(error if error > 0 else 0 - error, 0x3FFF)
    if well_known(s, c, a) == 0 or far <= c[_GATE_Q4] or far * far // 9 <= known:
        return 0
    far = hold(s, a, error) + 1
    s[a + _SUSPECT] = far
    return 1 if far < 10 * c[_TURN_HALVES] >> 2 else 0


def take_over(s: ptr32, c: ptr32, a: int, error: int) -> int:
    """Let what another source found be the level if it is known twice as well as the level is."""
    # That source is a filter itself: to weigh its results into another one counted them twice, and
    # what it says supersedes what it said before. What is not so well known does not teach the
    # curve either: where rests exist, it stays theirs.
    noise = (s[a + _OFFER] >> 3) + (s[a + _FLOOR_Q16] >> 7)
    if s[a + _KIND] == 0:
        s[a + _SUSPECT] = -1
        s[_RESTS] = c[_INSIST]
    elif noise << 2 >= grown_q8(s, a) and s[a + _OFFSET_FROM] != s[a + _OFFER] & 7:
        return 0
    elif contradicts(s, c, a, error, noise):
        return 0
    else:
        move_offset(s, a, error << 4)
    s[a + _OFFSET_FROM] = s[a + _OFFER] & 7
    s[a + _LEFT_Q4] = 0
    s[a + _OFFSET_VARIANCE_Q8] = noise
    s[a + _OFFSET_AGE_MS] = 0
    return 1


def absorb(s: ptr32, c: ptr32, a: int) -> int:
    """Take the waiting segment into the offset; return 1 if the estimators may learn it."""
    # The very first one is all curve and no offset.
    s[_MEAN_NOISE_Q8] = waiting_noise_q8(s, c, a)
    error = error_q4(s, c, a)
    if update_offset(s, c, a, error) == 0:
        return 0
    remove_turn_on(s, c, a)
    return 1


def update_offset(s: ptr32, c: ptr32, a: int, error: int) -> int:
    """Let the waiting segment, so far off, move the offset or not; return 1: it may be learned."""
    if c[_LITERAL] or c[_EVERY]:
        return 1  # the document has its curve alone: what others found are readings of it
    if s[a + _OFFER] > 0:
        return take_over(s, c, a, error)
    verdict = 2
    held = 0
    if s[a + _KIND]:
        s[_GROWN_Q8] = grown_q8(s, a)
        verdict = plausible(s, c, a, error)
        if verdict == 0 or (verdict == 1 and (0 - s[a + _OFFER]) & 2):
            return 0  # the other axes of a turn have their shares of it
        held = clipped(error, 0x3FFF)
        calibrate(s, c, a, held)
    elif s[a + _WAITING_N] <= 8 and s[a + _WAITING_N] < c[_SEGMENT] << c[_WINDOW_SHIFT]:
        return 0  # the crest of a slow wave looks as still, and nothing is known to doubt it by
    else:
        s[a + _SUSPECT] = -1
        s[_RESTS] = c[_INSIST]
        s[a + _OFFSET_Q8] = 0
    s[a + _OFFSET_FROM] = 0
    if verdict == 1:
        follow(s, c, a, held)
    else:
        s[a + _OFFSET_VARIANCE_Q8] = s[_MEAN_NOISE_Q8]
        s[a + _LEFT_Q4] = 0
        # it may as well be a turn, and then all of it is wrong
        held = s[a + _HELD_Q4] - (s[a + _HELD_Q4] >> 2)
        verdict = (0 - s[a + _OFFER]) >> 2
        s[a + _DOUBT_Q4] = verdict if verdict > held else held
    s[a + _HELD_Q4] = 0
    s[a + _OFFSET_AGE_MS] = 0
    return 1


def keep_level(s: ptr32, c: ptr32, a: int):
    """Keep the level: what the curve has just learned at this temperature leaves the offset."""
    if s[a + _SUSPECT] < 0:
        s[a + _SUSPECT] = 0
    else:
        after = s[_LEARN_TEMP]
        after = curve_q8(s, c, a, after)
        move_offset(s, a, s[a + _CURVE_BEFORE_Q8] - after)
