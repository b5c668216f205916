"""Is this frame a real reading? Facts: mpu6050 family, faults seen on real buses."""

# layout: names that a board's own compiler reads
const = int
ptr32 = None
# layout: The corrector's state
_FRAME = const(0)
_COUNTS = const(8)
_ELAPSED_US = const(16)
_WINDOW_N = const(17)
_REST = const(20)
_TEMP = const(22)
_DIRTY = const(48)
# layout: The corrector's settings
_LEAP_US = const(1)
_JUMP_LSB = const(2)
# layout: What the guard says of a frame
GOOD = const(0)
REPEAT = const(1)
RAIL = const(2)
ALL_ZERO = const(3)
ALL_ONES = const(4)
TEMPERATURE_JUMP = const(5)
TIME_STOOD_STILL = const(6)
TIME_LEAPT = const(7)
# layout: end
_MOST_US = const(0x1FFFFFFF)  # two of them fit 31 bits: repeats may come for hours


def at_rail(x: ptr32) -> int:
    """Return 1 if a rate of the frame stands at its rail."""
    for i in range(4, 7):
        if x[i] > 32766 or x[i] < -32767:
            return 1
    return 0


def all_alike(x: ptr32) -> int:
    """Return 1 if all words of the frame are the same."""
    for i in range(1, 7):
        if x[i] != x[0]:
            return 0
    return 1


def exchange(s: ptr32, x: ptr32) -> int:
    """Put the frame in the place of the one before; return 0 if forces and rates are the same."""
    # A bus or a chip that hangs may go on giving temperatures.
    differs = 0
    for i in range(7):
        if i != 3:
            differs |= x[i] ^ s[_FRAME + i]
        s[_FRAME + i] = x[i]
    return differs


def check(s: ptr32, c: ptr32, x: ptr32, dt_us: int) -> int:
    """Return the kind of the frame `x` and count it; only GOOD frames may be learned from."""
    # A repeat is passed over; every other fault also ends the rest that is being watched, because
    # what stands beside a broken frame may be broken too.
    # d is any difference: with a local more a call would take heap
    d = x[3] - s[_FRAME + 3]
    differs = exchange(s, x)
    kind = GOOD
    if (x[0] == 0 or x[0] == -1) and all_alike(x):
        kind = ALL_ZERO - x[0]
    elif s[_COUNTS] == 0:
        kind = GOOD  # nothing came before it
    elif dt_us <= 0:
        kind = TIME_STOOD_STILL
    elif dt_us > c[_LEAP_US]:
        kind = TIME_LEAPT
    elif differs == 0:
        kind = REPEAT
    elif d >= c[_JUMP_LSB] or d <= -c[_JUMP_LSB]:
        d = x[3] - s[_TEMP]  # two readings of a noisy thermometer may be as far apart
        if d >= c[_JUMP_LSB] or d <= -c[_JUMP_LSB]:
            kind = TEMPERATURE_JUMP
    if kind == GOOD and at_rail(x):
        kind = RAIL
    s[_COUNTS + kind] = (s[_COUNTS + kind] + 1) & 0x1FFFFFFF
    if kind > REPEAT:
        s[_WINDOW_N] = 0
        s[_DIRTY] = 0
        s[_REST] = 0
    elif dt_us > 0 and dt_us <= c[_LEAP_US]:
        d = s[_ELAPSED_US] + dt_us
        s[_ELAPSED_US] = d if d < _MOST_US else _MOST_US
    return kind
