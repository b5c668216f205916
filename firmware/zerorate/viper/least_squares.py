# Generated from zerorate/least_squares.py by `make viper`: edit that file, not this one.
"""The window's normal equations: prior, weights, solution and its covariance.

Ten real numbers at _G: the upper triangle of a 3 x 3 matrix with a right-hand side as its fourth
column (00 01 02 0y 11 12 1y 22 2y yy). Bias in Q24 rad a node, orientation in Q12 rad."""

import micropython

from .real import add_smaller
from .real import divide
from .real import multiply
from .real import subtract


@micropython.viper
def place(i: int, j: int) -> int:
    if i > j:
        return (4 * j - ((j + 1) * j >> 1) + i) * 2 + 33
    return (4 * i - ((i + 1) * i >> 1) + j) * 2 + 33


@micropython.viper
def element(put_m: int, put_e: int, s: ptr32, h: int, d: int, e: int, s_):
    i = 0
    while i < 6:
        put_m = s[h]
        put_e = e
        if not put_m:
            s[205] = 0
            s[206] = -4096
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
            s[205] = put_m
            s[206] = put_e
        multiply(s_, 205, i + 197, 205)
        if s[204] < s[206]:
            add_smaller(s_, 205, 203, 203)
        else:
            add_smaller(s_, 203, 205, 203)
        h = h + 21
        i = i + 2
    real_copy_words = 2
    while real_copy_words > 0:
        real_copy_words = real_copy_words - 1
        s[d + real_copy_words] = s[real_copy_words + 203]


@micropython.viper
def prior_place(i: int, j: int) -> int:
    if i > j:
        return (3 * j - ((j + 1) * j >> 1) + i) * 2 + 161
    return (3 * i - ((i + 1) * i >> 1) + j) * 2 + 161


