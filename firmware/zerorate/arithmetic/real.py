"""Numbers of 27 significant bits in two words of the state: mantissa, exponent.

The least squares of a window span more orders of magnitude than 31 bits, and a float is a heap
object on a board. A number at word `a` is s[a] * 2^s[a+1]; |s[a]| is in 2^27..2^28, or 0.
"""

from .fixed import root

# layout: names that a board's own compiler reads
const = int
ptr32 = None
# layout: end
_LOW_14 = const(0x3FFF)
_LEAST_MANTISSA = const(0x8000000)
_MOST_MANTISSA = const(0x10000000)
_ZERO_EXPONENT = const(-4096)


def put(s: ptr32, d: int, m: int, e: int):
    """Store m * 2^e at word d."""
    if m == 0:
        s[d] = 0
        s[d + 1] = _ZERO_EXPONENT
        return
    mantissa = m
    exponent = e
    while mantissa < 0x80000 and mantissa >= -0x80000:
        mantissa = mantissa << 8
        exponent -= 8
    while mantissa < _LEAST_MANTISSA and mantissa >= -_LEAST_MANTISSA:
        mantissa = mantissa << 1
        exponent -= 1
    while mantissa >= _MOST_MANTISSA or mantissa < -_MOST_MANTISSA:
        mantissa = mantissa >> 1
        exponent += 1
    s[d] = mantissa
    s[d + 1] = exponent


def copy(s: ptr32, d: int, a: int, words: int):
    """Copy words from a to d."""
    i = words
    while i > 0:
        i -= 1
        s[d + i] = s[a + i]


def high_product(m: int, n: int) -> int:
    """Return (m * n) >> 28 for |m|, |n| <= 2^28, to within a unit."""
    low = ((m & _LOW_14) * (n & _LOW_14)) >> 14
    low += (m & _LOW_14) * (n >> 14)
    low += (m >> 14) * (n & _LOW_14)
    return (m >> 14) * (n >> 14) + (low >> 14)


def multiply(s: ptr32, d: int, a: int, b: int):
    """Store the product of the numbers at a and b at d."""
    m = high_product(s[a], s[b])
    exponent = s[a + 1] + s[b + 1] + 28
    put(s, d, m, exponent)


def add(s: ptr32, d: int, a: int, b: int):
    """Store the sum of the numbers at a and b at d."""
    if s[a + 1] < s[b + 1]:
        add_smaller(s, d, b, a)
    else:
        add_smaller(s, d, a, b)


def add_smaller(s: ptr32, d: int, a: int, b: int):
    """Store the sum of the numbers at a and b at d; the exponent at b is not the greater one."""
    shift = s[a + 1] - s[b + 1]
    m = s[a]
    if shift <= 28:
        m += s[b] >> shift
    shift = s[a + 1]
    put(s, d, m, shift)


def subtract(s: ptr32, d: int, a: int, b: int):
    """Store the number at a less the one at b at d; d is not a."""
    put(s, d, -s[b], s[b + 1])
    add(s, d, a, d)


def quotient_q27(m: int, n: int) -> int:
    """Return m / n in Q27, for 0 <= m < 2 n <= 2^29, n > 0."""
    q = 0
    rest = m
    for i in range(28):
        q = q << 1
        if rest >= n:
            rest -= n
            q += 1
        rest = rest << 1
    return q


def divide(s: ptr32, d: int, a: int, b: int):
    """Store a / b at d; 0 where b is 0."""
    m = s[a] if s[a] >= 0 else -s[a]
    n = s[b] if s[b] >= 0 else -s[b]
    if n:
        m = quotient_q27(m, n)
    else:
        m = 0
    if (s[a] ^ s[b]) < 0:
        m = -m
    n = s[a + 1] - s[b + 1] - 27
    put(s, d, m, n)


def whole(s: ptr32, a: int, shift: int) -> int:
    """Return the number at a times 2^shift as an integer, held within +-(2^29 - 1)."""
    m = s[a]
    by = shift + s[a + 1]
    if by > 1 and m != 0:
        m = 0x1FFFFFFF if m > 0 else -0x1FFFFFFF
    elif by >= 0:
        m = m << by
    elif by > -30:
        m = (m + (1 << (-1 - by))) >> (0 - by)
    else:
        m = 0
    return m


def root_of(s: ptr32, d: int, a: int):
    """Store the square root of the number at a, not negative, at d, to 14 bits."""
    m = s[a]
    e = s[a + 1]
    if e & 1:
        m = m >> 1
        e += 1
    m = root(m)
    put(s, d, m, e >> 1)


def pack(s: ptr32, d: int, a: int):
    """Store the number at a in the one word d: 23 bits and an exponent of -96..31, else 0."""
    e = s[a + 1] + 96
    if s[a] == 0 or e < 0 or e > 127:
        s[d] = 0
    else:
        s[d] = ((s[a] >> 5) << 7) + e


def unpack(s: ptr32, d: int, a: int):
    """Store the number packed in word a at d."""
    put(s, d, (s[a] >> 7) << 5, (s[a] & 127) - 96)
