# Generated from zerorate/real.py by `make viper`: edit that file, not this one.
"""Numbers of 27 significant bits in two words of the state: mantissa, exponent.

The least squares of a window span more orders of magnitude than 31 bits, and a float is a heap
object on a board. A number at word `a` is s[a] * 2^s[a+1]; |s[a]| is in 2^27..2^28, or 0."""

import micropython


@micropython.viper
def put(m: int, e: int, d: int, s: ptr32):
    s_d = ptr32(int(s) + (d << 2))
    if not m:
        s_d[0] = 0
        s_d[1] = -4096
        return
    while m < 524288 and m >= -524288:
        m = m << 8
        e = e - 8
    while m < 134217728 and m >= -134217728:
        m = m << 1
        e = e - 1
    while m >= 268435456 or m < -268435456:
        m = m >> 1
        e = e + 1
    s_d[0] = m
    s_d[1] = e


@micropython.viper
def copy(s: ptr32, d: int, a: int, words: int):
    while words > 0:
        words = words - 1
        s[d + words] = s[a + words]


@micropython.viper
def multiply(s: ptr32, a: int, b: int, d: int):
    s_d = ptr32(int(s) + (d << 2))
    s_a = ptr32(int(s) + (a << 2))
    s_b = ptr32(int(s) + (b << 2))
    high_product_m = s_a[0]
    high_product_n = s_b[0]
    high_product_low = (high_product_m & 16383) * (high_product_n & 16383) >> 14
    high_product_low = (high_product_m & 16383) * (high_product_n >> 14) + high_product_low
    high_product_low = (high_product_m >> 14) * (high_product_n & 16383) + high_product_low
    m = (high_product_m >> 14) * (high_product_n >> 14) + (high_product_low >> 14)
    exponent = s_a[1] + s_b[1] + 28
    put_m = m
    put_e = exponent
    if not put_m:
        s_d[0] = 0
        s_d[1] = -4096
    else:
        while put_m < 524288 and put_m >= -524288:
            put_m = put_m << 8
            put_e = put_e - 8
        while put_m < 134217728 and put_m >= -134217728:
            put_m = put_m << 1
            put_e = put_e - 1
        while put_m >= 268435456 or put_m < -268435456:
            put_m = put_m >> 1
            put_e = put_e + 1
        s_d[0] = put_m
        s_d[1] = put_e


@micropython.viper
def add_smaller(s: ptr32, a: int, b: int, d: int):
    s_d = ptr32(int(s) + (d << 2))
    s_a = ptr32(int(s) + (a << 2))
    s_b = ptr32(int(s) + (b << 2))
    shift = s_a[1] - s_b[1]
    m = s_a[0]
    if shift <= 28:
        m = (s_b[0] >> shift) + m
    shift = s_a[1]
    put_m = m
    put_e = shift
    if not put_m:
        s_d[0] = 0
        s_d[1] = -4096
    else:
        while put_m < 524288 and put_m >= -524288:
            put_m = put_m << 8
            put_e = put_e - 8
        while put_m < 134217728 and put_m >= -134217728:
            put_m = put_m << 1
            put_e = put_e - 1
        while put_m >= 268435456 or put_m < -268435456:
            put_m = put_m >> 1
            put_e = put_e + 1
        s_d[0] = put_m
        s_d[1] = put_e


@micropython.viper
def subtract(s: ptr32, b: int, d: int, a: int, s_):
    s_d = ptr32(int(s) + (d << 2))
    s_b = ptr32(int(s) + (b << 2))
    put_m = -s_b[0]
    put_e = s_b[1]
    if not put_m:
        s_d[0] = 0
        s_d[1] = -4096
    else:
        while put_m < 524288 and put_m >= -524288:
            put_m = put_m << 8
            put_e = put_e - 8
        while put_m < 134217728 and put_m >= -134217728:
            put_m = put_m << 1
            put_e = put_e - 1
        while put_m >= 268435456 or put_m < -268435456:
            put_m = put_m >> 1
            put_e = put_e + 1
        s_d[0] = put_m
        s_d[1] = put_e
    if s[a + 1] < s_d[1]:
        add_smaller(s_, d, a, d)
    else:
        add_smaller(s_, a, d, d)


@micropython.viper
def divide(s: ptr32, a: int, b: int, d: int):
    s_d = ptr32(int(s) + (d << 2))
    s_a = ptr32(int(s) + (a << 2))
    s_b = ptr32(int(s) + (b << 2))
    m = s_a[0] if s_a[0] >= 0 else -s_a[0]
    n = s_b[0] if s_b[0] >= 0 else -s_b[0]
    if n:
        quotient_q27_m = m
        quotient_q27_q = 0
        quotient_q27_i = 0
        while quotient_q27_i < 28:
            quotient_q27_q = quotient_q27_q << 1
            if quotient_q27_m >= n:
                quotient_q27_m = quotient_q27_m - n
                quotient_q27_q = quotient_q27_q + 1
            quotient_q27_m = quotient_q27_m << 1
            quotient_q27_i = quotient_q27_i + 1
        m = quotient_q27_q
    else:
        m = 0
    if (s_a[0] ^ s_b[0]) >> 30:
        m = -m
    n = s_a[1] - s_b[1] - 27
    put_m = m
    put_e = n
    if not put_m:
        s_d[0] = 0
        s_d[1] = -4096
    else:
        while put_m < 524288 and put_m >= -524288:
            put_m = put_m << 8
            put_e = put_e - 8
        while put_m < 134217728 and put_m >= -134217728:
            put_m = put_m << 1
            put_e = put_e - 1
        while put_m >= 268435456 or put_m < -268435456:
            put_m = put_m >> 1
            put_e = put_e + 1
        s_d[0] = put_m
        s_d[1] = put_e


@micropython.viper
def whole(shift: int, a: int, s: ptr32) -> int:
    s_a = ptr32(int(s) + (a << 2))
    m = s_a[0]
    shift = shift + s_a[1]
    if shift > 1 and m:
        m = 536870911 if m > 0 else -536870911
    elif not shift >> 30:
        m = m << shift
    elif shift > -30:
        m = (1 << -1 - shift) + m >> 0 - shift
    else:
        m = 0
    return m


@micropython.viper
def root_of(s: ptr32, a: int, d: int):
    s_d = ptr32(int(s) + (d << 2))
    s_a = ptr32(int(s) + (a << 2))
    m = s_a[0]
    e = s_a[1]
    if e & 1:
        m = m >> 1
        e = e + 1
    root_bit = 16384
    if m < 16777216:
        root_bit = 2048
    root_found = 0
    while root_bit:
        root_more = root_found + root_bit
        if root_more * root_more <= m:
            root_found = root_more
        root_bit = root_bit >> 1
    m = root_found
    put_m = m
    put_e = e >> 1
    if not put_m:
        s_d[0] = 0
        s_d[1] = -4096
    else:
        while put_m < 524288 and put_m >= -524288:
            put_m = put_m << 8
            put_e = put_e - 8
        while put_m < 134217728 and put_m >= -134217728:
            put_m = put_m << 1
            put_e = put_e - 1
        while put_m >= 268435456 or put_m < -268435456:
            put_m = put_m >> 1
            put_e = put_e + 1
        s_d[0] = put_m
        s_d[1] = put_e


@micropython.viper
def pack(s: ptr32, d: int, a: int):
    s_d = ptr32(int(s) + (d << 2))
    s_a = ptr32(int(s) + (a << 2))
    e = s_a[1] + 96
    if not s_a[0] or e >> 30 or e > 127:
        s_d[0] = 0
    else:
        s_d[0] = (s_a[0] >> 5 << 7) + e