@micropython.viper
def sweep(put_m: int, sweep_row_real_copy_words: int, s: ptr32, k: int, s_):
    if k > k:
        d = (4 * k - ((k + 1) * k >> 1) + k) * 2 + 33
    else:
        d = (4 * k - ((k + 1) * k >> 1) + k) * 2 + 33
    put_m = 1
    put_e = 0
    while put_m < 524288 and put_m >= -524288:
        put_m = put_m << 8
        put_e = put_e - 8
    while put_m < 134217728 and put_m >= -134217728:
        put_m = put_m << 1
        put_e = put_e - 1
    while put_m >= 268435456 or put_m < -268435456:
        put_m = put_m >> 1
        put_e = put_e + 1
    s[203] = put_m
    s[204] = put_e
    divide(s_, 203, d, 203)
    if 0 - k:
        if 0 > k:
            sweep_row_d = (4 * k - ((k + 1) * k >> 1)) * 2 + 33
        else:
            sweep_row_d = 2 * k + 33
        multiply(s_, sweep_row_d, 203, 205)
        if 0 - k:
            if k > 0:
                sweep_row_d = 2 * k + 33
            else:
                sweep_row_d = (4 * k - ((k + 1) * k >> 1)) * 2 + 33
            multiply(s_, 205, sweep_row_d, 207)
            sweep_row_d = 33
            subtract(s_, 207, 209, 33, s_)
            sweep_row_real_copy_words = 2
            while sweep_row_real_copy_words > 0:
                sweep_row_real_copy_words = sweep_row_real_copy_words - 1
                s[sweep_row_real_copy_words + 33] = s[sweep_row_real_copy_words + 209]
        if 1 - k:
            if k > 1:
                sweep_row_d = (k + 3) * 2 + 33
            else:
                sweep_row_d = (4 * k - ((k + 1) * k >> 1) + 1) * 2 + 33
            multiply(s_, 205, sweep_row_d, 207)
            sweep_row_d = 35
            subtract(s_, 207, 209, 35, s_)
            sweep_row_real_copy_words = 2
            while sweep_row_real_copy_words > 0:
                sweep_row_real_copy_words = sweep_row_real_copy_words - 1
                s[sweep_row_real_copy_words + 35] = s[sweep_row_real_copy_words + 209]
        if 2 - k:
            if k > 2:
                sweep_row_d = (k + 5) * 2 + 33
            else:
                sweep_row_d = (4 * k - ((k + 1) * k >> 1) + 2) * 2 + 33
            multiply(s_, 205, sweep_row_d, 207)
            sweep_row_d = 37
            subtract(s_, 207, 209, 37, s_)
            sweep_row_real_copy_words = 2
            while sweep_row_real_copy_words > 0:
                sweep_row_real_copy_words = sweep_row_real_copy_words - 1
                s[sweep_row_real_copy_words + 37] = s[sweep_row_real_copy_words + 209]
        if 3 - k:
            if k > 3:
                sweep_row_d = (k + 6) * 2 + 33
            else:
                sweep_row_d = (4 * k - ((k + 1) * k >> 1) + 3) * 2 + 33
            multiply(s_, 205, sweep_row_d, 207)
            sweep_row_d = 39
            subtract(s_, 207, 209, 39, s_)
            sweep_row_real_copy_words = 2
            while sweep_row_real_copy_words > 0:
                sweep_row_real_copy_words = sweep_row_real_copy_words - 1
                s[sweep_row_real_copy_words + 39] = s[sweep_row_real_copy_words + 209]
    if 1 - k:
        if 1 > k:
            sweep_row_d = (4 * k - ((k + 1) * k >> 1) + 1) * 2 + 33
        else:
            sweep_row_d = (k + 3) * 2 + 33
        multiply(s_, sweep_row_d, 203, 205)
        if 1 - k:
            if k > 1:
                sweep_row_d = (k + 3) * 2 + 33
            else:
                sweep_row_d = (4 * k - ((k + 1) * k >> 1) + 1) * 2 + 33
            multiply(s_, 205, sweep_row_d, 207)
            sweep_row_d = 41
            subtract(s_, 207, 209, 41, s_)
            sweep_row_real_copy_words = 2
            while sweep_row_real_copy_words > 0:
                sweep_row_real_copy_words = sweep_row_real_copy_words - 1
                s[sweep_row_real_copy_words + 41] = s[sweep_row_real_copy_words + 209]
        if 2 - k:
            if k > 2:
                sweep_row_d = (k + 5) * 2 + 33
            else:
                sweep_row_d = (4 * k - ((k + 1) * k >> 1) + 2) * 2 + 33
            multiply(s_, 205, sweep_row_d, 207)
            sweep_row_d = 43
            subtract(s_, 207, 209, 43, s_)
            sweep_row_real_copy_words = 2
            while sweep_row_real_copy_words > 0:
                sweep_row_real_copy_words = sweep_row_real_copy_words - 1
                s[sweep_row_real_copy_words + 43] = s[sweep_row_real_copy_words + 209]
        if 3 - k:
            if k > 3:
                sweep_row_d = (k + 6) * 2 + 33
            else:
                sweep_row_d = (4 * k - ((k + 1) * k >> 1) + 3) * 2 + 33
            multiply(s_, 205, sweep_row_d, 207)
            sweep_row_d = 45
            subtract(s_, 207, 209, 45, s_)
            sweep_row_real_copy_words = 2
            while sweep_row_real_copy_words > 0:
                sweep_row_real_copy_words = sweep_row_real_copy_words - 1
                s[sweep_row_real_copy_words + 45] = s[sweep_row_real_copy_words + 209]
    if 2 - k:
        if 2 > k:
            sweep_row_d = (4 * k - ((k + 1) * k >> 1) + 2) * 2 + 33
        else:
            sweep_row_d = (k + 5) * 2 + 33
        multiply(s_, sweep_row_d, 203, 205)
        if 2 - k:
            if k > 2:
                sweep_row_d = (k + 5) * 2 + 33
            else:
                sweep_row_d = (4 * k - ((k + 1) * k >> 1) + 2) * 2 + 33
            multiply(s_, 205, sweep_row_d, 207)
            sweep_row_d = 47
            subtract(s_, 207, 209, 47, s_)
            sweep_row_real_copy_words = 2
            while sweep_row_real_copy_words > 0:
                sweep_row_real_copy_words = sweep_row_real_copy_words - 1
                s[sweep_row_real_copy_words + 47] = s[sweep_row_real_copy_words + 209]
        if 3 - k:
            if k > 3:
                sweep_row_d = (k + 6) * 2 + 33
            else:
                sweep_row_d = (4 * k - ((k + 1) * k >> 1) + 3) * 2 + 33
            multiply(s_, 205, sweep_row_d, 207)
            sweep_row_d = 49
            subtract(s_, 207, 209, 49, s_)
            sweep_row_real_copy_words = 2
            while sweep_row_real_copy_words > 0:
                sweep_row_real_copy_words = sweep_row_real_copy_words - 1
                s[sweep_row_real_copy_words + 49] = s[sweep_row_real_copy_words + 209]
    if 3 - k:
        if 3 > k:
            sweep_row_d = (4 * k - ((k + 1) * k >> 1) + 3) * 2 + 33
        else:
            sweep_row_d = (k + 6) * 2 + 33
        multiply(s_, sweep_row_d, 203, 205)
        if 3 - k:
            if k > 3:
                sweep_row_d = (k + 6) * 2 + 33
            else:
                sweep_row_d = (4 * k - ((k + 1) * k >> 1) + 3) * 2 + 33
            multiply(s_, 205, sweep_row_d, 207)
            sweep_row_d = 51
            subtract(s_, 207, 209, 51, s_)
            sweep_row_real_copy_words = 2
            while sweep_row_real_copy_words > 0:
                sweep_row_real_copy_words = sweep_row_real_copy_words - 1
                s[sweep_row_real_copy_words + 51] = s[sweep_row_real_copy_words + 209]
    if 0 - k:
        if 0 > k:
            d = (4 * k - ((k + 1) * k >> 1)) * 2 + 33
        else:
            d = 2 * k + 33
        multiply(s_, d, 203, d)
    if 1 - k:
        if 1 > k:
            d = (4 * k - ((k + 1) * k >> 1) + 1) * 2 + 33
        else:
            d = (k + 3) * 2 + 33
        multiply(s_, d, 203, d)
    if 2 - k:
        if 2 > k:
            d = (4 * k - ((k + 1) * k >> 1) + 2) * 2 + 33
        else:
            d = (k + 5) * 2 + 33
        multiply(s_, d, 203, d)
    if 3 - k:
        if 3 > k:
            d = (4 * k - ((k + 1) * k >> 1) + 3) * 2 + 33
        else:
            d = (k + 6) * 2 + 33
        multiply(s_, d, 203, d)
    if k > k:
        d = (4 * k - ((k + 1) * k >> 1) + k) * 2 + 33
    else:
        d = (4 * k - ((k + 1) * k >> 1) + k) * 2 + 33
    put_m = -s[203]
    put_e = s[204]
    if not put_m:
        s[d] = 0
        s[d + 1] = -4096
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
        s[d] = put_m
        s[d + 1] = put_e


