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
            s[204] = 0
            s[205] = -4096
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
            s[204] = put_m
            s[205] = put_e
        multiply(204, s_, i + 196, 204)
        if s[203] < s[205]:
            add_smaller(s_, 204, 202, 202)
        else:
            add_smaller(s_, 202, 204, 202)
        h = h + 21
        i = i + 2
    real_copy_words = 2
    while real_copy_words > 0:
        real_copy_words = real_copy_words - 1
        s[d + real_copy_words] = s[real_copy_words + 202]


@micropython.viper
def prior_place(i: int, j: int) -> int:
    if i > j:
        return (3 * j - ((j + 1) * j >> 1) + i) * 2 + 160
    return (3 * i - ((i + 1) * i >> 1) + j) * 2 + 160


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
    s[202] = put_m
    s[203] = put_e
    divide(s_, 202, d, 202)
    if 0 - k:
        if 0 > k:
            sweep_row_d = (4 * k - ((k + 1) * k >> 1)) * 2 + 33
        else:
            sweep_row_d = 2 * k + 33
        multiply(sweep_row_d, s_, 202, 204)
        if 0 - k:
            if k > 0:
                sweep_row_d = 2 * k + 33
            else:
                sweep_row_d = (4 * k - ((k + 1) * k >> 1)) * 2 + 33
            multiply(204, s_, sweep_row_d, 206)
            sweep_row_d = 33
            subtract(s_, 206, 208, 33, s_)
            sweep_row_real_copy_words = 2
            while sweep_row_real_copy_words > 0:
                sweep_row_real_copy_words = sweep_row_real_copy_words - 1
                s[sweep_row_real_copy_words + 33] = s[sweep_row_real_copy_words + 208]
        if 1 - k:
            if k > 1:
                sweep_row_d = (k + 3) * 2 + 33
            else:
                sweep_row_d = (4 * k - ((k + 1) * k >> 1) + 1) * 2 + 33
            multiply(204, s_, sweep_row_d, 206)
            sweep_row_d = 35
            subtract(s_, 206, 208, 35, s_)
            sweep_row_real_copy_words = 2
            while sweep_row_real_copy_words > 0:
                sweep_row_real_copy_words = sweep_row_real_copy_words - 1
                s[sweep_row_real_copy_words + 35] = s[sweep_row_real_copy_words + 208]
        if 2 - k:
            if k > 2:
                sweep_row_d = (k + 5) * 2 + 33
            else:
                sweep_row_d = (4 * k - ((k + 1) * k >> 1) + 2) * 2 + 33
            multiply(204, s_, sweep_row_d, 206)
            sweep_row_d = 37
            subtract(s_, 206, 208, 37, s_)
            sweep_row_real_copy_words = 2
            while sweep_row_real_copy_words > 0:
                sweep_row_real_copy_words = sweep_row_real_copy_words - 1
                s[sweep_row_real_copy_words + 37] = s[sweep_row_real_copy_words + 208]
        if 3 - k:
            if k > 3:
                sweep_row_d = (k + 6) * 2 + 33
            else:
                sweep_row_d = (4 * k - ((k + 1) * k >> 1) + 3) * 2 + 33
            multiply(204, s_, sweep_row_d, 206)
            sweep_row_d = 39
            subtract(s_, 206, 208, 39, s_)
            sweep_row_real_copy_words = 2
            while sweep_row_real_copy_words > 0:
                sweep_row_real_copy_words = sweep_row_real_copy_words - 1
                s[sweep_row_real_copy_words + 39] = s[sweep_row_real_copy_words + 208]
    if 1 - k:
        if 1 > k:
            sweep_row_d = (4 * k - ((k + 1) * k >> 1) + 1) * 2 + 33
        else:
            sweep_row_d = (k + 3) * 2 + 33
        multiply(sweep_row_d, s_, 202, 204)
        if 1 - k:
            if k > 1:
                sweep_row_d = (k + 3) * 2 + 33
            else:
                sweep_row_d = (4 * k - ((k + 1) * k >> 1) + 1) * 2 + 33
            multiply(204, s_, sweep_row_d, 206)
            sweep_row_d = 41
            subtract(s_, 206, 208, 41, s_)
            sweep_row_real_copy_words = 2
            while sweep_row_real_copy_words > 0:
                sweep_row_real_copy_words = sweep_row_real_copy_words - 1
                s[sweep_row_real_copy_words + 41] = s[sweep_row_real_copy_words + 208]
        if 2 - k:
            if k > 2:
                sweep_row_d = (k + 5) * 2 + 33
            else:
                sweep_row_d = (4 * k - ((k + 1) * k >> 1) + 2) * 2 + 33
            multiply(204, s_, sweep_row_d, 206)
            sweep_row_d = 43
            subtract(s_, 206, 208, 43, s_)
            sweep_row_real_copy_words = 2
            while sweep_row_real_copy_words > 0:
                sweep_row_real_copy_words = sweep_row_real_copy_words - 1
                s[sweep_row_real_copy_words + 43] = s[sweep_row_real_copy_words + 208]
        if 3 - k:
            if k > 3:
                sweep_row_d = (k + 6) * 2 + 33
            else:
                sweep_row_d = (4 * k - ((k + 1) * k >> 1) + 3) * 2 + 33
            multiply(204, s_, sweep_row_d, 206)
            sweep_row_d = 45
            subtract(s_, 206, 208, 45, s_)
            sweep_row_real_copy_words = 2
            while sweep_row_real_copy_words > 0:
                sweep_row_real_copy_words = sweep_row_real_copy_words - 1
                s[sweep_row_real_copy_words + 45] = s[sweep_row_real_copy_words + 208]
    if 2 - k:
        if 2 > k:
            sweep_row_d = (4 * k - ((k + 1) * k >> 1) + 2) * 2 + 33
        else:
            sweep_row_d = (k + 5) * 2 + 33
        multiply(sweep_row_d, s_, 202, 204)
        if 2 - k:
            if k > 2:
                sweep_row_d = (k + 5) * 2 + 33
            else:
                sweep_row_d = (4 * k - ((k + 1) * k >> 1) + 2) * 2 + 33
            multiply(204, s_, sweep_row_d, 206)
            sweep_row_d = 47
            subtract(s_, 206, 208, 47, s_)
            sweep_row_real_copy_words = 2
            while sweep_row_real_copy_words > 0:
                sweep_row_real_copy_words = sweep_row_real_copy_words - 1
                s[sweep_row_real_copy_words + 47] = s[sweep_row_real_copy_words + 208]
        if 3 - k:
            if k > 3:
                sweep_row_d = (k + 6) * 2 + 33
            else:
                sweep_row_d = (4 * k - ((k + 1) * k >> 1) + 3) * 2 + 33
            multiply(204, s_, sweep_row_d, 206)
            sweep_row_d = 49
            subtract(s_, 206, 208, 49, s_)
            sweep_row_real_copy_words = 2
            while sweep_row_real_copy_words > 0:
                sweep_row_real_copy_words = sweep_row_real_copy_words - 1
                s[sweep_row_real_copy_words + 49] = s[sweep_row_real_copy_words + 208]
    if 3 - k:
        if 3 > k:
            sweep_row_d = (4 * k - ((k + 1) * k >> 1) + 3) * 2 + 33
        else:
            sweep_row_d = (k + 6) * 2 + 33
        multiply(sweep_row_d, s_, 202, 204)
        if 3 - k:
            if k > 3:
                sweep_row_d = (k + 6) * 2 + 33
            else:
                sweep_row_d = (4 * k - ((k + 1) * k >> 1) + 3) * 2 + 33
            multiply(204, s_, sweep_row_d, 206)
            sweep_row_d = 51
            subtract(s_, 206, 208, 51, s_)
            sweep_row_real_copy_words = 2
            while sweep_row_real_copy_words > 0:
                sweep_row_real_copy_words = sweep_row_real_copy_words - 1
                s[sweep_row_real_copy_words + 51] = s[sweep_row_real_copy_words + 208]
    if 0 - k:
        if 0 > k:
            d = (4 * k - ((k + 1) * k >> 1)) * 2 + 33
        else:
            d = 2 * k + 33
        multiply(d, s_, 202, d)
    if 1 - k:
        if 1 > k:
            d = (4 * k - ((k + 1) * k >> 1) + 1) * 2 + 33
        else:
            d = (k + 3) * 2 + 33
        multiply(d, s_, 202, d)
    if 2 - k:
        if 2 > k:
            d = (4 * k - ((k + 1) * k >> 1) + 2) * 2 + 33
        else:
            d = (k + 5) * 2 + 33
        multiply(d, s_, 202, d)
    if 3 - k:
        if 3 > k:
            d = (4 * k - ((k + 1) * k >> 1) + 3) * 2 + 33
        else:
            d = (k + 6) * 2 + 33
        multiply(d, s_, 202, d)
    if k > k:
        d = (4 * k - ((k + 1) * k >> 1) + k) * 2 + 33
    else:
        d = (4 * k - ((k + 1) * k >> 1) + k) * 2 + 33
    put_m = -s[202]
    put_e = s[203]
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
        s[real_copy_words + 33] = s[real_copy_words + 148]
    d = d + 2
    real_copy_words = 2
    while real_copy_words > 0:
        real_copy_words = real_copy_words - 1
        s[d + real_copy_words] = s[real_copy_words + 150]
    d = d + 2
    real_copy_words = 2
    while real_copy_words > 0:
        real_copy_words = real_copy_words - 1
        s[d + real_copy_words] = s[real_copy_words + 152]
    d = d + 2
    d = d + 2
    real_copy_words = 2
    while real_copy_words > 0:
        real_copy_words = real_copy_words - 1
        s[d + real_copy_words] = s[real_copy_words + 154]
    d = d + 2
    real_copy_words = 2
    while real_copy_words > 0:
        real_copy_words = real_copy_words - 1
        s[d + real_copy_words] = s[real_copy_words + 156]
    d = d + 2
    d = d + 2
    real_copy_words = 2
    while real_copy_words > 0:
        real_copy_words = real_copy_words - 1
        s[d + real_copy_words] = s[real_copy_words + 158]
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
    s[202] = put_m
    s[203] = put_e
    real_copy_words = 2
    while real_copy_words > 0:
        real_copy_words = real_copy_words - 1
        s[real_copy_words + 204] = s[real_copy_words + 202]
    i = 0
    real_copy_words = 2
    while real_copy_words > 0:
        real_copy_words = real_copy_words - 1
        s[real_copy_words + 184] = s[real_copy_words + 39]
    real_copy_words = 2
    while real_copy_words > 0:
        real_copy_words = real_copy_words - 1
        s[real_copy_words + 206] = s[real_copy_words + 39]
    if s[206] >> 30:
        magnitude_put_m = -s[206]
        magnitude_put_e = s[207]
        if not magnitude_put_m:
            s[206] = 0
            s[207] = -4096
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
            s[206] = magnitude_put_m
            s[207] = magnitude_put_e
    subtract(s_, 206, 208, 204, s_)
    if s[208] >> 30:
        less_result = 1
    else:
        less_result = 0
    if less_result:
        real_copy_words = 2
        while real_copy_words > 0:
            real_copy_words = real_copy_words - 1
            s[real_copy_words + 204] = s[real_copy_words + 206]
    real_copy_words = 2
    while real_copy_words > 0:
        real_copy_words = real_copy_words - 1
        s[real_copy_words + 186] = s[real_copy_words + 45]
    real_copy_words = 2
    while real_copy_words > 0:
        real_copy_words = real_copy_words - 1
        s[real_copy_words + 206] = s[real_copy_words + 45]
    if s[206] >> 30:
        magnitude_put_m = -s[206]
        magnitude_put_e = s[207]
        if not magnitude_put_m:
            s[206] = 0
            s[207] = -4096
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
            s[206] = magnitude_put_m
            s[207] = magnitude_put_e
    subtract(s_, 206, 208, 204, s_)
    if s[208] >> 30:
        less_result = 1
    else:
        less_result = 0
    if less_result:
        real_copy_words = 2
        while real_copy_words > 0:
            real_copy_words = real_copy_words - 1
            s[real_copy_words + 204] = s[real_copy_words + 206]
    real_copy_words = 2
    while real_copy_words > 0:
        real_copy_words = real_copy_words - 1
        s[real_copy_words + 188] = s[real_copy_words + 49]
    real_copy_words = 2
    while real_copy_words > 0:
        real_copy_words = real_copy_words - 1
        s[real_copy_words + 206] = s[real_copy_words + 49]
    if s[206] >> 30:
        magnitude_put_m = -s[206]
        magnitude_put_e = s[207]
        if not magnitude_put_m:
            s[206] = 0
            s[207] = -4096
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
            s[206] = magnitude_put_m
            s[207] = magnitude_put_e
    subtract(s_, 206, 208, 204, s_)
    if s[208] >> 30:
        less_result = 1
    else:
        less_result = 0
    if less_result:
        real_copy_words = 2
        while real_copy_words > 0:
            real_copy_words = real_copy_words - 1
            s[real_copy_words + 204] = s[real_copy_words + 206]
    i = 3
    divide(s_, 202, 204, 202)
    i = 0
    while i < 6:
        multiply(i + 184, s_, 202, i + 184)
        i = i + 2


