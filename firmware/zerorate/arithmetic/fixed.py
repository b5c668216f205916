"""Fixed-point arithmetic that never leaves 31 bits."""

# layout: names that a board's own compiler reads
const = int
# layout: end
_LOW_15 = const(0x7FFF)


def scaled(a: int, b: int, shift: int) -> int:
    """Return (a * b) >> shift for |a|, |b| < 2^28 and shift 15..30, to within one unit."""
    high = b >> 15
    low = b & _LOW_15
    middle = (a >> 15) * low + (a & _LOW_15) * high + (((a & _LOW_15) * low) >> 15)
    high = (a >> 15) * high
    return (high << (30 - shift)) + (middle >> (shift - 15))


def fraction_q27(a: int, b: int) -> int:
    """Return a / b in Q27 for 0 <= a <= b < 2^20, b > 0."""
    q = 0
    rest = a
    for i in range(3):
        rest = rest << 9
        q = (q << 9) + rest // b
        rest = rest % b
    return q


def ratio_q26(a: int, b: int) -> int:
    """Return a / b in Q26, saturated at +-4, for |a| < 2^28 and 0 <= b < 2^28; 0 where b is 0."""
    sign = 1 if a >= 0 else -1
    rest = sign * a
    if b == 0:
        return 0
    if rest >> 2 >= b:
        return sign * 0xFFFFFFF
    q = rest // b
    rest = rest % b
    for i in range(26):
        rest = rest << 1
        q = q << 1
        if rest >= b:
            rest -= b
            q += 1
    return sign * q


def room(value: int) -> int:
    """Return by how much |value| < 2^30 can be shifted left until it fills 27 bits; 27 for 0."""
    left = value if value >= 0 else 0 - value
    shift = 0
    if left == 0:
        return 27
    # shifted right, for machine code takes longest to make large numbers
    if left >> 11 == 0:
        left = left << 16
        shift = 16
    if left >> 19 == 0:
        left = left << 8
        shift += 8
    if left >> 23 == 0:
        left = left << 4
        shift += 4
    if left >> 25 == 0:
        left = left << 2
        shift += 2
    if left >> 26 == 0:
        shift += 1
    return shift


def floating_ratio_q26(a: int, b: int, exponent: int) -> int:
    """Return a / b * 2^exponent in Q26, saturated at +-4, for |a|, b < 2^30; 0 where b is 0."""
    if a == 0 or b <= 0:
        return 0
    e = exponent
    m = a
    while m > 0x7FFFFFF or m < -0x7FFFFFF:
        m = m >> 1
        e += 1
    n = b
    while n > 0x7FFFFFF:
        n = n >> 1
        e -= 1
    e += room(n) - room(m)
    n = n << room(n)
    ratio = ratio_q26(m << room(m), n)
    while e > 0:
        if ratio > 0x7FFFFFF or ratio < -0x7FFFFFF:
            return 0xFFFFFFF if ratio > 0 else -0xFFFFFFF
        ratio = ratio << 1
        e -= 1
    return ratio >> (0 - e if e > -30 else 30)


def clipped(x: int, most: int) -> int:
    """Return x held within +-most."""
    if x > most:
        return most
    if x < 0 - most:
        return 0 - most
    return x


def root(square: int) -> int:
    """Return the integer square root of 0 <= square < 2^30."""
    bit = 1 << 11 if square < 0x1000000 else 1 << 14
    if square < 0x10000:
        bit = 1 << 7
    found = 0
    while bit:
        more = found + bit
        if more * more <= square:
            found = more
        bit = bit >> 1
    return found