@micropython.viper
def covariance(put_m: int, put_e: int, d: int, s: ptr32):
    s_d = ptr32(int(s) + (d << 2))
    a = 33
    put_m = -s[33]
    put_e = s[34]
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
    d = d + 2
    s_d = ptr32(int(s_d) + 8)
    a = a + 2
    put_m = -s[a]
    put_e = s[a + 1]
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
    d = d + 2
    s_d = ptr32(int(s_d) + 8)
    a = a + 2
    put_m = -s[a]
    put_e = s[a + 1]
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
    d = d + 2
    s_d = ptr32(int(s_d) + 8)
    a = a + 2
    a = a + 2
    put_m = -s[a]
    put_e = s[a + 1]
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
    d = d + 2
    s_d = ptr32(int(s_d) + 8)
    a = a + 2
    put_m = -s[a]
    put_e = s[a + 1]
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
    d = d + 2
    s_d = ptr32(int(s_d) + 8)
    a = a + 2
    a = a + 2
    put_m = -s[a]
    put_e = s[a + 1]
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
    d = d + 2
    s_d = ptr32(int(s_d) + 8)
    a = a + 2


@micropython.viper
def spread_prior(real_copy_words: int, s: ptr32):
    i = 0
    d = 33
    while i < 20:
        put_d = i + 33
        s_put_d = ptr32(int(s) + (put_d << 2))
        s_put_d[0] = 0
        s_put_d[1] = -4096
        i = i + 2
    i = 0
    real_copy_words = 2
    while real_copy_words > 0:
        real_copy_words = real_copy_words - 1
        s[real_copy_words + 33] = s[real_copy_words + 149]
    d = d + 2
    real_copy_words = 2
    while real_copy_words > 0:
        real_copy_words = real_copy_words - 1
        s[d + real_copy_words] = s[real_copy_words + 151]
    d = d + 2
    real_copy_words = 2
    while real_copy_words > 0:
        real_copy_words = real_copy_words - 1
        s[d + real_copy_words] = s[real_copy_words + 153]
    d = d + 2
    d = d + 2
    real_copy_words = 2
    while real_copy_words > 0:
        real_copy_words = real_copy_words - 1
        s[d + real_copy_words] = s[real_copy_words + 155]
    d = d + 2
    real_copy_words = 2
    while real_copy_words > 0:
        real_copy_words = real_copy_words - 1
        s[d + real_copy_words] = s[real_copy_words + 157]
    d = d + 2
    d = d + 2
    real_copy_words = 2
    while real_copy_words > 0:
        real_copy_words = real_copy_words - 1
        s[d + real_copy_words] = s[real_copy_words + 159]
    d = d + 2
    i = 6