@micropython.viper
def shape(put_m: int, real_copy_words: int, put_e: int, s: ptr32, y: int, m: int, d: int, s_):
    put_m = s[y]
    put_e = 0
    if not put_m:
        s[202] = 0
        s[203] = -4096
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
        s[202] = put_m
        s[203] = put_e
    i = 0
    while i < 6:
        y = s[12] - 26
        put_m = s[m]
        put_e = y
        if not put_m:
            s[204] = 0
            s[205] = -4096
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
            s[204] = put_m
            s[205] = put_e
        y = i + 184
        multiply(204, s_, y, 204)
        subtract(s_, 204, 206, 202, s_)
        real_copy_words = 2
        while real_copy_words > 0:
            real_copy_words = real_copy_words - 1
            s[real_copy_words + 202] = s[real_copy_words + 206]
        m = m + 1
        i = i + 2
    multiply(202, s_, 202, d)


@micropython.viper
def noise(put_m: int, put_e: int, s: ptr32, i: int, s_):
    a = 21 * i + 85
    d = 2 * i + 196
    shape(0, 0, 0, s_, a + 19, a + 13, 208, s_)
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
    s[202] = put_m
    s[203] = put_e
    multiply(208, s_, 202, d)
    shape(0, 0, 0, s_, a + 20, a + 16, 208, s_)
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
    s[202] = put_m
    s[203] = put_e
    multiply(208, s_, 202, 208)
    if s[209] < s[d + 1]:
        add_smaller(s_, d, 208, 208)
    else:
        add_smaller(s_, 208, d, 208)
    a = s[209] - s[12]
    put_m = s[208]
    put_e = a
    if not put_m:
        s[208] = 0
        s[209] = -4096
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
        s[208] = put_m
        s[209] = put_e
    a = 419
    if not i - 2:
        a = 1678
    put_m = a
    put_e = 0
    if not put_m:
        s[202] = 0
        s[203] = -4096
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
        s[202] = put_m
        s[203] = put_e
    if s[209] < s[203]:
        add_smaller(s_, 202, 208, d)
    else:
        add_smaller(s_, 208, 202, d)


