"""Many frames in one call, as a chip's FIFO gives them: what `step` does, faster."""

# Up to the last frame of a window nearly every frame is a good reading, and nothing but sums,
# counts and the correction changes. How many frames that is true of is found first; then sums and
# axes have each a loop of their own over them, whose few locals machine code keeps in registers.
# What is not plain at one look (a fault, a repeat, work that waits, a frame that ends a rest or a
# window) is left to `step`; both give the same, to the last bit. Frames on the stack are too large
# for bytecode, which would take heap for them: this is made into machine code only.
#
# A frame of `f` is eight words: us since the frame before, ax ay az temp gx gy gz in raw LSB.

from .step import step

# layout: names that a board's own compiler reads
const = int
ptr32 = None
# layout: The corrector's state
_FRAME = const(0)
_COUNTS = const(8)
_ELAPSED_US = const(16)
_WINDOW_N = const(17)
_WORK = const(18)
_WINDOW_SUM = const(38)
_SQUARE_ACCEL = const(45)
_SQUARE_GYRO = const(46)
_SQUARE_STEP = const(47)
_DIRTY = const(48)
_LAST_RATE = const(49)
_EFFECT_SUM_Q8 = const(52)
_REFERENCE = const(55)
_OUT_Q8 = const(63)
_TARGET_Q8 = const(66)
_CARRY_Q8 = const(72)
_EFFECT_Q8 = const(75)
# layout: The corrector's settings
_LEAP_US = const(1)
_JUMP_LSB = const(2)
_WINDOW = const(3)
_EVERY = const(48)
# layout: end
_MOST_US = const(0x1FFFFFFF)
_MOST_LEAP_US = const(0x1FFFFF)  # a window of them and _MOST_US fit 31 bits
_NEARLY_MOST_COUNT = const(0x1FFFFE00)
_FAR_FROM_RAILS = const(32000)


def stretch(s: ptr32, c: ptr32, n: int) -> int:
    """Return how many of the next n frames may be taken at one look: those within the window."""
    # None while anything but a plain reading is to be done: work waits, the correction is on its
    # way to its target, every reading is learned or published for its temperature.
    if s[_WORK] or c[_EVERY] or c[_WINDOW] == 4 or c[_LEAP_US] > _MOST_LEAP_US:
        return 0
    if s[_COUNTS] >> 2 < c[_WINDOW] or s[_COUNTS] > _NEARLY_MOST_COUNT:
        return 0
    if s[_OUT_Q8] != s[_TARGET_Q8] or s[_OUT_Q8 + 1] != s[_TARGET_Q8 + 1]:
        return 0
    if s[_OUT_Q8 + 2] != s[_TARGET_Q8 + 2]:
        return 0
    i = c[_WINDOW] - 1 - s[_WINDOW_N]
    return i if i < n else n


def plain(s: ptr32, f: ptr32, c: ptr32, p: int) -> int:
    """Return 1 if the frame at word p of f is a good reading at one look."""
    d = f[p + 4] - s[_FRAME + 3]
    if f[p] <= 0 or f[p] > c[_LEAP_US] or d >= c[_JUMP_LSB] or d <= -c[_JUMP_LSB]:
        return 0
    if f[p + 5] == s[_FRAME + 4] and f[p + 6] == s[_FRAME + 5] and f[p + 7] == s[_FRAME + 6]:
        return 0  # a repeat, perhaps
    if f[p + 5] == f[p + 6] and f[p + 6] == f[p + 7]:
        return 0  # all zeros or all ones, perhaps
    if f[p + 5] > _FAR_FROM_RAILS or f[p + 6] > _FAR_FROM_RAILS or f[p + 7] > _FAR_FROM_RAILS:
        return 0
    if f[p + 5] < -_FAR_FROM_RAILS or f[p + 6] < -_FAR_FROM_RAILS or f[p + 7] < -_FAR_FROM_RAILS:
        return 0
    return 1


def begin_window(s: ptr32, f: ptr32, p: int):
    """Let the frame at word p of f be what the window's sums are less."""
    for i in range(_WINDOW_SUM, _EFFECT_SUM_Q8 + 3):
        s[i] = 0
    for i in range(7):
        s[_REFERENCE + i] = f[p + 1 + i]


def followed(f: ptr32, c: ptr32, p: int, end: int) -> int:
    """Return the word behind the frames from p on that are plain, the first of them known to be."""
    # Their rates may stand at a rail: see `off_rails`.
    k = p + 8
    most = c[_JUMP_LSB]
    while k < end:
        if f[k] != f[k - 8]:
            if f[k] <= 0 or f[k] > c[_LEAP_US]:
                return k
        d = f[k + 4] - f[k - 4]
        if d < 0:
            d = 0 - d
        x = f[k + 5]
        if d >= most or x == f[k - 3]:
            if d >= most or (f[k + 6] == f[k - 2] and f[k + 7] == f[k - 1]):
                return k  # a jump, or a repeat, perhaps
        if x == f[k + 6] and x == f[k + 7]:
            return k  # all zeros or all ones, perhaps
        k += 8
    return end