@micropython.viper
def step(s_):
    s = ptr32(s_)
    i = -s[12]
    put_m = 11744051
    put_e = i
    while put_m < 524288 and put_m >= -524288:
        put_m = put_m << 8
        put_e = put_e - 8
    while put_m < 134217728 and put_m >= -134217728:
        put_m = put_m << 1
        put_e = put_e - 1
    while put_m >= 268435456 or put_m < -268435456:
        put_m = put_m >> 1
        put_e = put_e + 1
    s[203] = put_m
    s[204] = put_e
    real_copy_words = 2
    while real_copy_words > 0:
        real_copy_words = real_copy_words - 1
        s[real_copy_words + 205] = s[real_copy_words + 203]
    i = 0
    real_copy_words = 2
    while real_copy_words > 0:
        real_copy_words = real_copy_words - 1
        s[real_copy_words + 185] = s[real_copy_words + 39]
    real_copy_words = 2
    while real_copy_words > 0:
        real_copy_words = real_copy_words - 1
        s[real_copy_words + 207] = s[real_copy_words + 39]
    if s[207] >> 30:
        magnitude_put_m = -s[207]
        magnitude_put_e = s[208]
        if not magnitude_put_m:
            s[207] = 0
            s[208] = -4096
        else:
            while magnitude_put_m < 524288 and magnitude_put_m >= -524288:
                magnitude_put_m = magnitude_put_m << 8
                magnitude_put_e = magnitude_put_e - 8
            while magnitude_put_m < 134217728 and magnitude_put_m >= -134217728:
                magnitude_put_m = magnitude_put_m << 1
                magnitude_put_e = magnitude_put_e - 1
            while magnitude_put_m >= 268435456 or magnitude_put_m < -268435456:
                magnitude_put_m = magnitude_put_m >> 1
                magnitude_put_e = magnitude_put_e + 1
            s[207] = magnitude_put_m
            s[208] = magnitude_put_e
    subtract(s_, 207, 209, 205, s_)
    if s[209] >> 30:
        less_result = 1
    else:
        less_result = 0
    if less_result:
        real_copy_words = 2
        while real_copy_words > 0:
            real_copy_words = real_copy_words - 1
            s[real_copy_words + 205] = s[real_copy_words + 207]
    real_copy_words = 2
    while real_copy_words > 0:
        real_copy_words = real_copy_words - 1
        s[real_copy_words + 187] = s[real_copy_words + 45]
    real_copy_words = 2
    while real_copy_words > 0:
        real_copy_words = real_copy_words - 1
        s[real_copy_words + 207] = s[real_copy_words + 45]
    if s[207] >> 30:
        magnitude_put_m = -s[207]
        magnitude_put_e = s[208]
        if not magnitude_put_m:
            s[207] = 0
            s[208] = -4096
        else:
            while magnitude_put_m < 524288 and magnitude_put_m >= -524288:
                magnitude_put_m = magnitude_put_m << 8
                magnitude_put_e = magnitude_put_e - 8
            while magnitude_put_m < 134217728 and magnitude_put_m >= -134217728:
                magnitude_put_m = magnitude_put_m << 1
                magnitude_put_e = magnitude_put_e - 1
            while magnitude_put_m >= 268435456 or magnitude_put_m < -268435456:
                magnitude_put_m = magnitude_put_m >> 1
                magnitude_put_e = magnitude_put_e + 1
            s[207] = magnitude_put_m
            s[208] = magnitude_put_e
    subtract(s_, 207, 209, 205, s_)
    if s[209] >> 30:
        less_result = 1
    else:
        less_result = 0
    if less_result:
        real_copy_words = 2
        while real_copy_words > 0:
            real_copy_words = real_copy_words - 1
            s[real_copy_words + 205] = s[real_copy_words + 207]
    real_copy_words = 2
    while real_copy_words > 0:
        real_copy_words = real_copy_words - 1
        s[real_copy_words + 189] = s[real_copy_words + 49]
    real_copy_words = 2
    while real_copy_words > 0:
        real_copy_words = real_copy_words - 1
        s[real_copy_words + 207] = s[real_copy_words + 49]
    if s[207] >> 30:
        magnitude_put_m = -s[207]
        magnitude_put_e = s[208]
        if not magnitude_put_m:
            s[207] = 0
            s[208] = -4096
        else:
            while magnitude_put_m < 524288 and magnitude_put_m >= -524288:
                magnitude_put_m = magnitude_put_m << 8
                magnitude_put_e = magnitude_put_e - 8
            while magnitude_put_m < 134217728 and magnitude_put_m >= -134217728:
                magnitude_put_m = magnitude_put_m << 1
                magnitude_put_e = magnitude_put_e - 1
            while magnitude_put_m >= 268435456 or magnitude_put_m < -268435456:
                magnitude_put_m = magnitude_put_m >> 1
                magnitude_put_e = magnitude_put_e + 1
            s[207] = magnitude_put_m
            s[208] = magnitude_put_e
    subtract(s_, 207, 209, 205, s_)
    if s[209] >> 30:
        less_result = 1
    else:
        less_result = 0
    if less_result:
        real_copy_words = 2
        while real_copy_words > 0:
            real_copy_words = real_copy_words - 1
            s[real_copy_words + 205] = s[real_copy_words + 207]
    i = 3
    divide(s_, 203, 205, 203)
    i = 0
    while i < 6:
        multiply(s_, i + 185, 203, i + 185)
        i = i + 2


