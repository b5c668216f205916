"""Many frames in one call, as a chip's FIFO gives them: what `step` does, faster."""

# Between the first and the last frame of a window nearly every frame is a good reading, and nothing
# but sums, counts and the correction changes. Such a stretch is taken here in one loop over locals,
# which cost machine code half of what words of the state do; a frame that begins a window or ends a
# rest is gathered before and behind it. Whatever is not plain at one look (a fault, a repeat, work
# that waits, a window's last frame) is left to `step`; both give the same, to the last bit.
#
# Its frame on the stack is too large for bytecode, which would take heap for it: it is made into
# machine code only.
#
# A frame of `f` is eight words: us since the frame before, ax ay az temp gx gy gz in raw LSB.
# `r` is room for seven of them, and behind it two words that say what is left to do.

try:
    from micropython import const
except ImportError:

    def const(value):
        return value


ptr32 = None


from .step import step
from .stillness import gather

# layout: The corrector's state
_FRAME = const(0)
_COUNTS = const(8)
_ELAPSED_US = const(16)
_WINDOW_N = const(17)
_DIRTY = const(18)
_REFERENCE = const(19)
_WINDOW_SUM = const(26)
_SQUARE_ACCEL = const(33)
_SQUARE_GYRO = const(35)
_WORK = const(55)
_OUT_Q8 = const(57)
_CARRY_Q8 = const(60)
_EFFECT_Q8 = const(63)
_EFFECT_SUM_Q8 = const(66)
_TARGET_Q8 = const(69)
_SQUARE_STEP = const(78)
_LAST_RATE = const(79)
# layout: The corrector's settings
_LEAP_US = const(1)
_JUMP_LSB = const(2)
_WINDOW = const(3)
_EVERY = const(46)
# layout: end

_AT = const(7)  # the word of f at which the next frame begins
_END = const(8)  # and that behind the last one


_MOST_US = const(0x1FFFFFFF)
_MOST_LEAP_US = const(0x1FFFFF)  # a window of them and _MOST_US fit 31 bits
_NEARLY_MOST_COUNT = const(0x1FFFFE00)
_FAR_FROM_RAILS = const(32000)


def stretch(s: ptr32, c: ptr32, r: ptr32) -> int:
    """Return how many of the next frames may be taken at one look: those within the window.

    None while anything but a plain reading is to be done: work waits, the correction is on its way
    to its target, every reading is learned or published for its temperature.
    """
    if s[_WORK] or c[_EVERY] or c[_WINDOW] == 4 or c[_LEAP_US] > _MOST_LEAP_US:
        return 0
    if s[_COUNTS] == 0 or s[_COUNTS] > _NEARLY_MOST_COUNT:
        return 0
    if s[_OUT_Q8] != s[_TARGET_Q8] or s[_OUT_Q8 + 1] != s[_TARGET_Q8 + 1]:
        return 0
    if s[_OUT_Q8 + 2] != s[_TARGET_Q8 + 2]:
        return 0
    i = c[_WINDOW] - 1 - s[_WINDOW_N]
    n = (r[_END] - r[_AT]) >> 3
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


def edge(s: ptr32, f: ptr32, c: ptr32, r: ptr32, k: int) -> int:
    """Take the next frame, which may begin a window or end its rest, if k and it is plain.

    Returns 0 if it was not taken. What begins a window is so far from the rails that what is near
    to it is no rail either.
    """
    p = r[_AT]
    if k:
        k = plain(s, f, c, p)
    if k:
        i = 0
        while i < 7:
            r[i] = f[p + 1 + i]
            s[_FRAME + i] = r[i]
            i += 1
        s[_COUNTS] += 1
        i = s[_ELAPSED_US] + f[p]
        s[_ELAPSED_US] = i if i < _MOST_US else _MOST_US
    if k:
        gather(s, c, r)
    if k:
        i = 0
        while i < 3:
            d = (r[4 + i] << 8) - s[_OUT_Q8 + i] - s[_EFFECT_Q8 + i] + s[_CARRY_Q8 + i] + 128
            f[p + 5 + i] = d >> 8
            s[_CARRY_Q8 + i] = (d & 255) - 128
            i += 1
        f[p] = 0
        r[_AT] = p + 8
    return k