@micropython.viper
def weights(real_copy_words: int, s: ptr32, real_copy_d: int, s_, c_):
    if s[197] < s[199]:
        add_smaller(s_, 198, 196, 202)
    else:
        add_smaller(s_, 196, 198, 202)
    put_m = s[202]
    put_e = s[203] - 1
    if not put_m:
        s[196] = 0
        s[197] = -4096
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
        s[196] = put_m
        s[197] = put_e
    real_copy_d = 198
    real_copy_words = 2
    while real_copy_words > 0:
        real_copy_words = real_copy_words - 1
        s[real_copy_words + 198] = s[real_copy_words + 196]
    i = 0
    while i < 6:
        less_a = i + 196
        less_b = i + 190
        subtract(s_, less_b, 208, less_a, s_)
        if s[208] >> 30:
            less_result = 1
        else:
            less_result = 0
        if less_result:
            real_copy_d = i + 196
            real_copy_a = i + 190
            real_copy_words = 2
            while real_copy_words > 0:
                real_copy_words = real_copy_words - 1
                s[real_copy_d + real_copy_words] = s[real_copy_a + real_copy_words]
        real_copy_d = i + 222
        real_copy_a = i + 196
        real_copy_words = 2
        while real_copy_words > 0:
            real_copy_words = real_copy_words - 1
            s[real_copy_d + real_copy_words] = s[real_copy_a + real_copy_words]
        weigh(0, s_, c_, i + 196, s_)
        i = i + 2


@micropython.viper
def weigh(put_m: int, s: ptr32, c: ptr32, a: int, s_):
    put_m = c[21]
    put_e = 0
    if not put_m:
        s[202] = 0
        s[203] = -4096
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
        s[202] = put_m
        s[203] = put_e
    multiply(202, s_, a, 204)
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
    s[202] = put_m
    s[203] = put_e
    divide(s_, 202, 204, a)


@micropython.viper
def own_square(s: ptr32, i: int):
    a = 24 * i + 85
    if not i - 2:
        a = a - 1
    i = 2 * s[12] - 42
    put_m = s[a]
    put_e = i
    if not put_m:
        s[204] = 0
        s[205] = -4096
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
        s[204] = put_m
        s[205] = put_e