@micropython.viper
def shape(put_m: int, real_copy_words: int, put_e: int, s: ptr32, m: int, y: int, d: int, s_):
    put_m = s[y]
    put_e = 0
    if not put_m:
        s[203] = 0
        s[204] = -4096
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
        s[203] = put_m
        s[204] = put_e
    i = 0
    while i < 6:
        put_m = s[m]
        put_e = s[12] - 26
        if not put_m:
            s[205] = 0
            s[206] = -4096
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
            s[205] = put_m
            s[206] = put_e
        multiply(s_, 205, i + 185, 205)
        subtract(s_, 205, 207, 203, s_)
        real_copy_words = 2
        while real_copy_words > 0:
            real_copy_words = real_copy_words - 1
            s[real_copy_words + 203] = s[real_copy_words + 207]
        m = m + 1
        i = i + 2
    multiply(s_, 203, 203, d)


@micropython.viper
def noise(put_m: int, put_e: int, s: ptr32, i: int, s_):
    a = 21 * i + 86
    d = 2 * i + 197
    shape(0, 0, 0, s_, a + 13, a + 19, 209, s_)
    put_m = 11520
    put_e = -14
    while put_m < 524288 and put_m >= -524288:
        put_m = put_m << 8
        put_e = put_e - 8
    while put_m < 134217728 and put_m >= -134217728:
        put_m = put_m << 1
        put_e = put_e - 1
    while put_m >= 268435456 or put_m < -268435456:
        put_m = put_m >> 1
        put_e = put_e + 1
    s[203] = put_m
    s[204] = put_e
    multiply(s_, 209, 203, d)
    shape(0, 0, 0, s_, a + 16, a + 20, 209, s_)
    put_m = 18482
    put_e = -10
    while put_m < 524288 and put_m >= -524288:
        put_m = put_m << 8
        put_e = put_e - 8
    while put_m < 134217728 and put_m >= -134217728:
        put_m = put_m << 1
        put_e = put_e - 1
    while put_m >= 268435456 or put_m < -268435456:
        put_m = put_m >> 1
        put_e = put_e + 1
    s[203] = put_m
    s[204] = put_e
    multiply(s_, 209, 203, 209)
    if s[210] < s[d + 1]:
        add_smaller(s_, d, 209, 209)
    else:
        add_smaller(s_, 209, d, 209)
    put_m = s[209]
    put_e = s[210] - s[12]
    if not put_m:
        s[209] = 0
        s[210] = -4096
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
        s[209] = put_m
        s[210] = put_e
    put_m = 1678 if i == 2 else 419
    put_e = 0
    if not put_m:
        s[203] = 0
        s[204] = -4096
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
        s[203] = put_m
        s[204] = put_e
    if s[210] < s[204]:
        add_smaller(s_, 203, 209, d)
    else:
        add_smaller(s_, 209, 203, d)