def off_rails(f: ptr32, p: int, end: int) -> int:
    """Return the word behind the frames from p on of which no rate stands at a rail."""
    for k in range(p, end, 8):
        # sixteen bits of a rate are one too many where it is next to a rail
        far = (f[k + 5] + 32767) | (f[k + 6] + 32767) | (f[k + 7] + 32767)
        far |= (f[k + 5] + 32769) | (f[k + 6] + 32769) | (f[k + 7] + 32769)
        if far >> 16:
            return k
    return end


def near(s: ptr32, f: ptr32, p: int, end: int) -> int:
    """Return the word behind the frames from p on that stay near the window's first frame."""
    for k in range(p, end, 8):
        far = (f[k + 1] - s[_REFERENCE] + 512) | (f[k + 2] - s[_REFERENCE + 1] + 512)
        far |= (f[k + 3] - s[_REFERENCE + 2] + 512) | (f[k + 4] - s[_REFERENCE + 3] + 512)
        far |= (f[k + 5] - s[_REFERENCE + 4] + 512) | (f[k + 6] - s[_REFERENCE + 5] + 512)
        if (far | (f[k + 7] - s[_REFERENCE + 6] + 512)) >> 10:
            return k  # the window is no rest from here on
    return end


def add_accelerations(s: ptr32, f: ptr32, p: int, end: int):
    """Add the frames from word p on to the sums of the window's accelerations."""
    i = 0
    square = s[_SQUARE_ACCEL]
    while i < 3:
        reference = s[_REFERENCE + i]
        total = s[_WINDOW_SUM + i]
        i += 1
        for k in range(p + i, end, 8):
            d = f[k] - reference
            total += d
            square += d * d
        s[_WINDOW_SUM - 1 + i] = total
    s[_SQUARE_ACCEL] = square


def add_rates(s: ptr32, f: ptr32, p: int, end: int):
    """Add the frames from word p on to the sums of the window's rates."""
    for i in range(3):
        reference = s[_REFERENCE + 4 + i]
        total = 0
        square = 0
        steps = 0
        last = s[_LAST_RATE + i]
        for k in range(p + 5 + i, end, 8):
            d = f[k] - reference
            total += d
            square += d * d
            last = d - last
            steps += last * last
            last = d
        s[_WINDOW_SUM + 4 + i] += total
        s[_SQUARE_GYRO] += square
        s[_SQUARE_STEP] += steps
        s[_LAST_RATE + i] = last
        s[_EFFECT_SUM_Q8 + i] += s[_EFFECT_Q8 + i] * ((end - p) >> 3)


def account(s: ptr32, f: ptr32, p: int, end: int):
    """Count the frames from word p on; the last one is the frame before."""
    elapsed_us = s[_ELAPSED_US]
    total = s[_WINDOW_SUM + 3]
    reference = s[_REFERENCE + 3]
    s[_COUNTS] += (end - p) >> 3
    s[_WINDOW_N] += (end - p) >> 3
    for k in range(p, end, 8):
        elapsed_us += f[k]
        total += f[k + 4] - reference
        f[k] = 0
    s[_ELAPSED_US] = elapsed_us if elapsed_us < _MOST_US else _MOST_US
    s[_WINDOW_SUM + 3] = total
    for k in range(7):
        s[_FRAME + k] = f[end - 7 + k]


def correct(s: ptr32, f: ptr32, p: int, end: int):
    """Subtract the bias from the frames from word p on."""
    for i in range(3):
        bias = s[_OUT_Q8 + i] + s[_EFFECT_Q8 + i]
        # what is due to a rate, Q8: half an LSB and what was left over, less the bias
        due = s[_CARRY_Q8 + i] + 128 - bias
        for k in range(p + 5 + i, end, 8):
            f[k] += due >> 8
            due = (due & 255) - bias
        s[_CARRY_Q8 + i] = due + bias - 128


def take(s: ptr32, f: ptr32, c: ptr32, p: int, end: int) -> int:
    """Take frames from p on at one look each, up to one not plain; return the word behind them."""
    n = stretch(s, c, (end - p) >> 3)
    if n <= 0 or plain(s, f, c, p) == 0:
        return p
    if s[_WINDOW_N] == 0:
        begin_window(s, f, p)
    behind = p + (n << 3)
    dirty = s[_DIRTY]
    behind = off_rails(f, p, behind) if dirty else near(s, f, p, behind)
    if behind > p:
        behind = followed(f, c, p, behind)
        if dirty == 0:
            add_accelerations(s, f, p, behind)
            add_rates(s, f, p, behind)
        account(s, f, p, behind)
        correct(s, f, p, behind)
    return behind


def one(s: ptr32, f: ptr32, c: ptr32, x: ptr32, p: int):
    """Give the frame at word p to `step`."""
    for i in range(7):
        x[i] = f[p + 1 + i]
    f[p] = step(s, c, x, f[p])
    for i in range(4, 7):
        f[p + 1 + i] = x[i]


def block(s: ptr32, f: ptr32, c: ptr32, x: ptr32, n: int):
    """Take n frames of f and correct each in place; its first word becomes the guard's verdict."""
    # x: room for a frame.
    p = 0
    end = n << 3
    while p < end:
        behind = p
        if s[_WORK] == 0 and s[_WINDOW_N] < c[_WINDOW] - 1:
            behind = take(s, f, c, p, end)
        if behind == p:
            one(s, f, c, x, p)
            behind += 8
        p = behind