def account(s: ptr32, f: ptr32, p: int, taken: int, elapsed_us: int):
    """Count the frames before word p of f that were taken; the last one is the frame before."""
    s[_FRAME] = f[p - 7]
    s[_FRAME + 1] = f[p - 6]
    s[_FRAME + 2] = f[p - 5]
    s[_FRAME + 3] = f[p - 4]
    s[_COUNTS] += taken
    s[_WINDOW_N] += taken
    elapsed_us += s[_ELAPSED_US]
    s[_ELAPSED_US] = elapsed_us if elapsed_us < _MOST_US else _MOST_US


def take(s: ptr32, f: ptr32, c: ptr32, r: ptr32):
    """Take frames at one look each, up to the window's last or to one that is not plain."""
    left = stretch(s, c, r)
    d = 1 if left and s[_WINDOW_N] == 0 else 0
    n = edge(s, f, c, r, d)
    if d:
        left = left - 1 if n else 0
    p = r[_AT]
    n = left
    moving = s[_DIRTY]
    leap_us = c[_LEAP_US]
    usual_us = leap_us
    since = p
    elapsed_us = 0
    most_jump = c[_JUMP_LSB] - 1
    least_jump = 1 - c[_JUMP_LSB]
    # what is as near to the temperature before costs one comparison less
    near = 256 if c[_JUMP_LSB] > 256 else 0
    near_bits = 9 if near else 0
    last_t = s[_FRAME + 3]
    last_x = s[_FRAME + 4]
    last_y = s[_FRAME + 5]
    last_z = s[_FRAME + 6]
    ref_a = s[_REFERENCE]
    ref_b = s[_REFERENCE + 1]
    ref_c = s[_REFERENCE + 2]
    ref_t = s[_REFERENCE + 3]
    ref_x = s[_REFERENCE + 4]
    ref_y = s[_REFERENCE + 5]
    ref_z = s[_REFERENCE + 6]
    sum_a = s[_WINDOW_SUM]
    sum_b = s[_WINDOW_SUM + 1]
    sum_c = s[_WINDOW_SUM + 2]
    sum_t = s[_WINDOW_SUM + 3]
    sum_x = s[_WINDOW_SUM + 4]
    sum_y = s[_WINDOW_SUM + 5]
    sum_z = s[_WINDOW_SUM + 6]
    square_accel = s[_SQUARE_ACCEL]
    square_gyro = s[_SQUARE_GYRO]
    square_step = s[_SQUARE_STEP]
    # what is due to a rate, Q8: half an LSB and what was left over, less the bias
    bias_x = s[_OUT_Q8] + s[_EFFECT_Q8]
    bias_y = s[_OUT_Q8 + 1] + s[_EFFECT_Q8 + 1]
    bias_z = s[_OUT_Q8 + 2] + s[_EFFECT_Q8 + 2]
    due_x = s[_CARRY_Q8] + 128 - bias_x
    due_y = s[_CARRY_Q8 + 1] + 128 - bias_y
    due_z = s[_CARRY_Q8 + 2] + 128 - bias_z
    while left:
        if f[p] != usual_us:
            if f[p] <= 0 or f[p] > leap_us:
                break
            elapsed_us += ((p - since) >> 3) * usual_us
            since = p
            usual_us = f[p]
        t = f[p + 4]
        d = t - last_t
        if (d + near) >> near_bits:
            if d > most_jump or d < least_jump:
                break
        x = f[p + 5]
        y = f[p + 6]
        z = f[p + 7]
        if x == last_x and y == last_y and z == last_z:
            break  # a repeat, perhaps
        if x == y and y == z:
            break  # all zeros or all ones, perhaps
        if moving:
            if ((x + 16384) | (y + 16384) | (z + 16384)) >> 15:
                if x > 32766 or y > 32766 or z > 32766:
                    break
                if x < -32767 or y < -32767 or z < -32767:
                    break
            sum_t += t - ref_t
        else:
            a = f[p + 1] - ref_a
            b = f[p + 2] - ref_b
            g = f[p + 3] - ref_c
            d = t - ref_t
            dx = x - ref_x
            dy = y - ref_y
            dz = z - ref_z
            far = (a + 512) | (b + 512) | (g + 512) | (d + 512)
            if ((dx + 512) | (dy + 512) | (dz + 512) | far) >> 10:
                break  # the window is no rest from here on
            sum_a += a
            sum_b += b
            sum_c += g
            sum_t += d
            sum_x += dx
            sum_y += dy
            sum_z += dz
            square_accel += a * a + b * b + g * g
            square_gyro += dx * dx + dy * dy + dz * dz
            a = x - last_x
            b = y - last_y
            g = z - last_z
            square_step += a * a + b * b + g * g
        last_t = t
        last_x = x
        last_y = y
        last_z = z
        f[p + 5] = (due_x >> 8) + x
        due_x = (due_x & 255) - bias_x
        f[p + 6] = (due_y >> 8) + y
        due_y = (due_y & 255) - bias_y
        f[p + 7] = (due_z >> 8) + z
        due_z = (due_z & 255) - bias_z
        f[p] = 0
        p += 8
        left -= 1
    r[_AT] = p
    n -= left
    elapsed_us += ((p - since) >> 3) * usual_us
    if n:
        account(s, f, p, n, elapsed_us)
        s[_FRAME + 4] = last_x
        s[_FRAME + 5] = last_y
        s[_FRAME + 6] = last_z
        s[_WINDOW_SUM + 3] = sum_t
        s[_CARRY_Q8] = due_x + bias_x - 128
        s[_CARRY_Q8 + 1] = due_y + bias_y - 128
        s[_CARRY_Q8 + 2] = due_z + bias_z - 128
    if n and moving == 0:
        s[_WINDOW_SUM] = sum_a
        s[_WINDOW_SUM + 1] = sum_b
        s[_WINDOW_SUM + 2] = sum_c
        s[_WINDOW_SUM + 4] = sum_x
        s[_WINDOW_SUM + 5] = sum_y
        s[_WINDOW_SUM + 6] = sum_z
        s[_SQUARE_ACCEL] = square_accel
        s[_SQUARE_GYRO] = square_gyro
        s[_SQUARE_STEP] = square_step
        s[_LAST_RATE] = last_x - ref_x
        s[_LAST_RATE + 1] = last_y - ref_y
        s[_LAST_RATE + 2] = last_z - ref_z
        i = 0
        while i < 3:
            s[_EFFECT_SUM_Q8 + i] += s[_EFFECT_Q8 + i] * n
            i += 1
    edge(s, f, c, r, left)


def one(s: ptr32, f: ptr32, c: ptr32, r: ptr32):
    """Give the next frame to `step`."""
    p = r[_AT]
    i = 0
    while i < 7:
        r[i] = f[p + 1 + i]
        i += 1
    i = f[p]
    f[p] = step(s, c, r, i)
    i = 0
    while i < 7:
        f[p + 1 + i] = r[i]
        i += 1
    r[_AT] = p + 8


def block(s: ptr32, f: ptr32, c: ptr32, r: ptr32, n: int):
    """Take n frames of f and correct each in place; its first word becomes the guard's verdict.

    r: nine words of room.
    """
    r[_AT] = 0
    r[_END] = n << 3
    while r[_AT] < r[_END]:
        before = r[_AT]
        if s[_WORK] == 0 and s[_WINDOW_N] < c[_WINDOW] - 1:
            take(s, f, c, r)
        if r[_AT] == before:
            one(s, f, c, r)