@micropython.viper
def weights(real_copy_words: int, s: ptr32, real_copy_d: int, s_, c_):
    if s[198] < s[200]:
        add_smaller(s_, 199, 197, 203)
    else:
        add_smaller(s_, 197, 199, 203)
    put_m = s[203]
    put_e = s[204] - 1
    if not put_m:
        s[197] = 0
        s[198] = -4096
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
        s[197] = put_m
        s[198] = put_e
    real_copy_d = 199
    real_copy_words = 2
    while real_copy_words > 0:
        real_copy_words = real_copy_words - 1
        s[real_copy_words + 199] = s[real_copy_words + 197]
    i = 0
    while i < 6:
        less_a = i + 197
        less_b = i + 191
        subtract(s_, less_b, 209, less_a, s_)
        if s[209] >> 30:
            less_result = 1
        else:
            less_result = 0
        if less_result:
            real_copy_d = i + 197
            real_copy_a = i + 191
            real_copy_words = 2
            while real_copy_words > 0:
                real_copy_words = real_copy_words - 1
                s[real_copy_d + real_copy_words] = s[real_copy_a + real_copy_words]
        real_copy_d = i + 223
        real_copy_a = i + 197
        real_copy_words = 2
        while real_copy_words > 0:
            real_copy_words = real_copy_words - 1
            s[real_copy_d + real_copy_words] = s[real_copy_a + real_copy_words]
        weigh(0, s_, c_, i + 197, s_)
        i = i + 2


@micropython.viper
def weigh(put_m: int, s: ptr32, c: ptr32, a: int, s_):
    put_m = c[21]
    put_e = 0
    if not put_m:
        s[203] = 0
        s[204] = -4096
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
        s[203] = put_m
        s[204] = put_e
    multiply(s_, 203, a, 205)
    put_m = 1
    put_e = 0
    while put_m < 524288 and put_m >= -524288:
        put_m = put_m << 8
        put_e = put_e - 8
    while put_m < 134217728 and put_m >= -134217728:
        put_m = put_m << 1
        put_e = put_e - 1
    while put_m >= 268435456 or put_m < -268435456:
        put_m = put_m >> 1
        put_e = put_e + 1
    s[203] = put_m
    s[204] = put_e
    divide(s_, 203, 205, a)


@micropython.viper
def own_square(s: ptr32, i: int):
    a = 24 * i + 86
    if not i - 2:
        a = a - 1
    put_m = s[a]
    put_e = 2 * s[12] - 42
    if not put_m:
        s[205] = 0
        s[206] = -4096
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
        s[205] = put_m
        s[206] = put_e
